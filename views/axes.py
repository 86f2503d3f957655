"""What the plots share: axes without global state, cells of a grid, text that fits, legends."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypedDict

from ..model import CogmapError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Figure
    from matplotlib.text import Text
else:  # imported when something is drawn
    Axes = Figure = Text = Any

Cell = tuple[float, float]
"""Row and column."""


class Where(TypedDict, total=False):
    """Where a plot goes."""

    title: str | None  # above it
    ax: Axes | None  # to draw on; new ones unless given


def axes_or_new(*, size: tuple[float, float] = (6.0, 5.0), title: str | None = None, ax: Axes | None = None) -> Axes:
    """`ax`, or the axes of a new figure of `size` inches that belongs to no window, with the title."""
    from matplotlib.figure import Figure as Figure

    ax = Figure(figsize=size, layout="constrained").add_subplot() if ax is None else ax
    if title is not None:
        ax.set_title(title)
    return ax


def without_ticks(ax: Axes, left: float, right: float, low: float, high: float) -> None:
    """Axes of a picture rather than of numbers: units as wide as high, these limits, nothing else to be seen."""
    ax.set_xlim(left, right)
    ax.set_ylim(low, high)
    ax.set_aspect("equal")
    ax.set_xticks([])  # ticks would be laid out though nobody sees them
    ax.set_yticks([])
    ax.set_axis_off()


def as_grid(ax: Axes, cells: Iterable[Cell], *, margin: float = 0.15) -> None:
    """Square cells, rows downwards, room for exactly these cells and those already there."""
    rows, columns = zip(*cells, strict=True)
    half = 0.5 + margin
    left, right, low, high = min(columns) - half, max(columns) + half, max(rows) + half, min(rows) - half
    if not ax.axison and ax.has_data():  # a grid that something was drawn on
        (was_left, was_right), (was_low, was_high) = ax.get_xlim(), ax.get_ylim()
        left, right, low, high = min(left, was_left), max(right, was_right), max(low, was_low), min(high, was_high)
    without_ticks(ax, left, right, low, high)


def cell_points(ax: Axes) -> float:
    """Points a cell is wide, at most: the axes may still shrink for titles."""
    figure = ax.get_figure(root=True)
    assert figure is not None
    box = ax.get_position()
    width, height = figure.get_size_inches()
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    return 72 * min(width * box.width / abs(right - left), height * box.height / abs(top - bottom))


def write_in(ax: Axes, x: float, y: float, text: str, *, box: tuple[float, float], **style: Any) -> Text:
    """Text as large as its box (width and height in data units) allows, centred unless told; see `FittedText`."""
    from .fitted_text import FittedText

    look: dict[str, Any] = {"ha": "center", "va": "center", "largest": 12.0, "cut": True, **style}
    written = FittedText(x, y, text, box=box, clip_on=False, **look)
    written.set_transform(ax.transData)
    ax.add_artist(written)
    written.set_clip_path(None)
    return written


def legend_below(ax: Axes, *, columns: int = 3) -> None:
    """The legend under the axis and its label, where it hides nothing; none where nothing has a name."""
    from matplotlib.transforms import ScaledTranslation

    handles, names = ax.get_legend_handles_labels()
    figure = ax.get_figure(root=True)
    if handles and figure is not None:
        below = ax.transAxes + ScaledTranslation(0.0, -34 / 72, figure.dpi_scale_trans)
        place: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "bbox_transform": below}
        ax.legend(handles, names, ncols=columns, frameon=False, fontsize="small", **place)


def flat(position: Sequence[float]) -> Cell:
    """A position in Z or Z² as row and column. Raises CogmapError: it has another number of dimensions."""
    if len(position) not in (1, 2):
        raise CogmapError(f"plot: position {tuple(position)} has {len(position)} dimensions; only 1 or 2 can be drawn")
    return float(position[0]) if len(position) == 2 else 0.0, float(position[-1])
