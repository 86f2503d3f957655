"""Numbers one after another: how records of unlike lengths are written into two arrays, and read again."""

from collections.abc import Callable, Iterable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...model import CogmapError
from .records import Place, Share, SightCounts, Way
from .scheme import Reading, Sensed, WayScheme

T = TypeVar("T")


class Writer:
    """Two growing rows: whole numbers, and others; a record that occurs many times is written once, in front."""

    def __init__(self) -> None:
        self.whole: list[int] = []
        self.real: list[float] = []
        self._records: dict[int, tuple[int, Place]] = {}

    def record(self, place: Place) -> None:
        """Name a record."""
        self.whole.append(self._records.setdefault(id(place), (len(self._records), place))[0])

    def rows(self) -> dict[str, NDArray[Any]]:
        """Both rows, the records in front."""
        front = Writer()
        front.many([place for _, place in self._records.values()], front.place)
        whole, real = front.whole + self.whole, front.real + self.real
        return {"whole": np.array(whole, np.int64), "real": np.array(real, np.float64)}

    def many(self, items: Iterable[T], write: Callable[[T], object]) -> None:
        """How many there are, then each."""
        listed = list(items)
        self.whole.append(len(listed))
        for item in listed:
            write(item)

    def place(self, place: Place) -> None:
        """One record of a place."""
        self.whole += [place.frame, *place.position]
        self.many(place.recent, self.whole.append)
        self.many(place.into, self.whole.extend)
        for way in place.ways:
            self.real += (*way[:3], way.stays)
            self.whole += way[3:5]
        for counts in place.sights:
            self.many(counts.items(), self.count)
        self.real += place.share

    def count(self, item: tuple[int, float]) -> None:
        """A whole number, and how much of it."""
        self.whole.append(item[0])
        self.real.append(item[1])

    def sensed(self, item: tuple[int, Sensed]) -> None:
        """One percept, and its time."""
        time, sensed = item
        said = sensed.went is not None or sensed.fails > 0.0
        self.whole += [time, -1 if sensed.action is None else sensed.action, sensed.certain + 2 * said, sensed.told]
        self.real += [-1.0 if way is None else way for way in sensed.ways]
        if said:
            self.many(sensed.went or (), self.real.append)
            self.real.append(sensed.fails)
        for reading in sensed.sights:
            if isinstance(reading, int):
                self.whole += [-2, reading]
            elif reading is None:
                self.whole.append(-1)
            else:
                self.many(reading.items(), self.count)


class Reader:
    """Reads what a `Writer` has written.

    Raises:
        CogmapError: they are no rows of numbers, or end too soon.
    """

    def __init__(self, whole: Any, real: Any, *, share: int = len(Share()), way: int = len(Way())) -> None:
        self._share, self._way_reals = share, way - 2
        self.whole, self.real = _row(whole, "whole", np.int64), _row(real, "real", np.float64)
        self._at = self._at_real = 0
        self._records: list[Place] = []

    def records(self, scheme: WayScheme) -> None:
        """Read the records, which stand in front."""
        self._records = self.many(lambda: self.place(scheme))

    def record(self) -> Place:
        """The record that is named."""
        index = self.numbers(1)[0]
        if index < 0:
            raise CogmapError(DAMAGED.format("it names a record that it has not"))
        return self._records[index]

    def numbers(self, count: int) -> list[int]:
        """So many whole numbers."""
        found = self.whole[self._at : self._at + count]
        self._at += count
        if count < 0 or len(found) < count:
            raise CogmapError(DAMAGED.format("it ends too soon"))
        return found

    def reals(self, count: int) -> list[float]:
        """So many numbers."""
        found = self.real[self._at_real : self._at_real + count]
        self._at_real += count
        if len(found) < count:
            raise CogmapError(DAMAGED.format("it ends too soon"))
        return found

    def many(self, read: Callable[[], T]) -> list[T]:
        """As many as were written."""
        return [read() for _ in range(self.numbers(1)[0])]

    def row(self) -> list[int]:
        """As many whole numbers as were written."""
        return self.numbers(self.numbers(1)[0])

    def place(self, scheme: WayScheme) -> Place:
        """One record of a place."""
        frame, *position = self.numbers(1 + len(scheme.origin))
        recent = self.row()
        into = frozenset((source, way) for source, way in self.many(lambda: self.numbers(2)))
        ways = [self._way() for _ in range(scheme.count)]
        sights = tuple(self.counts() for _ in range(scheme.sensors))
        return Place(sights, tuple(ways), frame, tuple(position), tuple(recent), into, Share(*self.reals(self._share)))

    def _way(self) -> Way:
        net, opened, blocked, *stays = self.reals(self._way_reals)
        walks, to = self.numbers(2)
        return Way(net, opened, blocked, walks, to, *stays)

    def counts(self) -> SightCounts:
        """Whole numbers, and how much of each."""
        return dict(self.many(lambda: (self.numbers(1)[0], self.reals(1)[0])))

    def sensed(self, scheme: WayScheme) -> tuple[int, Sensed]:
        """One percept, and its time."""
        time, action, certain, told = self.numbers(4)
        ways = tuple(None if way < 0.0 else way for way in self.reals(scheme.count))
        went = tuple(self.many(lambda: self.reals(1)[0])) if certain & 2 else ()
        fails = self.reals(1)[0] if certain & 2 else 0.0
        sights = tuple(self._reading() for _ in range(scheme.sensors))
        taken = None if action < 0 else action
        return time, Sensed(sights, ways, taken, bool(certain & 1), bool(told), went=went or None, fails=fails)

    def _reading(self) -> Reading:
        kind = self.numbers(1)[0]
        if kind == -2:
            return self.numbers(1)[0]
        return None if kind == -1 else {self.numbers(1)[0]: self.reals(1)[0] for _ in range(kind)}

    def end(self) -> None:
        """Refuse what goes on after the end."""
        if self._at != len(self.whole) or self._at_real != len(self.real):
            raise CogmapError(DAMAGED.format("it goes on after its end"))


DAMAGED = "tracker: the state is damaged ({}); give what state() returned, unchanged"


def _row(values: Any, name: str, kind: type[np.generic]) -> list[Any]:
    found: NDArray[Any] = np.asarray(values)
    if found.ndim != 1 or found.dtype != kind:
        raise CogmapError(DAMAGED.format(f"`{name}` is no row of {np.dtype(kind)} numbers"))
    return found.tolist()
