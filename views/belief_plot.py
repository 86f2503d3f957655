"""Where the agent believes to be, as bars."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ..model.errors import CogmapError
from .axes import axes_or_new

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TRUE, OTHER = "#d55e00", "#56b4e9"


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
    values = np.array(list(belief.values()), dtype=np.float64)
    if not len(values) or not ((values >= 0.0) & (values <= 1.0 + 1e-9)).all():
        raise CogmapError("plot_belief: give a probability from 0 to 1 for each of one or more places")
    ax = axes_or_new(ax)
    bars = ax.bar(np.arange(len(values)), values, color=OTHER, edgecolor="0.2", linewidth=0.8)
    names: list[str] = []
    for bar, place in zip(bars, belief, strict=True):
        here = true is not None and place == true
        names.append(f"▲ {place}" if here else place)
        if here:
            bar.set(facecolor=TRUE, hatch="///")
    if threshold is not None:
        ax.axhline(threshold, color="0.4", linewidth=0.8, linestyle=(0, (4, 3)))
    ax.set_xticks(np.arange(len(values)), names, parse_math=False)
    ax.set_ylim(0.0, 1.05)
    ax.set_yticks([0.0, 0.5, 1.0])
    if title is not None:
        ax.set_title(title)
    return ax
