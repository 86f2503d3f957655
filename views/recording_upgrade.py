"""Recordings of earlier schemas in the present one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..planning import TERMS
from .recording_file import SCHEMA
from .terms import term_json

Number = Callable[[list[int]], int]


def upgraded(data: dict[str, Any]) -> dict[str, Any]:
    """A recording in the present schema; 1 knew mazes, one sensor of sights and one of doors, and the paper's terms.

    Raises:
        AttributeError, LookupError, TypeError, ValueError: it is damaged.
    """
    if data["schema"] == SCHEMA:
        return data
    maze, numbers = data["maze"], dict[tuple[int, ...], int]()

    def number(room: list[int] | tuple[int, ...]) -> int:
        return numbers.setdefault(tuple(room), len(numbers))

    for row, column, _ in maze or ():
        number((row, column))
    beside = [(a, (a[0] + down, a[1] + right)) for a in numbers for down, right in ((1, 0), (0, 1))]
    world = {"rooms": True, "places": maze, "walls": []}
    world["ways"] = [[numbers[a], numbers[b], 0] for a, b in beside if b in numbers]
    origin = None if data["origin"] is None else number(data["origin"])
    frames = [_upgraded_frame(frame, number) for frame in data["frames"]]
    looks = {term.name: term_json(term) for term in TERMS}
    return {
        **{name: value for name, value in data.items() if name not in ("maze", "sights")},
        "schema": SCHEMA,
        "terms": [looks[name] for name in data["terms"]],
        "sensors": {"sight": data["sights"]},
        "places": [{"tuple": list(room)} for room in numbers],
        "world": maze and world,
        "origin": origin,
        "frames": frames,
    }


def _upgraded_frame(frame: dict[str, Any], number: Number) -> dict[str, Any]:
    new = {name: value for name, value in frame.items() if name != "sight"}
    new["seen"] = {"sight": frame["sight"]}
    if "at" in frame:
        new["at"] = number(frame["at"])
    if "closed_rooms" in frame:
        new["closed_rooms"] = [number(room) for room in frame["closed_rooms"]]
    if "closed_doors" in frame:
        new["closed_doors"] = [[number(a), number(b)] for a, b in frame["closed_doors"]]
    return new
