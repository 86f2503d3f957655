"""Where the agent believes to be, as bars."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..inference.message import Belief
from ..model import CognitiveMap
from ..model.errors import CogmapError
from .axes import axes_or_new
from .colours import SKY, VERMILION
from .theme import Theme, theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Places = Belief | Mapping[int, float]
"""Q(s) by number of the place: a belief, or the `places` of a step's record."""

TRUE, OTHER = VERMILION, SKY


def plot_belief(
    belief: Mapping[str, float],
    *,
    true: str | None = None,
    threshold: float | None = None,
    title: str | None = None,
    ax: Axes | None = None,
) -> Axes:
    """A bar for each place, as high as it is probable.

    Args:
        belief: Q(s) by what each place is called.
        true: where the agent is: its bar has another colour and a hatch, and its name a sign.
        threshold: certainty from which the agent counts as certain, drawn as a line.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: no places, or a value that is no probability.
    """
    values = _checked("plot_belief", belief)
    ax = axes_or_new(ax)
    theme = theme_of(ax)
    bars = ax.bar(np.arange(len(values)), values, color=OTHER, edgecolor=theme.shade(0.8), linewidth=0.8)
    names: list[str] = []
    for bar, place in zip(bars, belief, strict=True):
        here = true is not None and place == true
        names.append(f"▲ {place}" if here else place)
        if here:
            bar.set(facecolor=TRUE, hatch="///")
    if threshold is not None:
        ax.axhline(threshold, color=theme.shade(0.6), linewidth=0.8, linestyle=(0, (4, 3)))
    ax.set_xticks(np.arange(len(values)), names, parse_math=False)
    _turn_long_names(ax, names)
    ax.set_ylim(0.0, 1.05)
    ax.set_yticks([0.0, 0.5, 1.0])
    if title is not None:
        ax.set_title(title)
    return ax


def plot_belief_bars(
    belief: Places,
    *,
    map_: CognitiveMap | None = None,
    most: int = 12,
    threshold: float | None = None,
    title: str | None = None,
    ax: Axes | None = None,
) -> Axes:
    """A bar for each place, the most probable on top; those after the first `most` are added up.

    Args:
        belief: the agent's, or Q(s) by number of the place.
        map_: says where each place is.
        most: places with a bar of their own, 1 or more.
        threshold: certainty from which the agent counts as certain, drawn as a line.
        title: above the plot.
        ax: axes to draw on; new ones unless given.

    Raises:
        CogmapError: no places, a value that is no probability, a place that the map does not have, or `most` below 1.
    """
    if most < 1:
        raise CogmapError(f"plot_belief_bars: most is {most}; use 1 or more")
    shares = shares_of("plot_belief_bars", belief)
    bars = {name_of(place, map_): q for place, q in list(shares.items())[:most]}
    if len(shares) > most:
        bars[f"{len(shares) - most} more"] = sum(list(shares.values())[most:])
    ax = axes_or_new(ax, size=(6.0, 1.2 + 0.32 * len(bars)))
    _draw_bars(ax, bars, theme_of(ax))
    if threshold is not None:
        ax.axvline(threshold, color=theme_of(ax).shade(0.6), linewidth=0.8, linestyle=(0, (4, 3)), zorder=0.5)
    if title is not None:
        ax.set_title(title)
    return ax


def shares_of(who: str, belief: Places) -> dict[int, float]:
    """Q(s) by place, the most probable first.

    Raises:
        CogmapError: no places, or a value that is no probability.
    """
    places = belief.places if isinstance(belief, Belief) else belief
    _checked(who, places)
    return dict(sorted(places.items(), key=lambda item: -item[1]))


def name_of(place: int, map_: CognitiveMap | None) -> str:
    """What a place is called: its number and, if the map says so, its position."""
    position = None if map_ is None else map_.position(place)
    return f"place {place}" if position is None else f"place {place} at {tuple(position)}"


def percent(q: float) -> str:
    """A probability in as few signs as tell it apart from 0 and 1."""
    return ">99%" if 0.995 <= q < 1.0 - 1e-9 else "<1%" if 0.0 < q < 0.01 else f"{100 * q:.0f}%"


def _draw_bars(ax: Axes, bars: Mapping[str, float], theme: Theme) -> None:
    rows = np.arange(len(bars))
    ax.barh(rows, list(bars.values()), height=0.7, color=OTHER, edgecolor=theme.shade(0.8), linewidth=0.8)
    for row, q in zip(rows.tolist(), bars.values(), strict=True):
        ax.text(q + 0.015, row, percent(q), va="center", size="small", color=theme.ink)
    ax.set_yticks(rows, list(bars), parse_math=False)
    ax.set_ylim(len(bars) - 0.4, -0.6)
    ax.set_xlim(0.0, 1.15)
    ax.set_xticks([0.0, 0.25, 0.5, 0.75, 1.0])
    ax.set_xlabel("Q(s)")


def _turn_long_names(ax: Axes, names: list[str]) -> None:
    """Names that would run into one another stand upright."""
    from matplotlib import rcParams
    from matplotlib.font_manager import FontProperties

    figure = ax.get_figure(root=True)
    assert figure is not None
    pitch = 72 * figure.get_size_inches()[0] * ax.get_position().width / len(names)
    size = FontProperties(size=rcParams["xtick.labelsize"]).get_size_in_points()
    longest = max(len(line) for name in names for line in name.split("\n"))
    if 0.65 * size * longest > pitch:
        ax.tick_params(axis="x", labelrotation=90)


def _checked(who: str, belief: Mapping[str, float] | Mapping[int, float]) -> NDArray[np.float64]:
    values = np.array(list(belief.values()), dtype=np.float64)
    if not len(values) or not ((values >= 0.0) & (values <= 1.0 + 1e-9)).all():
        raise CogmapError(f"{who}: give a probability from 0 to 1 for each of one or more places")
    return values
