"""What a plot is drawn with on the ground it is given: light, dark, or any other style."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from .colours import RGB, against, contrast, ink_on, mixed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

READABLE = 4.5  # contrast that text needs


@dataclass(frozen=True, slots=True)
class Theme:
    """Colours that can be read where the plot goes.

    Attributes:
        ink: of text and outlines.
        paper: of the ground.
    """

    ink: RGB
    paper: RGB

    def shade(self, strength: float) -> RGB:
        """From paper (0) to ink (1)."""
        return mixed(self.ink, self.paper, min(max(strength, 0.0), 1.0))

    def line(self, colour: RGB) -> RGB:
        """The colour for a line on this ground."""
        return against(colour, self.paper)


def theme_of(ax: Axes) -> Theme:
    """The theme of axes: the ground is their own or, where they have none, the figure's.

    The ink is that of the style; black or white where that could not be read on the ground.
    """
    from matplotlib import rcParams
    from matplotlib.colors import to_rgb

    paper = _ground(ax)
    ink = to_rgb(rcParams["text.color"])
    return Theme(ink if contrast(ink, paper) >= READABLE else to_rgb(ink_on(paper)), paper)


def _ground(ax: Axes) -> RGB:
    from matplotlib import rcParams
    from matplotlib.colors import to_rgb, to_rgba

    figure = ax.get_figure(root=True)
    own = [ax.get_facecolor()] if ax.axison and ax.patch.get_visible() else []
    for ground in (*own, figure.get_facecolor() if figure else "none", rcParams["savefig.facecolor"]):
        if ground != "auto" and to_rgba(ground)[3] > 0.5:
            return to_rgb(ground)
    return to_rgb("white")
