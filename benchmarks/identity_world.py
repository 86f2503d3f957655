"""Light worlds with noise, and what a map of them is worth: for `identity.py`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from cogmap.inference.hypotheses import NOWHERE, Hypothesis, Sensed, WayScheme
from cogmap.inference.hypotheses.branches import leads
from cogmap.inference.hypotheses.evidence import probability, way_odds

UP, DOWN, LEFT, RIGHT = range(4)
DISPLACEMENTS = ((-1, 0), (1, 0), (0, -1), (0, 1))
INVERSE = (1, 0, 3, 2)


@dataclass(eq=False)
class Rooms:
    """Sights and ways of rooms: `ways[room][way]` is the room itself where there is a wall."""

    sights: list[int]
    ways: list[list[int]]
    cells: list[tuple[int, int]]

    def copy(self) -> Rooms:
        """Rooms that can be changed alone."""
        return Rooms(list(self.sights), [list(row) for row in self.ways], list(self.cells))


@dataclass(frozen=True)
class Noise:
    """Rates of what goes wrong."""

    sight: float = 0.0
    door: float = 0.0
    slip: float = 0.0
    fail: float = 0.0
    moved: float = 0.0


@dataclass(eq=False)
class World:
    """One agent in rooms."""

    rooms: Rooms
    room: int
    rng: np.random.Generator
    noise: Noise = field(default_factory=Noise)
    doors: bool = True
    time: int = 0
    history: dict[int, int] = field(default_factory=dict[int, int])

    def percept(self, action: int | None) -> Sensed:
        """What is sensed in the room, after an action."""
        noise, rng, rooms = self.noise, self.rng, self.rooms
        self.history[self.time] = self.room
        self.time += 1
        sight = rooms.sights[self.room]
        if noise.sight and rng.random() < noise.sight:
            others = sorted(set(rooms.sights) - {sight})
            sight = others[int(rng.integers(len(others)))] if others else sight
        flags: list[float | None] = [None] * 4
        if self.doors:
            for way, to in enumerate(rooms.ways[self.room]):
                is_open = to != self.room
                flags[way] = float(is_open != (rng.random() < noise.door)) if noise.door else float(is_open)
        return Sensed((sight,), tuple(flags), action)

    def act(self, action: int) -> Sensed:
        """Carry out an action, as well as the noise lets it."""
        noise, rng, carried = self.noise, self.rng, action
        if noise.slip and rng.random() < noise.slip:
            others = [way for way in range(5) if way != action]
            carried = others[int(rng.integers(4))]
        if noise.fail and rng.random() < noise.fail:
            carried = 4
        if carried < 4:
            self.room = self.rooms.ways[self.room][carried]
        if noise.moved and rng.random() < noise.moved:
            self.room = int(rng.integers(len(self.rooms.sights)))
        return self.percept(action if action < 4 else None)


def grid(cells: Mapping[tuple[int, int], int], wrap: tuple[int, int] | None = None) -> Rooms:
    order = sorted(cells)
    number = {cell: k for k, cell in enumerate(order)}
    ways: list[list[int]] = []
    for r, c in order:
        row: list[int] = []
        for dr, dc in DISPLACEMENTS:
            there = (r + dr, c + dc)
            if wrap:
                there = (there[0] % wrap[0], there[1] % wrap[1])
            row.append(number.get(there, number[r, c]))
        ways.append(row)
    return Rooms([cells[cell] for cell in order], ways, order)


def behaviours(rooms: Rooms) -> int:
    """Number of rooms that differ in behaviour, by partition refinement."""
    block = [(s, tuple(to != k for to in rooms.ways[k])) for k, s in enumerate(rooms.sights)]
    count = len(set(block))
    while True:
        names = {b: n for n, b in enumerate(dict.fromkeys(block))}
        block = [(names[block[k]], *(names[block[to]] for to in rooms.ways[k])) for k in range(len(block))]
        if len(set(block)) == count:
            return count
        count = len(set(block))


def scheme(*, poses: bool = True, inverses: bool = True) -> WayScheme:
    return WayScheme(4, INVERSE if inverses else None, DISPLACEMENTS if poses else None)


def believed(h: Hypothesis, number: int, way: int) -> tuple[int, float]:
    """The likeliest outcome of a way (its own number for a wall, NOWHERE for a new place), and its probability."""
    place = h.places[number]
    p = probability(way_odds(h, number, place, way))
    if p < 0.5:
        return number, 1.0 - p
    lead = leads(h, number, place, way)
    if lead.to != NOWHERE and lead.sure >= 0.5:
        return lead.to, p * lead.sure
    return NOWHERE, p


@dataclass(eq=False)
class Judgement:
    """A map beside the truth."""

    places: int
    right: bool
    known: float
    visited: int

    def exact(self, rooms: int) -> bool:
        """Whether the map is right, and has no place too many."""
        return self.right and self.places == rooms


def room_of(h: Hypothesis, number: int, history: Mapping[int, int]) -> int:
    return Counter(history[t] for t in h.places[number].recent).most_common(1)[0][0]


def judge(h: Hypothesis, world: World) -> Judgement:
    """`map_right` and the rest, as the rows of results define them."""
    rooms = world.rooms
    tag = {number: room_of(h, number, world.history) for number in h.places}
    place_of = {room: number for number, room in tag.items()}
    visited = set(world.history.values())
    imagined: set[object] = set()
    right = len(place_of) == len(tag) and set(place_of) == visited
    known = 0
    for number in tag:
        for way in range(4):
            to, _ = believed(h, number, way)
            if to == NOWHERE:
                imagined.add(h.beyond(h.places[number], way) or (number, way))
    for room in visited & set(place_of):
        for way, true in enumerate(rooms.ways[room]):
            to, p = believed(h, place_of[room], way)
            good = p >= 0.6 and (to == NOWHERE if true not in visited else tag.get(to) == true)
            known += good and true in visited
            right = right and (good or true not in visited)
    return Judgement(len(tag) + len(imagined), right, known / (4 * len(rooms.sights)), len(visited))


Factory = Callable[[int], Rooms]
