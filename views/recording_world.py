"""A world as a recording has it: its places by number, and how it is drawn."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..model import CogmapError, encode, plain
from ..worlds import Chart, Place
from .picture import Picture
from .world_plot import as_place, world_picture

DIGITS = 3  # of a coordinate


class Places:
    """Numbers of places: those of the chart, in its order, or of all that turn up.

    Args:
        chart: the true map of the world, where it is to be shown.
    """

    def __init__(self, chart: Chart | None) -> None:
        self.world = None if chart is None else _world_json(world_picture(chart))
        self._name = "" if chart is None else chart.name
        self._numbers: dict[Place, int] = {} if chart is None else {at: n for n, at in enumerate(chart.places)}

    def number(self, place: Place) -> int:
        """The number of a place.

        Raises:
            CogmapError: it is none of the chart.
        """
        place = as_place(place)
        if self.world is not None and place not in self._numbers:
            raise CogmapError(f"recorder: {place!r} is no place of {self._name!r}; see chart.places")
        return self._numbers.setdefault(place, len(self._numbers))

    def numbers(self, places: Iterable[Place]) -> list[int]:
        """The numbers of several, ascending."""
        return sorted(map(self.number, places))

    def to_json(self) -> list[Any]:
        """What the places are called, by number."""
        return [encode(plain(place)) for place in self._numbers]


def _world_json(picture: Picture) -> dict[str, Any]:
    """What is drawn of a world: `[row, column, label]` of each place, `[a, b, one way]` and the bends of each way."""
    number = {place: at for at, place in enumerate(picture.cells)}
    lines, ways = picture.lines, {(a, b) for a, b, _ in picture.links}
    once = [(a, b) for a, b, _ in picture.links if number[a] < number[b] or (b, a) not in ways]
    return {
        "rooms": picture.rooms,
        "places": [
            [*(round(part, DIGITS) for part in cell), encode(plain(picture.labels[place]), where="recorder")]
            for place, cell in picture.cells.items()
        ],
        "ways": [
            [number[a], number[b], int((b, a) not in ways), *lines[a, b][1:-1].round(DIGITS).tolist()] for a, b in once
        ],
        "walls": [[*one, *other] for one, other, _ in picture.walls],
    }
