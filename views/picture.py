"""A map, the true one or the one believed, as a picture of places and of the ways between them."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..model import Floats
from .axes import Axes, Cell, cell_points, write_in
from .theme import Theme, ink_on, mixed, sight_colour, theme_of

Node = Any

RADIUS = 0.24  # of a place, cells
NEAR = 0.3  # a way that passes a place nearer than this is bent
FAINT = 0.3  # how much of a colour is left beneath another picture


@dataclass(frozen=True, slots=True)
class Picture:
    """Places and ways."""

    cells: Mapping[Node, Cell]  # row and column of each place; those side by side are about a unit apart
    labels: Mapping[Node, Any]  # of the places that were seen; others are drawn as imagined
    links: Sequence[tuple[Node, Node, float]]  # a place, the next one, and the probability of the way there
    walls: Sequence[tuple[Cell, Cell, float]]  # the two ends of each wall, and its probability
    rooms: bool = False  # whether the places are rooms on a grid, to be drawn as squares

    @property
    def lines(self) -> dict[tuple[Node, Node], Floats]:
        """The line `[n, 2]` of each pair that is linked, there and back: straight, or bent around places between."""
        from scipy.spatial import KDTree

        tree, nodes = KDTree(np.array([*self.cells.values()]).reshape(-1, 2)), list(self.cells)
        lines: dict[tuple[Node, Node], Floats] = {}
        for a, b, _ in self.links:
            if (a, b) not in lines:
                start, end = np.array(self.cells[a]), np.array(self.cells[b])
                length = float(np.linalg.norm(end - start))
                stops = int(4 * length) if length > 1.2 else 0
                near: Any = tree.query(start + np.arange(1, stops + 1)[:, None] / (stops + 1) * (end - start))
                passed = {nodes[at] for at in near[1][near[0] < NEAR].tolist()} - {a, b}
                lines[a, b] = _bent(start, end, length) if passed else np.stack([start, end])
                lines[b, a] = lines[a, b][::-1]
        return lines


def _bent(start: Floats, end: Floats, length: float) -> Floats:
    aside = (0.6 / length + 0.1) * np.array([start[1] - end[1], end[0] - start[0]])
    t = np.linspace(0.0, 1.0, 13)[:, None]
    return (1 - t) * start + t * end + 2 * t * (1 - t) * aside


def draw_picture(
    ax: Axes, picture: Picture, *, thick: float = 0.11, faint: bool = False, closed: Collection[Node] = ()
) -> None:
    """Draw on axes that have room for it: rooms and seen places in the colour of their label, ways, walls.

    The half of a link that leaves a place is as wide and as dark as the way is probable, and so is a wall.

    Args:
        ax: the axes.
        picture: what is drawn.
        thick: width of a link that is certain, cells.
        faint: pale and without labels, to be drawn over.
        closed: places that are hatched.
    """
    theme, points = theme_of(ax), cell_points(ax)
    edge, hollow = theme.shade(FAINT if faint else 1.0), {"edgecolor": theme.shade(0.75), "linestyle": (0, (2, 1.5))}
    for node, cell in picture.cells.items():
        look: dict[str, Any] = {"facecolor": theme.paper, **hollow}
        if node in closed:
            look = {"facecolor": theme.paper, "edgecolor": theme.shade(0.7), "hatch": "////"}
        elif node in picture.labels:
            colour = sight_colour(picture.labels[node])
            look = {"facecolor": mixed(colour, theme.paper, FAINT) if faint else colour, "edgecolor": edge}
        text = "" if faint or node in closed else str(picture.labels.get(node, ""))
        (_draw_room if picture.rooms else _draw_place)(ax, cell, text, look)
    ink = Theme(edge, theme.paper)
    lines = {} if picture.rooms else picture.lines
    halves = [(_half(lines[a, b]), p) for a, b, p in picture.links if lines]
    _draw_lines(ax, halves, ink, widest=min(thick * points, 7.0), cap="butt")
    walls = [(np.array(ends), p) for *ends, p in picture.walls]
    _draw_lines(ax, walls, ink, widest=min(0.06 * points, 4.0), cap="round")


def _draw_room(ax: Axes, cell: Cell, text: str, look: dict[str, Any]) -> None:
    from matplotlib.patches import Rectangle
    from matplotlib.patheffects import withStroke

    (row, column), floor, wide = cell, look["facecolor"], min(1.5, cell_points(ax) / 20)
    edge: dict[str, Any] = {"zorder": 1.1} if "hatch" in look else {"edgecolor": theme_of(ax).paper}
    ax.add_artist(Rectangle((column - 0.5, row - 0.5), 1, 1, **(look | edge), linewidth=wide))
    if text:
        style: dict[str, Any] = {"color": ink_on(floor), "ha": "left", "va": "top", "zorder": 5}
        written = write_in(ax, column - 0.44, row - 0.44, text, box=(0.8, 0.27), **style)
        written.set_path_effects([withStroke(linewidth=2, foreground=floor)])


def _draw_place(ax: Axes, cell: Cell, text: str, look: dict[str, Any]) -> None:
    from matplotlib.patches import Circle

    (row, column), wide = cell, min(1.4, cell_points(ax) / 18)
    ax.add_artist(Circle((column, row), RADIUS, linewidth=wide, zorder=2, **look))
    if text:
        box = (1.6 * RADIUS, 1.2 * RADIUS)
        write_in(ax, column, row, text, box=box, color=ink_on(look["facecolor"]), zorder=3)


def _half(line: Floats) -> Floats:
    """From the first end to a hair beyond the middle: halves that only met would show a seam."""
    last = len(line) // 2 - 1
    return np.vstack([line[: last + 1], line[last] + (1.02 - 0.51 * (last == 0)) * (line[last + 1] - line[last])])


def _draw_lines(ax: Axes, lines: Iterable[tuple[Floats, float]], theme: Theme, *, widest: float, cap: Any) -> None:
    """Lines as wide (`widest` points) and as strong as they are probable, the likely ones on top."""
    from matplotlib.collections import LineCollection

    if drawn := sorted(lines, key=lambda line: line[1]):
        widths = [max(widest * p, 0.8) for _, p in drawn]
        style: dict[str, Any] = {"colors": [theme.shade(0.3 + 0.6 * p) for _, p in drawn], "capstyle": cap}
        ax.add_collection(LineCollection([line[:, ::-1] for line, _ in drawn], linewidths=widths, zorder=1.2, **style))
