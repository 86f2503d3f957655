"""True maps made for tests: any labels, any ways."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, eq=False)
class TestChart:
    """Places with labels, and where the ways from each lead.

    Attributes:
        sights: label of each place.
        ways: for each place where each way leads.
        positions: x and y of each place, if they are known.
    """

    __test__ = False

    sights: Mapping[Any, Hashable]
    ways: Mapping[Any, Mapping[Any, Any]] = field(default_factory=dict)
    positions: Mapping[Any, tuple[float, ...]] | None = None
    name: str = "test"

    @property
    def places(self) -> tuple[Any, ...]:
        return tuple(self.sights)

    def find(self, place: Any) -> Any:
        assert place in self.sights
        return place

    def exits(self, place: Any) -> Mapping[Any, Any]:
        return self.ways.get(place, {})

    def successors(self, place: Any) -> Mapping[Any, Any]:
        return {way: place if to is None else to for way, to in self.exits(place).items()}


def row(*labels: Hashable) -> TestChart:
    """Rooms in a row, side by side."""
    sights = {(0, at): label for at, label in enumerate(labels)}
    ways = {(0, at): {"left": (0, at - 1), "right": (0, at + 1)} for at in range(len(labels))}
    known = {place: {way: to for way, to in leads.items() if to in sights} for place, leads in ways.items()}
    return TestChart(sights, known, {place: (float(place[1]), 0.0) for place in sights})


def torus(size: int) -> TestChart:
    """A torus of `size` times `size` places at lattice positions."""
    places = [(r, c) for r in range(size) for c in range(size)]
    around = {"up": (-1, 0), "down": (1, 0), "left": (0, -1), "right": (0, 1)}
    ways = {
        (r, c): {name: ((r + down) % size, (c + right) % size) for name, (down, right) in around.items()}
        for r, c in places
    }
    return TestChart(
        {place: at for at, place in enumerate(places)}, ways, {(r, c): (float(c), -float(r)) for r, c in places}
    )
