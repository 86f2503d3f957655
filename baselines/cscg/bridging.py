"""Bridge planning: the most probable walk from a belief to a target (max-product over states and actions)."""

from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...worlds import WorldError
from .model import CloneModel, Floats
from .sequence import Ints, distinct


@dataclass(frozen=True, slots=True)
class Bridge:
    """A walk through the model."""

    actions: tuple[int, ...]  # the n actions, in order; none where the walk begins on a target
    states: tuple[int, ...]  # the n + 1 states it leads through, the first one drawn from the belief
    log_probability: float  # log belief(first state) + sum of log P(next | state, action), nats


@dataclass(frozen=True)
class Roads:
    """The best action between any two states of a model, kept by blocks; make it once a model."""

    model: CloneModel  # the model

    @cached_property
    def ends(self) -> Ints:
        """`[E, 2]` each (next sight, sight) with a block, sorted."""
        return self._joined[0]

    @cached_property
    def blocks(self) -> Floats:
        """`[E, c, c]` log of the greatest probability of an action, by [clone, next clone]."""
        return self._joined[1]

    @cached_property
    def background(self) -> Floats:
        """`[S]` log of the greatest probability, of an action, of any one next state outside its blocks."""
        with np.errstate(divide="ignore"):
            return np.log(self.model.background.max(axis=1)).reshape(-1)

    @cached_property
    def starts(self) -> Ints:
        """The first of `ends` for each next sight that has one."""
        return np.flatnonzero(np.diff(self.ends[:, 0], prepend=-1))

    def ahead(self, scores: Floats) -> Floats:
        """`[S]` the best score of each state one action after `scores`, `[S]`."""
        c = self.model.clones
        new = np.full((self.model.observations, c), (scores + self.background).max())
        if len(self.ends):
            before = scores.reshape(-1, c)[self.ends[:, 1], :, None]
            best = np.maximum.reduceat((before + self.blocks).max(axis=1), self.starts, axis=0)
            sights = self.ends[self.starts, 0]
            new[sights] = np.maximum(new[sights], best)
        return new.reshape(-1)

    def source(self, scores: Floats, state: int) -> tuple[int, int]:
        """The state and action by which `state` is best reached from `scores`."""
        c = self.model.clones
        into = (scores + self.background).reshape(-1, c)
        for end in np.flatnonzero(self.ends[:, 0] == state // c):
            sight = self.ends[end, 1]
            into[sight] = np.maximum(into[sight], scores.reshape(-1, c)[sight] + self.blocks[end, :, state % c])
        best = int(into.argmax())
        return best, self._action(best, state)

    def _action(self, state: int, after: int) -> int:
        c, number = self.model.clones, self.model.triples.number
        values = self.model.background[state // c, :, state % c].copy()
        for action in range(self.model.actions):
            row = number.get((state // c, action, after // c))
            if row is not None:
                values[action] = self.model.blocks[row, state % c, after % c]
        return int(values.argmax())

    @cached_property
    def _joined(self) -> tuple[Ints, Floats]:
        c, rows = self.model.clones, self.model.triples.rows
        ends, which = distinct(rows[:, [2, 0]])
        best = np.zeros((len(ends), c, c))
        np.maximum.at(best, which, self.model.blocks)
        with np.errstate(divide="ignore"):
            return ends, np.log(best)


def bridge(roads: Roads, belief: Floats, targets: Collection[int] | Ints, *, steps: int) -> Bridge | None:
    """The most probable walk of at most `steps` actions from `belief` to any of the target states.

    Args:
        roads: of the model.
        belief: `[S]` probability of each state now.
        targets: states.
        steps: how many actions at most; 0 asks for targets that the belief holds already.

    Returns:
        The bridge, the shortest of equally probable ones; None where no walk has a positive probability.

    Raises:
        WorldError: no targets, targets that are no states, or a belief of another shape.
    """
    goals = _checked(roads.model, belief, targets)
    with np.errstate(divide="ignore"):
        history = [np.log(belief)]
    best, length = float(history[0][goals].max()), 0
    while len(history) <= steps and history[-1].max() > best:  # no longer walk beats the best of its beginnings
        history.append(roads.ahead(history[-1]))
        value = float(history[-1][goals].max())
        if value > best:
            best, length = value, len(history) - 1
    return None if best == -np.inf else _traced(roads, history[: length + 1], goals, best)


def _traced(roads: Roads, history: list[Floats], goals: Ints, value: float) -> Bridge:
    states, actions = [int(goals[history[-1][goals].argmax()])], list[int]()
    for scores in reversed(history[:-1]):
        state, action = roads.source(scores, states[-1])
        states.append(state)
        actions.append(action)
    return Bridge(tuple(reversed(actions)), tuple(reversed(states)), value)


def _checked(model: CloneModel, belief: Floats, targets: Collection[int] | Ints) -> Ints:
    goals = np.array(sorted(int(state) for state in targets), dtype=np.int64)
    if not goals.size or goals[0] < 0 or goals[-1] >= model.states:
        raise WorldError(f"a bridge needs target states from 0 to {model.states - 1}; got {goals.tolist()}")
    if belief.shape != (model.states,):
        raise WorldError(f"a belief has shape ({model.states},); got {belief.shape}")
    return goals
