"""The clone-structured model: a hidden Markov model whose states are (sight, clone)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...worlds import WorldError
from .sequence import Triples, Walk, distinct

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class CloneModel:
    """Transitions between clones, kept for the triples that occurred alone.

    State `sight * clones + clone` emits its sight with certainty. The first state is uniform over all S =
    observations * clones states. With counts C, pseudocount kappa and the sum over all next states,

        P(next | state, action) = (C + kappa) / (sum C + kappa * S),

    and 1/S where that is 0/0. Outside the triples C is zero.
    """

    observations: int  # how many sights there can be
    clones: int  # clones a sight, c
    actions: int  # how many actions there are, K
    triples: Triples  # the N (sight, action, next sight) with a block
    counts: Floats  # `[N, c, c]` C[triple, clone, next clone]
    pseudocount: float  # kappa, added to every count

    @property
    def states(self) -> int:
        """S, how many states there are."""
        return self.observations * self.clones

    @cached_property
    def totals(self) -> Floats:
        """`[G, c]` the counts of each (sight, action) and clone, pseudocounts included."""
        summed = self.counts.sum(axis=2)
        if len(summed):
            summed = np.add.reduceat(summed, self.triples.starts, axis=0)
        return summed + self.pseudocount * self.states

    @cached_property
    def blocks(self) -> Floats:
        """`[N, c, c]` P(next clone, next sight | clone, sight, action) for each triple."""
        totals = self.totals[self.triples.group][:, :, None]
        if self.pseudocount > 0.0:
            return (self.counts + self.pseudocount) / totals
        return np.divide(self.counts, totals, out=np.full_like(self.counts, 1 / self.states), where=totals > 0)

    @cached_property
    def background(self) -> Floats:
        """`[observations, K, c]` the probability of any one next state outside the triples."""
        table = np.full((self.observations, self.actions, self.clones), 1 / self.states)
        sights, actions = self.triples.heads.T
        here = table[sights, actions]
        np.divide(self.pseudocount, self.totals, out=here, where=self.totals > 0)
        table[sights, actions] = here
        return table

    @property
    def B(self) -> Floats:
        """`[S, S, K]` the dense P(next | previous, action) as B[next, previous, action]."""
        c, n = self.clones, self.observations
        rows = np.broadcast_to(self.background[:, :, :, None, None], (n, self.actions, c, n, c)).copy()
        sights, actions, after = self.triples.rows.T
        rows[sights, actions, :, after, :] = self.blocks
        return rows.transpose(3, 4, 0, 2, 1).reshape(self.states, self.states, self.actions)

    def covering(self, walk: Walk) -> CloneModel:
        """The same model with blocks, of no counts where they are new, for every triple of `walk`.

        Raises:
            WorldError: a sight or an action the model has no room for.
        """
        sights, actions = int(walk.sights.max()) + 1, int(walk.actions.max(initial=-1)) + 1
        if sights > self.observations or actions > self.actions:
            raise WorldError(
                f"a walk of {sights} sights and {actions} actions does not fit a model of {self.observations} and "
                f"{self.actions}; give the model as many"
            )
        if np.array_equal(self.triples.rows, walk.triples):
            return self
        rows, place = distinct(np.concatenate([self.triples.rows, walk.triples]))
        counts = np.zeros((len(rows), self.clones, self.clones))
        counts[place[: len(self.triples)]] = self.counts
        return replace(self, triples=Triples(rows), counts=counts)


def empty_model(*, observations: int, clones: int, actions: int, pseudocount: float) -> CloneModel:
    """A model without any counts: every transition alike.

    Raises:
        WorldError: fewer than one observation, clone or action, or a negative pseudocount.
    """
    for name, value in (("observations", observations), ("clones", clones), ("actions", actions)):
        if value < 1:
            raise WorldError(f"a clone-structured model needs {name} of 1 or more; got {value}")
    if not (np.isfinite(pseudocount) and pseudocount >= 0.0):
        raise WorldError(f"a pseudocount is a finite number of 0 or more; got {pseudocount}")
    triples = Triples(np.zeros((0, 3), dtype=np.int64))
    return CloneModel(observations, clones, actions, triples, np.zeros((0, clones, clones)), float(pseudocount))


def sprinkled(model: CloneModel, rng: np.random.Generator, *, among: Walk) -> CloneModel:
    """The model with counts drawn uniformly from [0, 1) for the triples of `among` that have none.

    Raises:
        WorldError: a sight or an action the model has no room for.
    """
    model = model.covering(among)
    bare = ~model.counts.any(axis=(1, 2))
    counts = model.counts.copy()
    counts[bare] = rng.random((int(bare.sum()), model.clones, model.clones))
    return replace(model, counts=counts)
