"""A map as SVG and HTML, for notebooks: short, whatever the map."""

import numpy as np

from .labels import shown
from .markup import safe
from .readable_map import ReadableMap

CELL, RADIUS = 48, 15
LARGEST = 400  # places of a map that is drawn in a notebook
LEAST = 0.5  # probability of a way that is drawn


def map_svg(map_: ReadableMap) -> str | None:
    """Visited places filled, imagined ones dashed, ways between them; None where it has no plane to be drawn on.

    That is a map without positions, of more than two dimensions, or of more than 400 places.
    """
    cells = _cells(map_)
    if cells is None:
        return None
    top, left = (min(cell[axis] for cell in cells.values()) for axis in (0, 1))
    down, right = (max(cell[axis] for cell in cells.values()) for axis in (0, 1))
    at = {k: ((c - left) * CELL + CELL // 2, (r - top) * CELL + CELL // 2) for k, (r, c) in cells.items()}
    width, height = (right - left + 1) * CELL, (down - top + 1) * CELL
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" role="img" aria-label="map">'
    lines = [_line(at[a], at[b]) for a, b in sorted(_ways(map_)) if a in at and b in at]
    seen = _seen(map_)
    drawn = (_place(place, at[place], visited=bool(map_.visited[place]), seen=seen.get(place)) for place in cells)
    return "".join([head, *lines, *drawn, "</svg>"])


def map_html(map_: ReadableMap) -> str:
    """What it has, and its picture where it can be drawn."""
    seen = int(map_.visited.sum())
    counts = f"{len(map_.places)} places, {seen} visited, {len(map_.sights)} sights"
    return f"<div><p>{counts}</p>{map_svg(map_) or ''}</div>"


def _cells(map_: ReadableMap) -> dict[int, tuple[int, int]] | None:
    if len(map_.places) > LARGEST:
        return None
    found: dict[int, tuple[int, int]] = {}
    for place in map_.places:
        position = map_.position(place)
        if position is not None and 0 < len(position) <= 2:
            row, column = (0, *position)[-2:]
            found[place] = row, column
    return found or None


def _ways(map_: ReadableMap) -> set[tuple[int, int]]:
    """Pairs of places with a way believed open, once however many ways."""
    keys, p, _ = map_.B_s.mean(np.arange(len(map_.B_s)))
    rows, slots = np.nonzero((keys >= 0) & (p > LEAST))
    places = rows // len(map_.motions)
    pairs = zip(places.tolist(), keys[rows, slots].tolist(), strict=True)
    return {(min(pair), max(pair)) for pair in pairs if pair[0] != pair[1]}


def _line(a: tuple[int, int], b: tuple[int, int]) -> str:
    return f'<line x1="{a[0]}" y1="{a[1]}" x2="{b[0]}" y2="{b[1]}" stroke="#888" stroke-width="3"/>'


def _seen(map_: ReadableMap) -> dict[int, str]:
    """Of each place that was visited the most probable label, as text."""
    if not map_.sights_sensed:
        return {}
    places = map_.visited_places
    keys, p, _ = map_.sights_sensed[0].table.mean(places)
    best = np.take_along_axis(keys, p.argmax(axis=1)[:, None], axis=1)[:, 0]
    pairs = zip(places.tolist(), best.tolist(), strict=True)
    return {place: shown(map_.sights[number], most=200) for place, number in pairs if number >= 0}


def _place(place: int, at: tuple[int, int], *, visited: bool, seen: str | None) -> str:
    look = 'fill="#cfe3f1" stroke="#0b5c8a"' if visited else 'fill="#fff" stroke="#888" stroke-dasharray="3 3"'
    text, told = (str(place), f"place {place}") if seen is None else (shown(seen, most=5), f"place {place}: {seen}")
    return (
        f'<circle cx="{at[0]}" cy="{at[1]}" r="{RADIUS}" {look}/><text x="{at[0]}" y="{at[1] + 4}" font-size="10" '
        f'text-anchor="middle" font-family="sans-serif" fill="#000">{safe(text)}<title>{safe(told)}</title></text>'
    )
