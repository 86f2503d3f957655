"""Which rooms and doors of a world are closed at present."""

from typing import Any

from .errors import WorldError
from .protocol import Chart, Place

Door = tuple[Place, Place]


class Closures:
    """The closed rooms and doors of a chart, and the ways that are left.

    Attributes:
        rooms: closed rooms.
        doors: doors closed by themselves, as pairs in order (row-major in a maze).
    """

    def __init__(self, chart: Chart) -> None:
        self._chart = chart
        self.rooms: set[Place] = set()
        self.doors: set[Door] = set()

    def exits(self, room: Place) -> dict[Any, Place | None]:
        """Where each action leads from `room`; None where there is no way, or a closed door."""
        ahead = self._chart.exits(room)
        if not self.rooms and not self.doors:
            return dict(ahead)
        return {way: other if self._passable(room, other) else None for way, other in ahead.items()}

    def enterable(self, room: Any) -> Place:
        """`room` as the chart names it, if the agent can be put in.

        Raises:
            WorldError: no such room, or it is closed.
        """
        place = self._chart.find(room)
        if place in self.rooms:
            raise WorldError(f"room {place} of {self._chart.name!r} is closed; open it or choose another")
        return place

    def door(self, a: Any, b: Any) -> Door:
        """The door between two rooms, in order. Raises WorldError: no such rooms, or no door between them."""
        pair = self._chart.find(a), self._chart.find(b)
        first, second = in_order(pair)
        joined = second in self._chart.exits(first).values() or first in self._chart.exits(second).values()
        if first == second or not joined:
            raise WorldError(f"there is no door between {first} and {second}; only adjacent rooms have one")
        return first, second

    def _passable(self, room: Place, other: Place | None) -> bool:
        if other == room:
            return True
        if other is None or room in self.rooms or other in self.rooms:
            return False
        return not self.doors or in_order((room, other)) not in self.doors


def in_order(pair: Door) -> Door:
    """The pair sorted, by what is written where its parts cannot be compared."""
    try:
        first, second = sorted(pair)
    except TypeError:
        first, second = sorted(pair, key=repr)
    return first, second
