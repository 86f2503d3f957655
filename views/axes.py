"""What the plots share: axes without global state, grids of cells, text that fits."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from ..model.errors import CogmapError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Cell = tuple[float, float]
"""Row and column."""

SMALLEST = 4.5  # points; text that would be smaller is left out


def axes_or_new(ax: Axes | None) -> Axes:
    """`ax`, or the axes of a new figure that belongs to no window."""
    if ax is not None:
        return ax
    from matplotlib.figure import Figure

    return Figure(figsize=(6.0, 5.0), layout="constrained").add_subplot()


def as_grid(ax: Axes, cells: Iterable[Cell], *, margin: float = 0.15) -> None:
    """Square cells, rows downwards, no ticks, room for exactly these cells."""
    rows, columns = zip(*cells, strict=True)
    half = 0.5 + margin
    ax.set_xlim(min(columns) - half, max(columns) + half)
    ax.set_ylim(max(rows) + half, min(rows) - half)
    ax.set_aspect("equal")
    ax.set_axis_off()


def cell_points(ax: Axes) -> float:
    """Points a cell is wide, at most: the axes may still shrink for titles."""
    figure = ax.get_figure(root=True)
    assert figure is not None
    box = ax.get_position()
    width, height = figure.get_size_inches()
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    return 72 * min(width * box.width / abs(right - left), height * box.height / abs(top - bottom))


def fitting_size(text: str, *, width: float, height: float) -> float | None:
    """Font size in points at which `text` fits into a box of points; None where nothing legible does."""
    size = min(height / 1.25, width / (0.65 * max(len(text), 1)), 12.0)
    return None if size < SMALLEST else size


def flat(position: Sequence[float]) -> Cell:
    """A position in Z or Z² as row and column.

    Raises:
        CogmapError: it has another number of dimensions.
    """
    if len(position) == 1:
        return 0.0, float(position[0])
    if len(position) == 2:
        return float(position[0]), float(position[1])
    raise CogmapError(f"plot: position {tuple(position)} has {len(position)} dimensions; only 1 or 2 can be drawn")
