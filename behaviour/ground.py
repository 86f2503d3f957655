"""The world under a recorded walk: its places by number, its ways with their directions, and what is sensed there."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..model import CogmapError
from ..worlds import Chart, GraphWorld, WorldError, load_world

Vector = tuple[int, ...]
SCALES = (1, 10, 100)
"""Positions are brought to whole numbers by the first of these that does, else by the last: metres to centimetres."""
LEAST_WAYS = 3
"""A choice is a step from a place with so many ways or more."""


@dataclass(frozen=True)
class Way:
    """A way of a place."""

    target: int  # the number of the place that it leads to
    action: str  # what the agent calls it
    bearing: float  # its direction in degrees, clockwise


@dataclass(frozen=True)
class Ground:
    """A world as recorded walks cross it."""

    name: str  # of the world
    places: tuple[Any, ...]  # what its places are called; elsewhere they are numbers
    sights: tuple[Any, ...]  # what is sensed in each place
    # of each place, those that lead elsewhere, by the number of the place that they lead to
    ways: tuple[tuple[Way, ...], ...]
    motions: Mapping[str, Vector]  # the actions of an agent there, by name, as displacements on a lattice
    home: int | None = None  # the place that lies between bouts; None where there is none
    _spoken: Mapping[str, int] = field(default_factory=dict[str, int], repr=False)

    @classmethod
    def of(cls, chart: Chart, *, home: Any = None) -> Ground:
        """The ground of a world, by its chart.

        Args:
            chart: of a maze, or of a graph whose ways have displacements or whose places have positions.
            home: the place that lies between bouts, if it is known; see `route`.

        Raises:
            CogmapError: nobody knows how places lie to each other, two lie at one position, or no such home.
        """
        number = {place: i for i, place in enumerate(chart.places)}
        vectors = _vectors(chart)
        names: dict[Vector, str] = {}
        ways: list[tuple[Way, ...]] = []
        for place in chart.places:
            found: dict[int, Way] = {}
            for way, ahead in chart.exits(place).items():
                if ahead is None or ahead == place:
                    continue
                vector = vectors(place, way, ahead)
                action = names.setdefault(vector, way if _declared(chart) else " ".join(f"{x:+d}" for x in vector))
                bearing = math.degrees(math.atan2(vector[0], vector[-1 if len(vector) == 1 else 1])) % 360.0
                found.setdefault(number[ahead], Way(number[ahead], action, bearing))
            ways.append(tuple(found[i] for i in sorted(found)))
        if not names:
            raise CogmapError(f"{chart.name}: no way leads anywhere; give a world with ways")
        size = len(next(iter(names)))
        motions = {action: vector for vector, action in sorted(names.items())} | {"stay": (0,) * size}
        spoken = {_spoken(place): i for place, i in number.items()}
        sights = tuple(chart.sights[place] for place in chart.places)
        ground = cls(chart.name, tuple(chart.places), sights, tuple(ways), motions, None, spoken)
        return ground if home is None else ground.with_home(ground.find(home, "home"))

    def with_home(self, home: int | None) -> Ground:
        """The same with another home."""
        return Ground(self.name, self.places, self.sights, self.ways, self.motions, home, self._spoken)

    def find(self, node: Any, where: str) -> int:
        """The number of a place by its name, also where that is written as text.

        Raises:
            CogmapError: there is none; `where` says who asked.
        """
        number = self._spoken.get(_spoken(node))
        if number is None:
            raise CogmapError(f"{where}: {self.name!r} has no node {node!r}; see the nodes of the world")
        return number

    def way(self, at: int, to: int) -> Way | None:
        """The way from one place to another."""
        return next((way for way in self.ways[at] if way.target == to), None)

    def distances(self, start: int) -> list[int]:
        """Steps to `start` of each place, against the ways; -1 of what does not lead there."""
        back: list[list[int]] = [[] for _ in self.places]
        for at, ways in enumerate(self.ways):
            for way in ways:
                back[way.target].append(at)
        far, queue = [-1] * len(self.places), deque([start])
        far[start] = 0
        while queue:
            at = queue.popleft()
            for before in back[at]:
                if far[before] < 0:
                    far[before] = far[at] + 1
                    queue.append(before)
        return far

    def observation(self, place: int, *, before: int | None = None) -> dict[str, Any]:
        """What an agent senses on arriving at a place from the one before, and what was taken."""
        open_ = {way.action for way in self.ways[place]} | {"stay"}
        seen = {"sight": self.sights[place], "open": np.array([name in open_ for name in self.motions])}
        if before is None:
            return seen
        way = None if before == place else self.way(before, place)
        return seen | {"taken": "stay" if way is None else way.action}

    def observations(self, places: Iterable[int]) -> Iterator[dict[str, Any]]:
        """What is sensed along a walk."""
        before = None
        for place in places:
            yield self.observation(place, before=before)
            before = place


def load_ground(path: str, *, sights: int | str | None = None, home: Any = None) -> Ground:
    """The ground of a world by name or from a file; who walks there tells all its places apart unless the file says
    what is seen in each, or `sights` does.

    Raises:
        WorldError, CogmapError: see `load_world` and `Ground.of`.
    """
    try:
        world = load_world(path, sights=sights)
    except WorldError as error:
        if sights is not None or "nodes have no sights" not in str(error):
            raise
        world = load_world(path, sights="distinct")
    if isinstance(world, GraphWorld) and len(world.layout.sensors) > 1:
        raise CogmapError(f"{path}: has several sensors; name one in graph.sensors")
    return Ground.of(world.chart, home=home)


def _spoken(place: Any) -> str:
    """How a place is written: 5 and "5" alike, (0, 1) as "0,1"."""
    parts: Any = place if isinstance(place, tuple | list) else [place]
    text = ",".join(str(part) for part in parts)
    return text.replace(" ", "").strip("()[]")


def _declared(chart: Chart) -> bool:
    return bool(chart.motions.displacements) and not chart.motions.local


def _vectors(chart: Chart) -> Callable[[Any, Any, Any], Vector]:
    """A function of place, way and place ahead: the displacement on a lattice."""
    if _declared(chart):
        declared = dict(zip(chart.motions.names, chart.motions.displacements, strict=True))

        def by_name(place: Any, way: Any, ahead: Any) -> Vector:
            return declared[way]

        return by_name
    positions = chart.positions
    if positions is None:
        raise CogmapError(
            f"{chart.name}: its ways have no labels with a displacement and its nodes no position; "
            "give nodes a 'position', or declare graph.motions and label each way"
        )
    exact = np.array([positions[place] for place in chart.places], dtype=np.float64)
    scale = next((s for s in SCALES if np.allclose(exact * s, np.rint(exact * s), atol=1e-6)), SCALES[-1])
    whole = [tuple(int(x) for x in row) for row in np.rint(exact * scale).tolist()]
    lattice = dict(zip(chart.places, whole, strict=True))
    if len(set(whole)) < len(whole):
        twice = next(place for place, at in lattice.items() if whole.count(at) > 1)
        raise CogmapError(f"{chart.name}: node {twice!r} lies where another does; give each a position of its own")

    def by_position(place: Any, way: Any, ahead: Any) -> Vector:
        return tuple(b - a for a, b in zip(lattice[place], lattice[ahead], strict=True))

    return by_position
