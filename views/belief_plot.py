"""Where the agent believes to be: as bars, and on its map."""

from collections.abc import Mapping, Sequence
from typing import Any, Unpack

import numpy as np

from ..inference import Belief
from ..model import CogmapError, CognitiveMap
from ..worlds import Chart
from .axes import Axes, Where, axes_or_new, write_in
from .map_picture import MapPicture
from .map_plot import draw_map, underlay
from .picture import RADIUS
from .theme import SKY, VERMILION, theme_of

Places = Belief | Mapping[int, float]  # Q(s) by number of the place: a belief, or the `places` of a step's record

TRUE, OTHER = VERMILION, SKY
HALO = 0.34  # radius of the disc behind a place, cells
LEAST = 0.005  # places that are less probable are not marked


def plot_belief(
    belief: Mapping[str, float], *, true: str | None = None, threshold: float | None = None, **where: Unpack[Where]
) -> Axes:
    """One bar per place, as high as the place is probable.

    Args:
        belief: Q(s) by what each place is called.
        true: where the agent is: its bar has another colour and a hatch, and its name a sign.
        threshold: certainty from which the agent counts as certain, drawn as a line.

    Raises:
        CogmapError: no places, or a value that is no probability.
    """
    _checked("plot_belief", belief)
    ax = axes_or_new(**where)
    theme = theme_of(ax)
    bars = ax.bar(range(len(belief)), list(belief.values()), color=OTHER, edgecolor=theme.shade(0.8), linewidth=0.8)
    names = [f"▲ {place}" if place == true else place for place in belief]
    for bar, place in zip(bars, belief, strict=True):
        if place == true:
            bar.set(facecolor=TRUE, hatch="///")
    if threshold is not None:
        ax.axhline(threshold, color=theme.shade(0.6), linewidth=0.8, linestyle=(0, (4, 3)))
    ax.set_xticks(range(len(names)), names, parse_math=False)
    _turn_long_names(ax, names)
    ax.set_ylim(0.0, 1.05)
    ax.set_yticks([0.0, 0.5, 1.0])
    return ax


def plot_belief_bars(
    belief: Places,
    *,
    map_: CognitiveMap | None = None,
    most: int = 12,
    threshold: float | None = None,
    **where: Unpack[Where],
) -> Axes:
    """One bar per place, the most probable at the top. All after the first `most` are summed.

    Args:
        belief: the agent's, or Q(s) by number of the place.
        map_: says where each place is.
        most: places with a bar of their own, 1 or more.
        threshold: certainty from which the agent counts as certain, drawn as a line.

    Raises:
        CogmapError: no places, a value that is no probability, a place that the map does not have, or `most` below 1.
    """
    if most < 1:
        raise CogmapError(f"plot_belief_bars: most is {most}; use 1 or more")
    shares = _checked("plot_belief_bars", belief)
    lies = {place: map_.position(place) if map_ else None for place in list(shares)[:most]}
    bars = {f"place {place}" + (f" at {tuple(at)}" if at else ""): shares[place] for place, at in lies.items()}
    if len(shares) > most:
        bars[f"{len(shares) - most} more"] = sum(list(shares.values())[most:])
    ax = axes_or_new(size=(6.0, 1.2 + 0.32 * len(bars)), **where)
    theme = theme_of(ax)
    rows = np.arange(len(bars))
    ax.barh(rows, list(bars.values()), height=0.7, color=OTHER, edgecolor=theme.shade(0.8), linewidth=0.8)
    for row, q in zip(rows.tolist(), bars.values(), strict=True):
        ax.text(q + 0.015, row, _percent(q), va="center", size="small", color=theme.ink)
    if threshold is not None:
        ax.axvline(threshold, color=theme.shade(0.6), linewidth=0.8, linestyle=(0, (4, 3)), zorder=0.5)
    ax.set_yticks(rows, list(bars), parse_math=False)
    ax.set_ylim(len(bars) - 0.4, -0.6)
    ax.set_xlim(0.0, 1.15)
    ax.set_xticks([0.0, 0.25, 0.5, 0.75, 1.0])
    ax.set_xlabel("Q(s)")
    return ax


def plot_belief_map(
    belief: Places, map_: CognitiveMap, *, chart: Chart | None = None, start: Any = (0, 0), **where: Unpack[Where]
) -> Axes:
    """The map, with a disc behind each place that is as strong as the place is probable.

    Args:
        belief: the agent's, or Q(s) by number of the place.
        map_: the map, in one or two dimensions.

    Raises:
        CogmapError: no places, a value that is no probability, a place that the map does not have, positions of
            more than two dimensions, or `start` is no place of the chart.
    """
    from matplotlib.patches import Circle

    shares = {place: q for place, q in _checked("plot_belief_map", belief).items() if q >= LEAST}
    picture = MapPicture.of(map_)
    lost = sum(q for place, q in shares.items() if map_.position(place) is None and place not in picture.cells)
    ax = axes_or_new(**where)
    note = f"{_percent(lost)} of the belief among them" if lost else ""
    cells = draw_map(ax, picture, underlay(chart, start), note=note, margin=0.35).cells
    theme, box = theme_of(ax), (0.56, 0.24)
    for place, q in shares.items():
        if place in cells:
            row, column = cells[place]
            look: dict[str, Any] = {"facecolor": (*VERMILION, q), "edgecolor": theme.line(VERMILION), "linewidth": 1.4}
            ax.add_artist(Circle((column, row), HALO, zorder=1.5, **look))
            look = {"cut": False, "largest": 10.0, "ha": "left", "color": theme.ink, "zorder": 4}
            write_in(ax, column + RADIUS, row + 0.4, _percent(q), box=box, **look)  # where no way and no wall runs
    return ax


def _checked(who: str, belief: Belief | Mapping[Any, float]) -> dict[Any, float]:
    """Q(s) by place, the most probable first."""
    places = belief.places if isinstance(belief, Belief) else belief
    values = np.array(list(places.values()), dtype=np.float64)
    if not len(values) or not ((values >= 0.0) & (values <= 1.0 + 1e-9)).all():
        raise CogmapError(f"{who}: give a probability from 0 to 1 for each of one or more places")
    return dict(sorted(places.items(), key=lambda item: -item[1]))


def _percent(q: float) -> str:
    """A probability in as few signs as tell it apart from 0 and 1."""
    return ">99%" if 0.995 <= q < 1.0 - 1e-9 else "<1%" if 0.0 < q < 0.01 else f"{100 * q:.0f}%"


def _turn_long_names(ax: Axes, names: Sequence[str]) -> None:
    """Names that would run into one another stand upright."""
    from matplotlib import rcParams
    from matplotlib.font_manager import FontProperties

    size = FontProperties(size=rcParams["xtick.labelsize"]).get_size_in_points()
    longest = max(len(line) for name in names for line in name.split("\n"))
    figure = ax.get_figure(root=True)
    assert figure is not None
    if 0.65 * size * longest > 72 * figure.get_size_inches()[0] * ax.get_position().width / len(names):
        ax.tick_params(axis="x", labelrotation=90)
