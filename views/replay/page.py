"""A recording as one HTML file that needs nothing else."""

import base64
import hashlib
import html
import json
import re
from collections.abc import Hashable
from dataclasses import replace
from importlib.resources import files
from typing import Any

from ...model import CogmapError, decode
from ..axes import Cell
from ..map_picture import MapPicture
from ..recording import Recording
from ..theme import hexed, ink_on, sight_colour

SCRIPTS = ("draw", "data", "words", "world", "map", "belief", "policies", "times", "window", "controls")
DRAWN = (1, 2)  # dimensions that can be drawn


def replay_html(recording: Recording) -> str:
    """One HTML file, without references to anything outside, that shows the recording.

    Labels and names are only ever text in it: they stand in a block of JSON, and the page's policy allows no script
    and no style but its own.

    Raises:
        CogmapError: positions of more than two dimensions.
    """
    displacements = recording.data["motions"]["displacements"]
    dimensions = len(displacements[0]) if displacements else DRAWN[-1]
    if dimensions not in DRAWN:
        raise CogmapError(f"replay: positions have {dimensions} dimensions; only 1 or 2 can be drawn")
    script = "\n".join(["(() => {", '"use strict";', *(_asset(f"{name}.js") for name in SCRIPTS), "})();"])
    style = _asset("replay.css")
    title = recording.data["title"]
    parts = {
        "title": html.escape(f"{title} – cogmap replay" if title else "cogmap replay"),
        "policy": f"default-src 'none'; script-src '{_digest(script)}'; style-src '{_digest(style)}'; img-src data:",
        "style": style,
        "data": _embedded(_content(recording)),
        "script": script,
    }
    # one pass over the frame: what was put in is not looked at again
    return re.sub(r"@@(\w+)@@", lambda found: parts[found[1]], _asset("replay.html"))


def _asset(name: str) -> str:
    return files(__package__ or "").joinpath(name).read_text(encoding="utf-8")


def _digest(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


def _embedded(value: Any) -> str:
    """JSON that no HTML parser takes for the end of its element."""
    text = json.dumps(value, separators=(",", ":"), allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _content(recording: Recording) -> dict[str, Any]:
    """The recording, with the labels as texts in their colours, by number."""
    data, numbers = recording.data, dict[Hashable, int]()

    def number(label: Any) -> int:
        return numbers.setdefault(decode(label), len(numbers))

    world = data["world"]
    kept = ("title", "motions", "terms", "known", "places", "origin")
    content = {
        **{name: data[name] for name in kept},
        "threshold": data["settings"]["certainty"],
        "sights": [number(label) for label in data["sights"]],
        "frames": [
            {**frame, "seen": {sensor: number(label) for sensor, label in frame["seen"].items()}}
            for frame in data["frames"]
        ],
        "world": world and {**world, "places": [[*cell, number(label)] for *cell, label in world["places"]]},
        "goals": [number(label) for label in data["goals"]],
        "layout": _layout(recording),
    }
    colours = [(label, sight_colour(label)) for label in numbers]
    ink = {"black": "#000", "white": "#fff"}
    return content | {"looks": [(str(label), hexed(colour), ink[ink_on(colour)]) for label, colour in colours]}


def _layout(recording: Recording) -> list[Cell | None] | None:
    """Where the places of a map without positions, or with those that were measured, are drawn, by number."""
    largest = MapPicture.recorded(recording.data)
    for picture in recording.maps():
        if picture.located and not picture.measured:
            return None
        if len(picture.places) >= len(largest.places):
            largest = replace(picture, places=[*picture.places], rows={**picture.rows})
    cells = largest.cells
    return [cells.get(place) for place in range(len(largest.places))]
