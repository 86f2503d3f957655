"""One moment of a growing map, and what is said of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from ..model.growth_event import GrowthEvent
from .map_picture import MapPicture

_WORDS = {"place": "imagined", "sight": "new sight", "bind": "bound", "unbind": "unbound", "retract": "taken back"}


@dataclass(frozen=True, slots=True)
class GrowthFrame:
    """One moment of a growing map.

    Attributes:
        step: of the agent's last observation.
        picture: what is drawn of the map.
        place: where the agent believed to be.
        news: what had been added since the frame before.
    """

    step: int
    picture: MapPicture
    place: int
    news: str


def caption(frame: GrowthFrame) -> str:
    """The step, the size of the map, and what is new, in two lines."""
    visited = sum(place.visited for place in frame.picture.places.values())
    size = len(frame.picture.places) + frame.picture.lost
    return (
        f"step {frame.step}: {size} place{'s' if size != 1 else ''}, {visited} visited\n{frame.news or 'nothing new'}"
    )


def news_of(events: Sequence[GrowthEvent]) -> str:
    """What the events added, such as "2 imagined, new sight 7"."""
    counts = Counter[str]()
    for event in events:
        if event.kind in _WORDS:
            counts[event.kind] += event.index if event.kind == "retract" else 1
    sights = [str(event.label) for event in events if event.kind == "sight"]
    parts = [f"{count} {_WORDS[kind]}" for kind, count in counts.items() if kind != "sight"]
    return ", ".join([*parts, *([f"new sight {', '.join(sights)[:24]}"] if sights else [])])
