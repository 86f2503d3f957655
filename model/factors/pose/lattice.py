"""Positions in Z^n: P(p | s) as Dirichlet counts A_p, one-hot in practice, and B_p, p + displacement(a)."""

from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from ...changes import Store
from ...column import Column
from ...dirichlet import SparseDirichlet
from ...domain import FORGOTTEN, Domain
from ...errors import CogmapError
from ...growth_event import GrowthEvent
from ...labels import decode, encode
from ...motions import Position
from ...percept import Percept
from ...periods import Periods, reduced
from ..base import Context, Floats, Ints, Support, Table, parts_of
from .base import Ahead, Pose
from .odometry import odometry

MANY = 2**25  # entries of B_p that a file may ask for whose map has few places


class Lattice(Pose):
    """Positions on a lattice, relative to the start. A place has one position, and a position one place.

    Of places that the agent was put into without knowing where they are, positions are relative to the first of them:
    such a position has the number of the fragment as a last coordinate, and `position` gives None.

    Args:
        slip: probability that a motion through an open door does not change the position, or through a blocked one
            does; that of the model's settings unless given.

    Attributes:
        positions: those met so far, by number.
        table: A_p, a row a place.
        periods: of a lattice that closes on itself, such as that of a torus.
        beyond: `[P, K]` B_p: the position that each motion leads to; -1 where it has no number yet.

    Raises:
        CogmapError: the slip is no probability.
    """

    def __init__(self, *, slip: float | None = None) -> None:
        if slip is not None and not 0.0 <= slip <= 1.0:
            raise CogmapError(f"pose: slip is {slip!r}; use a number from 0 to 1")
        self._slip = slip
        self.periods: Periods = ()

    @property
    def options(self) -> dict[str, Any]:
        """The slip."""
        return {"slip": self._slip}

    def attach(self, context: Context) -> None:
        """Make it part of a model."""
        super().attach(context)
        log = context.changes
        self.motions = context.motions
        self.slip = context.slip if self._slip is None else self._slip
        self.positions = Domain("positions")
        self.table = SparseDirichlet(name="A_p", slots=1, changes=log)
        self.position_of = Column("position_of", np.int64, fill=-1, changes=log)
        self.places = Column("place_at", np.int64, fill=-1, changes=log)
        self.beyond = Column("beyond", np.int64, width=len(context.motions), fill=-1)

    @property
    def stores(self) -> tuple[Store, ...]:
        """A_p, and which place is where."""
        return self.table, self.position_of, self.places

    def grow(self, places: int) -> None:
        """A new place has no position yet."""
        self.table.resize(places)
        self.position_of.resize(places)

    def savepoint(self) -> tuple[Any, Any]:
        """Which positions there are, and the periods that they repeat with."""
        return self.positions.savepoint(), getattr(self, "periods", ())

    def go_back(self, point: tuple[Any, Any]) -> None:
        """Have the positions of then, and what lies beside each."""
        positions, self.periods = point
        self.positions.go_back(positions)
        self.places.resize(len(self.positions))
        self.beyond.resize(0)
        self.beyond.resize(len(self.positions))
        for index, position in enumerate(self.positions):
            self._connect(index, cast(Position, position))

    def state(self) -> dict[str, Any]:
        """The positions."""
        periods = {"periods": [list(row) for row in self.periods]} if self.periods else {}
        return {"positions": [encode(position) for position in self.positions], **periods}

    def restore(self, state: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], places: int) -> None:
        """Take over positions and counts. Raises CogmapError: a place is not where its position has it."""
        self.periods = tuple(tuple(map(int, row)) for row in state.get("periods", ()))
        positions = [decode(position) for position in state["positions"]]
        self._check([position for position in positions if position is not FORGOTTEN], places)
        self.positions.take(positions)
        self.places.resize(len(positions))
        self.beyond.resize(len(positions))
        for index, position in enumerate(positions):
            self._connect(index, cast(Position, position))
        self.grow(places)
        self.table.restore(parts_of(self.table, arrays), outcomes=len(self.positions))
        self.position_of.restore(parts_of(self.position_of, arrays), least=-1, bound=len(self.positions))
        self.places.restore(parts_of(self.places, arrays), least=-1, bound=places)
        here, there = self.position_of.values, self.places.values
        known, taken = np.flatnonzero(here >= 0), np.flatnonzero(there >= 0)
        if not ((there[here[known]] == known).all() and (here[there[taken]] == taken).all()):
            raise CogmapError("map: a place is not where its position has it; save it again")
        if not (self.table.probability(here[known], known) > 0.0).all():
            raise CogmapError("map: a place has no counts for its own position; save it again")

    def _check(self, positions: Sequence[Hashable], places: int) -> None:
        """Refuse what are no positions, and so many that a table of them would fill the memory."""
        dimensions = len(self.origin)
        for position in positions:
            numbers = cast(tuple[int, ...], position) if isinstance(position, tuple) else ()
            if set(map(type, numbers)) != {int} or len(numbers) not in (dimensions, dimensions + 1):
                raise CogmapError(f"map: {position!r} is no position; save it again")
            if max(map(abs, numbers)) >= 2**62:
                raise CogmapError("map: a position is too far away; save it again")
        if len(set(positions)) < len(positions):
            raise CogmapError("map: two positions are the same; save it again")
        if len(positions) > 8 * places + MANY // len(self.motions):
            raise CogmapError(f"map: it has {len(positions)} positions of {places} places; save it again")

    # -- reading -------------------------------------------------------------------------------------------

    @property
    def origin(self) -> Position:
        """Zero."""
        return (0,) * len(self.motions.displacements[0])

    def position(self, place: int) -> Position | None:
        """The position of a place relative to the start; None where that is not known."""
        known = self._known(place)
        return None if known is None or len(known) > len(self.motions.displacements[0]) else known

    def _known(self, place: int) -> Position | None:
        """The position of a place, in whatever fragment."""
        index = int(self.position_of.values[place])
        return None if index < 0 else cast(Position, self.positions[index])

    def moved(self, position: Position, action: int) -> Position:
        """The position that `action` leads to, the one that stands for all that differ by periods."""
        step = self.motions.displacements[action]
        moved = tuple(x + d for x, d in zip(position, step, strict=False))
        if len(position) > len(step):
            return (*moved, position[-1])
        return reduced(moved, self.periods) if self.periods else moved

    def place_at(self, position: Hashable) -> int | None:
        """The place at a position; None where there is none."""
        index = self.positions.find(position)
        place = -1 if index is None else int(self.places.values[index])
        return None if place < 0 else place

    def of(self, places: Ints) -> Ints:
        """`[n]` the position of each place; -1 where it has none."""
        return self.position_of.values[places]

    def spread(self, places: Ints) -> tuple[Ints, Floats]:
        """A_p: positions and probabilities `[n, k]`."""
        keys, p, _ = self.table.mean(places)
        return keys, p

    def fit(self, poses: Ints, places: Ints) -> Floats:
        """`[n]` A_p(p, s)."""
        return self.table.probability(poses, places)

    def stays(self, action: int, *, opened: bool) -> float:
        """Probability that the position stays, but for `stay` itself."""
        return 1.0 - self._moves(action, opened=opened)

    def _moves(self, action: int, *, opened: bool) -> float:
        return 1.0 if action == self.motions.stay else 1.0 - self.slip if opened else self.slip

    def predict(self, poses: Ints, action: int, percept: Percept) -> Ahead:
        """B_p: moved on, or not; and P(measured displacement | that)."""
        moves = self._moves(action, opened=percept.opened)
        log = self.measured(percept)
        gone, stayed = (1.0, 1.0) if log is None else np.exp(log[[action, self.motions.stay]]).tolist()
        return (self.beyond.values[poses, action], moves, gone), (poses, 1.0 - moves, stayed)

    def measured(self, percept: Percept) -> Floats | None:
        """`[K]` log P(measured displacement | the move of each action); None where nothing was measured."""
        return None if percept.displacement is None else odometry(self.motions, percept.displacement)

    def information(self, places: Ints, steps: int) -> Floats:
        """`[n, N + 1]` nats that 0..N more visits teach of A_p."""
        return self.context.information(self.table.concentration(places)[1], steps)

    def tables(self, support: Support) -> Iterable[Table]:
        """B_p[a](p_t, p_t-1), anything where the agent was moved; and A_p(p_t, s_t)."""
        poses, t = support.positions, support.step
        if support.before is not None and support.percept.action is not None:
            action = support.percept.action
            ahead = self.predict(support.before[1], action, support.percept)
            name, given = f"B_p[{self.motions.names[action]}]", "" if support.arrival is None else ", moved_t"
            values = partial(_motion, ahead, poses, moved=support.arrival is not None)
            told = "p_t" if support.percept.displacement is None else "p_t, measured"
            yield Table(name, support.scope("p"), values, "motion", f"P({told} | p_t-1, a_t-1{given})")
        values = partial(_places, *self.spread(support.places), poses)
        yield Table("A_p", (f"p{t}", f"s{t}"), values, "place", "P(p_t | s_t)")

    # -- growing and learning ------------------------------------------------------------------------------

    def new_position(self, position: Position, *, step: int) -> int:
        """The number of a position; the domain, and B_p, grow where it is new."""
        known = self.positions.find(position)
        if known is None:
            known = self._add(position)
            self.context.grown(GrowthEvent(step, "position", known, position))
        return known

    def _add(self, position: Position) -> int:
        index = self.positions.add(position)
        if index < len(self.beyond):  # it was that of another position
            self.beyond.values[self.beyond.values == index] = -1
            self.beyond.values[index] = -1
        self.places.resize(len(self.positions))
        self.beyond.resize(len(self.positions))
        self._connect(index, position)
        return index

    def forget(self, used: Collection[int], *, least: int) -> None:
        """Forget positions of no place that `used` has not, if so many; their numbers become those of others."""
        numbers = {*used, *self.position_of.values.tolist()}
        self.context.forgotten("position", None, self.positions.forget(numbers, least=least))

    def _connect(self, index: int, position: Position) -> None:
        """Name what lies beside a position, unless another one stands for it."""
        if position is FORGOTTEN:
            return
        if self.periods and len(position) == len(self.origin) and reduced(position, self.periods) != position:
            return
        for action, beside in enumerate(self._around(position)):
            there = self.positions.find(beside)
            if there is not None:
                self.beyond.values[index, action] = there
                self.beyond.values[there, self.motions.inverse[action]] = index

    def _around(self, position: Position) -> list[Position]:
        """`moved` of each action."""
        if self.periods:
            return [self.moved(position, action) for action in range(len(self.motions))]
        size = len(self.origin)
        fragment, moved = position[size:], np.array(self.motions.displacements) + position[:size]
        return [(*there, *fragment) for there in moved.tolist()]

    def known(self, place: int) -> bool:
        """Whether it has a position."""
        return bool(self.position_of.values[place] >= 0)

    def ahead(self, place: int, action: int) -> tuple[Position | None, int | None]:
        """Where `action` leads from a place, and the place that is there."""
        here = self._known(place)
        there = None if here is None else self.moved(here, action)
        return there, None if there is None else self.place_at(there)

    def settle(self, place: int, position: Position, *, step: int) -> None:
        """Give a place its position."""
        index = self.new_position(position, step=step)
        self.position_of.set(place, index)
        self.places.set(index, place)
        self.table.expect(place, index, self.context.priors.position)

    def blank(self, place: int) -> None:
        """It has no position."""
        index = self.position_of.values.item(place)
        super().blank(place)
        if index >= 0:
            self.position_of.set(place, -1)
            self.places.set(index, -1)

    def close(self, periods: Periods) -> None:
        """Positions that differ by one of these periods are the same from now on.

        Raises:
            CogmapError: there are places with positions.
        """
        if (self.places.values >= 0).any():
            raise CogmapError("pose: a lattice closes on itself before it has places, not after; clear the map first")
        if periods != self.periods:
            self.periods = periods
            self.beyond.values[:] = -1
            for index, position in enumerate(self.positions):
                self._connect(index, cast(Position, position))

    def neighbours(self, place: int) -> Sequence[tuple[int, int]]:
        """The actions that lead from a place to one beside it, and that place."""
        index = int(self.position_of.values[place])
        if index < 0:
            return ()
        ahead = enumerate(self.beyond.values[index].tolist())
        places = [(action, int(self.places.values[there])) for action, there in ahead if there >= 0]
        return [(action, there) for action, there in places if there >= 0 and action != self.motions.stay]

    def learn(self, place: int, weight: float) -> None:
        """The count of its position gains `weight` times the rate."""
        self.table.add(place, int(self.position_of.values[place]), weight * self.context.rates.likelihood)


def _motion(ahead: Ahead, poses: Ints, *, moved: bool) -> Floats:
    """`[m, m']` P(p_t | p_t-1, a), or `[m, m', 2]`: anything where the agent was moved."""
    values = sum((p * told * (poses[:, None] == there[None]) for there, p, told in ahead), np.zeros(()))
    return np.stack([values, np.ones_like(values)], axis=-1) if moved else values


def _places(keys: Ints, p: Floats, poses: Ints) -> Floats:
    """`[m, n]` P(p_t | s_t)."""
    return np.einsum("jk,ijk->ij", p, keys == poses[:, None, None])
