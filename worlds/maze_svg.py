"""A maze as SVG, for notebooks."""

import html
import re
from collections.abc import Iterable, Mapping

from .colours import label_colour
from .maze_checks import Door, Label, Position

CELL = 40  # pixels a room
LARGEST = 1_000  # rooms of a maze that is drawn in a notebook

_NOT_XML = re.compile("[^\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_MOST = 6  # signs of a label that fit into a room


def maze_svg(name: str, sights: Mapping[Position, Label], doors: Iterable[Door]) -> str | None:
    """Rooms in the colours of their labels, and walls where no door is; None of more than a thousand rooms."""
    if len(sights) > LARGEST:
        return None
    rows, columns = (max(room[axis] for room in sights) + 1 for axis in (0, 1))
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{columns * CELL + 4}" height="{rows * CELL + 4}" '
        f'viewBox="-2 -2 {columns * CELL + 4} {rows * CELL + 4}" role="img" aria-label="maze {_safe(name)}">'
    ]
    for (row, column), label in sights.items():
        parts.append(_room(row * CELL, column * CELL, str(label), label_colour(label)))
    ways = {frozenset(door) for door in doors}
    for row, column in sights:
        for side, (down, right) in enumerate(((-1, 0), (1, 0), (0, -1), (0, 1))):
            if frozenset(((row, column), (row + down, column + right))) not in ways:
                parts.append(_wall(row * CELL, column * CELL, side))
    return "".join([*parts, "</svg>"])


def _room(top: int, left: int, label: str, colour: tuple[int, int, int]) -> str:
    red, green, blue = colour
    ink = "#000" if 0.299 * red + 0.587 * green + 0.114 * blue > 110 else "#fff"
    shown = label if len(label) <= _MOST else label[: _MOST - 1] + "…"
    return (
        f'<rect x="{left}" y="{top}" width="{CELL}" height="{CELL}" fill="#{red:02x}{green:02x}{blue:02x}"/>'
        f'<text x="{left + CELL // 2}" y="{top + CELL // 2 + 4}" text-anchor="middle" font-size="11" '
        f'font-family="sans-serif" fill="{ink}">{_safe(shown)}<title>{_safe(label)}</title></text>'
    )


def _wall(top: int, left: int, side: int) -> str:
    ends = ((0, 0, CELL, 0), (0, CELL, CELL, CELL), (0, 0, 0, CELL), (CELL, 0, CELL, CELL))[side]
    x1, y1, x2, y2 = ends
    place = f'x1="{left + x1}" y1="{top + y1}" x2="{left + x2}" y2="{top + y2}"'
    return f'<line {place} stroke="#6b6b6b" stroke-width="4" stroke-linecap="round"/>'


def _safe(text: str) -> str:
    return html.escape(_NOT_XML.sub("\ufffd", text))
