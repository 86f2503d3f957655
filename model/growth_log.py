"""The log of growth, and the short form of what in it is long ago."""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import replace

from .growth_event import GrowthEvent

ROOM = 1000  # events that are kept besides those of the steps that are


class GrowthLog(list[GrowthEvent]):
    """Everything that was ever added to a map; of steps long ago only what is still there.

    Of steps that are not among the last `keep` ones it forgets that time went on, which places were taken away again,
    and positions that places no longer have. So it grows as the map does, not as time does.

    Args:
        events: that were logged so far.
        keep: steps whose events are all kept; None for every step.
    """

    __slots__ = ("_room", "keep")

    def __init__(self, events: Iterable[GrowthEvent] = (), *, keep: int | None = None) -> None:
        super().__init__(events)
        self.keep = keep
        self._room = ROOM

    def tidy(self) -> None:
        """Now and then, make shorter what is long ago."""
        if self.keep is not None and len(self) > self._room:
            self.shorten(self[-1].step - self.keep)
            self._room = 2 * len(self) + ROOM

    def forget(self, kind: str, sensor: str | None, labels: Sequence[Hashable]) -> None:
        """Labels of a sensor, or positions, were forgotten; where every event is kept, those about them are as well."""
        gone = set(labels)
        if self.keep is not None and gone:
            self[:] = [
                event for event in self if event.kind != kind or event.sensor != sensor or event.label not in gone
            ]

    def shorten(self, before: int) -> None:
        """Keep of the steps before that one only what is still there at it."""
        recent = next((at for at, event in enumerate(self) if event.step >= before), len(self))
        self[:recent] = _left(self[:recent])


def _left(events: Sequence[GrowthEvent]) -> list[GrowthEvent]:
    """The events that lead to the same domains; places that came and went are left out."""
    places: list[int] = []  # the numbers of the events that added those that are there
    bound: dict[int, int] = {}  # the last event about the position of each
    domains: list[int] = []
    for number, event in enumerate(events):
        if event.kind in ("sight", "position"):
            domains.append(number)
        elif event.kind == "place":
            places.append(number)
        elif event.kind in ("bind", "unbind"):
            bound[event.index] = number
        elif event.kind == "retract":
            del places[len(places) - event.index :]
            bound = {place: at for place, at in bound.items() if place < len(places)}
    kept = {number: events[number] for number in (*places, *domains, *bound.values())}
    for place, number in bound.items():
        if events[number].kind == "unbind" and events[places[place]].label is None:
            del kept[number]  # it never had a position that is known
        elif events[number].kind == "unbind":
            kept[places[place]] = replace(events[places[place]], label=None)
            del kept[number]
    return [kept[number] for number in sorted(kept)]
