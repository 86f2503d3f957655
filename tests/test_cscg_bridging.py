"""Bridges against exhaustive search."""

from __future__ import annotations

from itertools import pairwise, product

import numpy as np
import pytest
from cogmap.baselines.cscg import CloneModel, Roads, Walk, bridge, empty_model, sprinkled
from cogmap.worlds import WorldError
from cscg_models import cases
from hypothesis import given, settings
from hypothesis import strategies as st


def best_walk(model: CloneModel, belief: np.ndarray, targets: set[int], steps: int) -> float:
    """The probability of the most probable walk, by trying them all."""
    B, best = model.B, 0.0
    for n in range(steps + 1):
        for states in product(range(model.states), repeat=n + 1):
            if states[-1] in targets:
                moves = [B[after, before].max() for before, after in pairwise(states)]
                best = max(best, float(belief[states[0]] * np.prod(moves)))
    return best


@settings(max_examples=40, deadline=None)
@given(cases(), st.integers(0, 999), st.integers(0, 3))
def test_bridges_equal_exhaustive_search(case: tuple[CloneModel, Walk], seed: int, steps: int) -> None:
    model, _ = case
    rng = np.random.default_rng(seed)
    belief = rng.dirichlet(np.ones(model.states)) * (rng.random(model.states) < 0.5)
    targets = {int(state) for state in rng.integers(0, model.states, 2)}
    if model.states > 6:
        steps = min(steps, 2)
    best, found = best_walk(model, belief, targets, steps), bridge(Roads(model), belief, targets, steps=steps)
    if found is None:
        assert best == 0.0
        return
    assert np.exp(found.log_probability) == pytest.approx(best, rel=1e-9)
    assert len(found.states) == len(found.actions) + 1 <= steps + 1
    assert found.states[-1] in targets
    B = model.B[list(found.states[1:]), list(found.states[:-1]), list(found.actions)]
    assert belief[found.states[0]] * np.prod(B) == pytest.approx(best, rel=1e-9)


def test_a_bridge_follows_the_corridor() -> None:
    walk = Walk.of([0, 1, 2, 3, 2, 1, 0] * 5, ([1, 1, 1, 0, 0, 0, 2] * 5)[:-1])
    empty = empty_model(observations=4, clones=1, actions=3, pseudocount=1e-4)
    roads = Roads(sprinkled(empty, np.random.default_rng(0), among=walk))
    here = np.eye(4)[0]
    found = bridge(roads, here, {3}, steps=9)
    assert found is not None
    assert found.actions == (1, 1, 1)
    assert found.states == (0, 1, 2, 3)
    already = bridge(roads, here, {0, 3}, steps=9)
    assert already is not None
    assert already.actions == ()


def test_bad_bridges() -> None:
    roads = Roads(empty_model(observations=2, clones=2, actions=1, pseudocount=1.0))
    with pytest.raises(WorldError, match=r"target states from 0 to 3; got \[4\]"):
        bridge(roads, np.full(4, 0.25), {4}, steps=1)
    with pytest.raises(WorldError, match=r"target states from 0 to 3; got \[\]"):
        bridge(roads, np.full(4, 0.25), set(), steps=1)
    with pytest.raises(WorldError, match=r"a belief has shape \(4,\); got \(2,\)"):
        bridge(roads, np.full(2, 0.5), {1}, steps=1)
