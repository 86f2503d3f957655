"""Where the agent believes to be, on its map."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..model import CognitiveMap
from .axes import axes_or_new, flat, write_in
from .belief_plot import Places, percent, shares_of
from .colours import VERMILION
from .map_picture import picture_of
from .map_plot import RADIUS, draw_picture
from .maze_plot import Sights
from .theme import theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HALO = 0.34  # radius of the disc behind a place, cells
LEAST = 0.005  # places that are less probable are not marked


def plot_belief_map(
    belief: Places,
    map_: CognitiveMap,
    *,
    sights: Sights | None = None,
    start: Sequence[float] = (0, 0),
    title: str | None = None,
    ax: Axes | None = None,
) -> Axes:
    """The map, and behind each place a disc as strong as it is probable that the agent is there.

    Args:
        belief: the agent's, or Q(s) by number of the place.
        map_: the map, in one or two dimensions.
        sights: the rooms of the true maze, drawn faintly beneath; label by (row, column).
        start: row and column of the place that the agent takes as its origin.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: no places, a value that is no probability, a place that the map does not have, or positions of
            more than two dimensions.
    """
    shares = {place: q for place, q in shares_of("plot_belief_map", belief).items() if q >= LEAST}
    cells = {place: map_.position(place) for place in shares}
    ax = axes_or_new(ax)
    nowhere = sum(q for place, q in shares.items() if cells[place] is None)
    notes = [f"{percent(nowhere)} of the belief among them"] if nowhere else []
    draw_picture(ax, picture_of(map_), sights=sights, start=start, notes=notes, margin=0.35)
    down, right = flat(start)
    for place, q in shares.items():
        if (position := cells[place]) is not None:
            row, column = flat(position)
            _draw_share(ax, row + down, column + right, q)
    if title is not None:
        ax.set_title(title)
    return ax


def _draw_share(ax: Axes, row: float, column: float, q: float) -> None:
    from matplotlib.patches import Circle

    theme = theme_of(ax)
    look: dict[str, Any] = {"facecolor": (*VERMILION, q), "edgecolor": theme.line(VERMILION), "linewidth": 1.4}
    ax.add_artist(Circle((column, row), HALO, zorder=1.5, **look))
    # below and to the right, where no way and no wall runs
    at = (column + RADIUS, row + 0.4)
    write_in(ax, *at, percent(q), box=(0.56, 0.24), cut=False, largest=10.0, ha="left", color=theme.ink, zorder=4)
