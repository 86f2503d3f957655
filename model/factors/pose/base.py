"""What every kind of pose offers."""

from collections.abc import Collection, Hashable, Sequence
from typing import Any, Protocol

import numpy as np

from ...dirichlet import SparseDirichlet
from ...domain import Domain
from ...motions import Motions, Position
from ...percept import Percept
from ...periods import Periods
from ...visits import Visits
from ..base import Floats, Ints, ModelFactor, Successors
from ..transition import Transition

Ahead = Sequence[tuple[Ints, float, float]]
"""Poses `[n]` that an action may lead to from `n` poses, -1 where there is none; their probability; and the likelihood
of what was measured of the move, up to a factor that is the same for all."""


class Growing(Protocol):
    """What a pose needs of the model that it is part of, to have ways lead where they were measured to."""

    motions: Motions
    sensors: Any
    transitions: Transition
    visits: Visits

    def new_place(self, position: Position | None = None, *, step: int) -> int:
        """Append a place."""
        ...


class Pose(ModelFactor):
    """The agent's estimate of where a place is: P(p | s), and how actions change it.

    Poses are numbers; what a number stands for is in `positions`.

    Attributes:
        positions: their labels.
        table: counts of P(p | s), a row a place.
        periods: that positions repeat with; none unless a pose knows better.
        measures: whether positions are in metres, or in another unit of which steps may be any number.
        settles: whether it follows from the pose alone which place is which, so that no hypotheses are weighed.
    """

    settles = False
    measures = False

    name = "pose"
    positions: Domain
    table: SparseDirichlet
    periods: Periods = ()

    @property
    def dimensions(self) -> int:
        """Numbers in a position."""
        return len(self.context.motions.displacements[0])

    @property
    def longest(self) -> float:
        """The longest step so far, in the unit of positions."""
        return 1.0

    @property
    def length(self) -> float:
        """The mean length of a step, in the unit of positions."""
        return 1.0

    def lengths_to(self, place: int, others: Ints) -> Floats:
        """`[n]` how far it is from a place to each of others next to it, in mean lengths of a step."""
        return np.ones(len(others))

    @property
    def origin(self) -> Position | None:
        """Where the agent wakes up; None where places have no positions."""
        return None

    def position(self, place: int) -> Position | None:
        """The position of a place; None where it has none."""
        return None

    def imagined(self, places: Ints) -> Floats | None:
        """`[n, D]` where places never entered are imagined to be; None for a pose whose positions stay as they are."""
        return None

    def forget(self, used: Collection[int], *, least: int) -> None:
        """Forget positions of no place that `used` has not, if they are so many."""

    def place_at(self, position: Hashable) -> int | None:
        """The place at a position; None where there is none."""
        return None

    def of(self, places: Ints) -> Ints:
        """`[n]` the pose of each place; -1 where it has none."""
        raise NotImplementedError

    def spread(self, places: Ints) -> tuple[Ints, Floats]:
        """P(p | s): poses and probabilities `[n, k]`."""
        raise NotImplementedError

    def fit(self, poses: Ints, places: Ints) -> Floats:
        """`[n]` P(p | s)."""
        raise NotImplementedError

    def predict(self, poses: Ints, action: int, percept: Percept) -> Ahead:
        """Where an action leads from poses, whether its way was sensed open before or not, and as it was measured."""
        raise NotImplementedError

    def measured(self, percept: Percept) -> Floats | None:
        """`[K]` log P(measured displacement | the move of each action), the largest 0; None where nothing was measured.

        None too where places have no positions: nobody knows then what to measure.
        """
        return None

    def stays(self, action: int, *, opened: bool) -> float:
        """Probability that an action leaves the pose as it is, by a slip or since the way was shut."""
        raise NotImplementedError

    # -- growing -------------------------------------------------------------------------------------------

    def known(self, place: int) -> bool:
        """Whether enough is known of where a place is to imagine others beside it."""
        return True

    def ahead(self, place: int, action: int) -> tuple[Position | None, int | None]:
        """Where `action` leads from a place by its pose, and the place that is there; None for what is not known."""
        raise NotImplementedError

    def leading(self, ahead: Successors, percept: Percept) -> Successors:
        """Where a move may lead, in the light of what was measured of it."""
        return ahead

    def settle(self, place: int, position: Position, *, step: int) -> None:
        """Give a place its position."""
        raise NotImplementedError

    def close(self, periods: Periods) -> None:
        """Positions that differ by one of these periods are the same from now on; only before any place has one."""

    def neighbours(self, place: int) -> Sequence[tuple[int, int]]:
        """The actions that lead from a place to another by its pose, and that place."""
        return ()

    # -- learning ------------------------------------------------------------------------------------------

    def imagine(self, place: int, source: int, action: int) -> None:
        """A place of which no position is known was imagined behind a way."""

    def spare(self) -> int | None:
        """A place that was imagined, and to which no way leads any more; None if there is none."""
        return None

    def arrive(self, model: Growing, place: int, percept: Percept, *, step: int) -> None:
        """Before inference: a way was walked from `place`; have it lead where it was measured to lead."""

    def look(self, model: Growing, place: int, percept: Percept, *, step: int) -> None:
        """After inference, where the agent is certain: it is in `place`, and senses its ways."""

    def guessed(self, ways: Transition, places: Sequence[int] | None = None) -> Sequence[tuple[int, int, float]]:
        """Place, action and doubt of the ways never walked that may lead elsewhere than is thought.

        Those of these `places`, or of all.
        """
        return ()

    def steps_in(self, place: int) -> tuple[int, ...]:
        """The last steps at which the agent was in a place, where the pose keeps them."""
        return ()

    def learn(self, place: int, weight: float) -> None:
        """The agent was in `place`, as far as it is certain (`weight`)."""

    def information(self, places: Ints, steps: int) -> Floats:
        """`[n, N + 1]` nats that 0..N more visits teach."""
        raise NotImplementedError
