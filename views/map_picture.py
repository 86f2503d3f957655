"""What is shown of a map: kept beside it, told as differences from step to step, and rebuilt from them."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..model import BLOCKED, OPEN, CognitiveMap, Domain, Ints, Motions, decode
from .axes import Cell, flat
from .layout import spread
from .picture import Picture

if TYPE_CHECKING:
    import networkx as nx


NOTICEABLE = 5e-4  # by how much a probability differs from the one told last before it is told again
LEAST = 0.05  # transitions that are less probable are not drawn
DIGITS = 4  # of a probability
KNOWN = ("unknown", "imagined", "walked", "refuted")  # as in `CognitiveMap.to_networkx`; a picture has the index

Place = tuple[tuple[float, ...] | None, bool, int | None, float]
"""Position, whether it was visited, number of the most probable sight (None before the first look), its probability."""

Row = tuple[int, tuple[tuple[int, float], ...]]
"""How a transition is known (index of `KNOWN`), and the next places with their probabilities."""


@dataclass(slots=True)
class MapPicture:
    """The map as shown at one step; `apply` moves it to the next step."""

    motions: Motions  # the actions
    sights: Domain | Sequence[Hashable]  # the labels, by number
    places: list[Place] = field(default_factory=list[Place])  # by number
    rows: dict[tuple[int, int], Row] = field(default_factory=dict[tuple[int, int], Row])  # by place and action
    layout: Mapping[int, Cell] | None = None  # where places without positions are drawn; laid out unless given
    cursor: int = -1  # up to where the map's log of changes was read

    @classmethod
    def of(cls, map_: CognitiveMap) -> MapPicture:
        """The picture of a map as it is now."""
        picture = cls(map_.motions, map_.sights)
        picture.update(map_)
        return picture

    @classmethod
    def recorded(cls, data: Mapping[str, Any]) -> MapPicture:
        """The picture of a recording before its first step."""
        names, vectors = data["motions"]["names"], data["motions"]["displacements"]
        motions = Motions.of(dict(zip(names, vectors, strict=True))) if vectors else Motions(tuple(names))
        return cls(motions, [decode(label) for label in data["sights"]])

    def apply(self, delta: Mapping[str, Any]) -> None:
        """Take up what changed: `size`, `places` and `ways`, each only where it is another."""
        size = delta.get("size", len(self.places))
        if size < len(self.places):
            self.places = self.places[:size]
            self.rows = {key: row for key, row in self.rows.items() if key[0] < size}
        for place, position, visited, sight, probability in delta.get("places", ()):
            entry = (None if position is None else tuple(position), bool(visited), sight, probability)
            self.places[place : place + 1] = [entry]
        for place, action, known, *ways in delta.get("ways", ()):
            self.rows[place, action] = known, tuple(zip(ways[::2], ways[1::2], strict=True))

    def update(self, map_: CognitiveMap) -> dict[str, Any]:
        """Take up what has changed in the map since the last call; returns it as `apply` takes it, as JSON values."""
        changed, self.cursor = map_.changed_places(self.cursor)
        touched = map_.places if changed is None else sorted(place for place in changed if place in map_.places)
        numbers = np.array(touched, dtype=np.int64)
        ways = [
            [*key, known, *(part for to, q in likely for part in (to, round(q, DIGITS)))]
            for key, (known, likely) in _rows(map_, numbers)
            if _noticeable(self.rows.get(key), (known, likely))
        ]
        entries = _entries(map_, numbers)
        places = [[place, *entry] for place, entry in entries if self.places[place : place + 1] != [entry]]
        delta: dict[str, Any] = {name: part for name, part in (("places", places), ("ways", ways)) if part}
        if len(map_.places) != len(self.places):
            delta["size"] = len(map_.places)
        self.apply(delta)
        return delta

    @property
    def visited(self) -> int:
        """How many places were ever entered."""
        return sum(visited for _, visited, _, _ in self.places)

    @property
    def located(self) -> bool:
        """Whether any place has a position."""
        return any(entry[0] is not None for entry in self.places)

    @property
    def measured(self) -> bool:
        """Whether positions were measured, in metres; else they are rows and columns."""
        first = next((entry[0] for entry in self.places if entry[0] is not None), ())
        return any(isinstance(part, float) for part in first)

    @property
    def cells(self) -> Mapping[int, Cell]:
        """Row and column of each place that has a position; all are laid out where none has one."""
        if self.measured:
            return _from_above({place: entry[0] for place, entry in enumerate(self.places) if entry[0] is not None})
        if self.located:
            return {place: flat(entry[0]) for place, entry in enumerate(self.places) if entry[0] is not None}
        if self.layout is not None:
            return {place: self.layout[place] for place in range(len(self.places)) if place in self.layout}
        pairs = [(place, to) for (place, _), (_, likely) in self.rows.items() for to, q in likely if q >= LEAST]
        return {place: (0.0 - y, x) for place, (x, y) in spread(range(len(self.places)), pairs).items()}

    def drawn(self, origin: Cell = (0.0, 0.0)) -> Picture:
        """What is drawn of it, with `origin` where the agent takes its origin to be.

        A bar beside a place is a wall: P(blocked). A door of which nothing is known has none.
        """
        down, right = origin
        cells = {place: (row + down, column + right) for place, (row, column) in self.cells.items()}
        seen = [(place, entry[2] or 0) for place, entry in enumerate(self.places) if entry[1]]
        links: list[tuple[int, int, float]] = []
        walls: list[tuple[Cell, Cell, float]] = []
        for (place, action), (known, likely) in self.rows.items():
            for to, q in likely if place in cells and action != self.motions.stay else ():
                if q >= LEAST and to != place and to in cells:
                    links.append((place, to, q))
                elif q >= LEAST and to == place and self.located and not self.measured and (known or q > 0.5):
                    walls.append((*_bar(cells[place], flat(self.motions.displacements[action])), q))
        return Picture(cells, {place: self.sights[sight] for place, sight in seen}, links, walls)

    def to_networkx(self) -> nx.MultiDiGraph[Any]:
        """As `CognitiveMap.to_networkx`, with the most probable sight alone, and rounded."""
        import networkx as nx

        graph: nx.MultiDiGraph[Any] = nx.MultiDiGraph()
        for number, (position, visited, sight, probability) in enumerate(self.places):
            seen = {} if sight is None else {self.sights[sight]: probability}
            graph.add_node(number, position=position, visited=visited, sights=seen)
        for (place, action), (known, likely) in self.rows.items():
            name = self.motions.names[action]
            for to, probability in likely:
                if KNOWN[known] == "refuted" and to != place:
                    continue
                graph.add_edge(place, to, key=name, action=name, probability=probability, known=KNOWN[known])
        return graph


def _from_above(where: Mapping[int, Sequence[float]]) -> Mapping[int, Cell]:
    """Row and column of places in metres, north up, what lies higher further up; the median of steps is a unit."""
    from scipy.spatial import KDTree

    space = np.array([(*position, 0.0, 0.0)[:3] for position in where.values()], dtype=np.float64)
    points = space[:, :2] + space[:, 2:] * (0.0, 0.5)
    if len(points) > 1:
        nearest = KDTree(points).query(points, k=2)[0][:, 1]
        points = points / (np.median(nearest[nearest > 0.0]) if nearest.any() else 1.0)
    return {place: (0.0 - y, x) for place, (x, y) in zip(where, points.tolist(), strict=True)}


def _bar(cell: Cell, way: Cell) -> tuple[Cell, Cell]:
    """Ends of a wall across the way (down, right)."""
    down, right = way
    row, column = cell[0] + 0.42 * down, cell[1] + 0.42 * right
    return (row - 0.2 * right, column - 0.2 * down), (row + 0.2 * right, column + 0.2 * down)


def _entries(map_: CognitiveMap, places: Ints) -> list[tuple[int, Place]]:
    keys, p, _ = map_.A_o.mean(places)
    found: list[tuple[int, Place]] = []
    for place, sights, likely in zip(places.tolist(), keys.tolist(), p.tolist(), strict=True):
        probability, sight = max((q, k) for k, q in zip(sights, likely, strict=True))
        label, q = (sight, round(probability, DIGITS)) if sight >= 0 else (None, 0.0)
        found.append((place, (map_.position(place), bool(map_.visited[place]), label, q)))
    return found


def _rows(map_: CognitiveMap, places: Ints) -> list[tuple[tuple[int, int], Row]]:
    sensed, stay, size = map_.sensed[places], map_.motions.stay, len(map_.motions)
    known = np.where(map_.walked[places], 2, np.where(sensed == OPEN, 1, 0))
    known[sensed == BLOCKED] = 3
    known[:, stay] = 2
    keys, p, _ = map_.B_s.mean((places[:, None] * size + np.arange(size)).ravel())
    found: list[tuple[tuple[int, int], Row]] = []
    for at, (row, to, likely) in enumerate(zip(known.ravel().tolist(), keys.tolist(), p.tolist(), strict=True)):
        key = int(places[at // size]), at % size
        found.append((key, (row, tuple((k, q) for k, q in zip(to, likely, strict=True) if k >= 0))))
    return found


def _noticeable(before: Row | None, now: Row) -> bool:
    if before is None or before[0] != now[0] or [k for k, _ in before[1]] != [k for k, _ in now[1]]:
        return True
    return any(abs(p - q) >= NOTICEABLE for (_, p), (_, q) in zip(before[1], now[1], strict=True))
