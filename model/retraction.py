"""Taking back what was learned and grown on a mistaken belief about where the agent was."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from .cognitive_map import CognitiveMap
from .lesson import Lesson


@dataclass(slots=True)
class Chapter:
    """One step of learning, and how large the map was before it.

    Attributes:
        step: the time step.
        places: number of places before it.
        visits: number of visited places before it.
        lessons: changes of counts, in order.
        doors: place, action, and what was noted of the door before: `sensed` and `walked`.
        kept: factor by which forgetting had faded the evidence first.
    """

    step: int
    places: int
    visits: int
    lessons: list[Lesson] = field(default_factory=list[Lesson])
    doors: list[tuple[int, int, int, bool]] = field(default_factory=list[tuple[int, int, int, bool]])
    kept: float = 1.0


def retract(map_: CognitiveMap, chapters: Sequence[Chapter], *, step: int) -> list[Lesson]:
    """Take back `chapters` (in order of time, and the last ones there are): the map is as before the first of them.

    Sights and positions that were met stay in their domains, and the log of growth tells of both.

    Returns:
        The lessons that undid theirs.
    """
    undone: list[Lesson] = []
    for chapter in reversed(chapters):
        undone += (replace(lesson, amount=-lesson.amount) for lesson in reversed(chapter.lessons))
        for lesson in reversed(chapter.lessons):
            row = lesson.place if lesson.action is None else map_.row(lesson.place, lesson.action)
            getattr(map_, lesson.table).add(row, lesson.outcome, -lesson.amount)
        if 0.0 < chapter.kept < 1.0:
            map_.B_s.fade(slice(len(map_.B_s)), 1.0 / chapter.kept)
        for place, action, sensed, walked in reversed(chapter.doors):
            map_.sensed[place, action], map_.walked[place, action] = sensed, walked
    first = chapters[0]
    for place in _bound_since(map_, first.step):
        map_.unbind(place, step=step)
    map_.shrink(places=first.places, visits=first.visits, step=step)
    return undone


def _bound_since(map_: CognitiveMap, step: int) -> list[int]:
    """Places that got their position since `step`."""
    bound: list[int] = []
    for event in reversed(map_.growth):
        if event.step < step:
            break
        if event.kind in ("bind", "place") and event.label is not None and event.index < len(map_.places):
            bound.append(event.index)
    return [place for place in dict.fromkeys(bound) if map_.position_index[place] >= 0]


def sizes(map_: CognitiveMap) -> tuple[int, int]:
    """Number of places, and of visited ones."""
    return len(map_.places), int(np.size(map_.visited_places))
