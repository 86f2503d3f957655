"""Small clone-structured models and walks, and plain dense references for them."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
from cogmap.baselines.cscg import CloneModel, Walk, empty_model, sprinkled
from hypothesis import strategies as st


@st.composite
def walks(draw: st.DrawFn, *, sights: int = 3, actions: int = 2, least: int = 2, most: int = 6) -> Walk:
    """A walk of any sights and actions."""
    length = draw(st.integers(least, most))
    x = draw(st.lists(st.integers(0, sights - 1), min_size=length, max_size=length))
    a = draw(st.lists(st.integers(0, actions - 1), min_size=length - 1, max_size=length - 1))
    return Walk.of(x, a)


@st.composite
def cases(
    draw: st.DrawFn, *, kappa: tuple[float, ...] = (0.0, 1e-4, 0.05, 1.0), most: int = 6
) -> tuple[CloneModel, Walk]:
    """A walk, and a model with random counts for it and some for another walk."""
    walk, other = draw(walks(most=most)), draw(walks(most=4))
    clones, seed = draw(st.integers(1, 3)), draw(st.integers(0, 999))
    empty = empty_model(observations=3, clones=clones, actions=2, pseudocount=draw(st.sampled_from(kappa)))
    rng = np.random.default_rng(seed)
    model = sprinkled(sprinkled(empty, rng, among=other), rng, among=walk)
    return replace(model, counts=model.counts * 4), walk


def dense_counts(model: CloneModel) -> np.ndarray:
    """`[S, K, S]` the counts of a model, by [state, action, next state]."""
    c = model.clones
    table = np.zeros((model.states, model.actions, model.states))
    for (s, a, r), block in zip(model.triples.rows.tolist(), model.counts, strict=True):
        table[s * c : s * c + c, a, r * c : r * c + c] = block
    return table


def dense_rows(counts: np.ndarray, kappa: float) -> np.ndarray:
    """`[S, K, S]` the probabilities of dense counts."""
    total = (counts + kappa).sum(axis=2, keepdims=True)
    return np.where(total > 0, (counts + kappa) / np.where(total > 0, total, 1), 1 / counts.shape[2])


def paths(model: CloneModel, walk: Walk) -> list[tuple[tuple[int, ...], float]]:
    """Every path of clones and P(path, sights | actions)."""
    B, c = model.B, model.clones
    found: list[tuple[tuple[int, ...], float]] = []
    for clones in product(range(c), repeat=len(walk)):
        states = walk.sights * c + np.array(clones)
        value = float(np.prod(B[states[1:], states[:-1], walk.actions])) / model.states
        found.append((clones, value))
    return found
