"""The part of a world that somebody walked through, for pictures of worlds that are too large to draw."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from .errors import WorldError
from .motions import Motions
from .protocol import Chart, Place


@dataclass(frozen=True, eq=False)
class ChartPart:
    """Some places of a chart and the ways among them. It is a chart itself."""

    whole: Chart  # the chart
    places: tuple[Place, ...]  # those of the part, in the order in which they were given

    @classmethod
    def around(cls, whole: Chart, walked: Iterable[Place]) -> ChartPart:
        """The places that were walked through, and those that a way leads to from there."""
        inside = dict.fromkeys(walked)
        beside = (other for place in tuple(inside) for other in whole.successors(place).values())
        return cls(whole, tuple(inside | dict.fromkeys(beside)))

    @property
    def name(self) -> str:
        """That of the whole."""
        return self.whole.name

    @property
    def motions(self) -> Motions:
        """The actions."""
        return self.whole.motions

    @property
    def sights(self) -> Mapping[Any, Any]:
        """The label of each place."""
        return {place: self.whole.sights[place] for place in self.places}

    @property
    def positions(self) -> Mapping[Any, tuple[float, ...]] | None:
        """Where each place lies; None where nobody knows."""
        where = self.whole.positions
        return None if where is None else {place: where[place] for place in self.places}

    def find(self, place: Any) -> Place:
        """`place` as it stands in `places`; a WorldError if it is none of the part."""
        if (found := self.whole.find(place)) not in self._inside:
            raise WorldError(f"{self.name!r} has {found!r} outside this part; see places")
        return found

    def exits(self, place: Place) -> dict[Any, Place | None]:
        """Where each action leads; None of no way, or one out of the part."""
        return {way: other if other in self._inside else None for way, other in self.whole.exits(place).items()}

    def successors(self, place: Place) -> dict[Any, Place]:
        """The same; what is no way leads back."""
        return {way: place if other is None else other for way, other in self.exits(place).items()}

    def length(self, place: Place, way: Any) -> float | None:
        """How long a way is; None where nobody knows."""
        return self.whole.length(place, way)

    @cached_property
    def _inside(self) -> frozenset[Place]:
        return frozenset(self.places)
