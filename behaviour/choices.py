"""The choices in a walk, as arrays: what was open, what was taken, and what went before."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..model import Floats, Ints
from .ground import LEAST_WAYS, Ground, Way
from .prospects import Prospects
from .routes import Route

Bools = NDArray[np.bool_]

FORWARD, RIGHT, BACK, LEFT = range(4)
RELATIONS = ("forward", "right", "back", "left")
"""How a way lies to the last move."""


@dataclass(frozen=True, eq=False)
class Choices:
    """`C` choices of one individual among `K` ways at most, those of each by the number of the place they lead to."""

    individual: str  # who chose
    places: Ints  # `[T]` the whole walk, by number of place
    step: Ints  # `[C]` where in it each choice was made
    bout: Ints  # `[C]` in which bout
    target: Ints  # `[C, K]` the place that each way leads to; -1 where there is none
    taken: Ints  # `[C]` which way was taken
    relation: Ints  # `[C, K]` how each way lies to the last move; see `RELATIONS`
    before: Ints  # `[C, 2]` what the last move and the one before it were, to theirs
    homeward: Bools  # `[C, K]` whether the way leads nearer to home
    far: Floats  # `[C]` how far home is, as a share of the farthest place
    end: Bools  # `[C, K]` whether the place that it leads to is a dead end
    prospects: Prospects | None = None  # what the agent expects beyond each way; None where no agent followed

    @property
    def open(self) -> Bools:
        """`[C, K]` which ways there are."""
        return self.target >= 0

    def __len__(self) -> int:
        return len(self.step)


@dataclass(frozen=True, slots=True)
class Fork:
    """The information about one choice before it is made."""

    step: int
    ways: tuple[Way, ...]
    relation: list[int]
    before: tuple[int, int]


class Compass:
    """Follows a walk place by place, and gives the direction of each way relative to the last move.

    Args:
        ground: of the world.
    """

    def __init__(self, ground: Ground) -> None:
        self._ground = ground
        self.places: list[int] = []
        self._heading: float | None = None
        self._moves = [FORWARD, FORWARD]

    def arrive(self, place: int) -> Fork | None:
        """Note a place that was walked to; what there is to choose from there, if there is."""
        ground = self._ground
        if self.places and place != self.places[-1]:
            way = ground.way(self.places[-1], place)
            assert way is not None  # routes are checked
            self._moves = [self._moves[-1], self._relation(way)]
            self._heading = way.bearing
        self.places.append(place)
        ways = ground.ways[place]
        if len(ways) < LEAST_WAYS:
            return None
        last, second = self._moves[1], self._moves[0]
        return Fork(len(self.places) - 1, ways, [self._relation(way) for way in ways], (last, second))

    def _relation(self, way: Way) -> int:
        moved = [at for at in self.places[-2:-1] if at != self.places[-1]]
        if moved and way.target == moved[0]:
            return BACK
        if self._heading is None:
            return FORWARD
        quarter = round(((way.bearing - self._heading) % 360.0) / 90.0) % 4
        return FORWARD if quarter == BACK and moved else quarter


def choices_of(route: Route, ground: Ground, *, prospects: Prospects | None = None) -> Choices:
    """The choices in a walk: the moves from places with three ways or more.

    Args:
        route: the walk.
        ground: of its world.
        prospects: of these choices; see `prospects_of`.
    """
    compass, forks, taken = Compass(ground), list[Fork](), list[int]()
    for place, next_ in zip(route.places.tolist(), [*route.places.tolist()[1:], -1], strict=True):
        fork = compass.arrive(place)
        if fork is not None and (at := _taken(fork, next_)) is not None:
            forks.append(fork)
            taken.append(at)
    return gathered(forks, taken, route, ground, prospects=prospects)


def _taken(fork: Fork, place: int) -> int | None:
    return next((i for i, way in enumerate(fork.ways) if way.target == place), None)


def gathered(
    forks: Sequence[Fork], taken: Sequence[int], route: Route, ground: Ground, *, prospects: Prospects | None = None
) -> Choices:
    """Forks as arrays."""
    widest = max((len(fork.ways) for fork in forks), default=LEAST_WAYS)
    shape = (len(forks), widest)
    target, relation = np.full(shape, -1, dtype=np.int64), np.zeros(shape, dtype=np.int64)
    for row, fork in enumerate(forks):
        target[row, : len(fork.ways)] = [way.target for way in fork.ways]
        relation[row, : len(fork.ways)] = fork.relation
    home = int(route.places[0]) if ground.home is None else ground.home
    far, step = np.array(ground.distances(home)), np.array([fork.step for fork in forks], dtype=np.int64)
    here = far[route.places[step]]
    ends = np.array([len(ways) == 1 for ways in ground.ways])
    return Choices(
        individual=route.individual,
        places=route.places,
        step=step,
        bout=route.bout[step],
        target=target,
        taken=np.array(taken, dtype=np.int64),
        relation=relation,
        before=np.array([fork.before for fork in forks], dtype=np.int64).reshape(-1, 2),
        homeward=(target >= 0) & (far[target] < here[:, None]),
        far=here / max(1, int(far.max())),
        end=(target >= 0) & ends[target],
        prospects=prospects,
    )
