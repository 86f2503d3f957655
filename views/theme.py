"""Colours of sights and of lines, told apart with any colour vision, and what can be read on which ground."""

from collections.abc import Hashable
from dataclasses import dataclass

from ..worlds import label_colour
from .axes import Axes

RGB = tuple[float, float, float]

BLACK, WHITE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
READABLE = 4.5  # contrast that text needs; lines need 3


def sight_colour(label: Hashable) -> RGB:
    """Red, green and blue of a label, each from 0 to 1: its `label_colour`."""
    red, green, blue = label_colour(label)
    return red / 255, green / 255, blue / 255


# Okabe and Ito (2008) without black, which is left to the walls
ORANGE = sight_colour(0)
SKY = sight_colour(1)
GREEN = sight_colour(2)
BLUE = sight_colour(4)
VERMILION = sight_colour(5)
PURPLE = sight_colour(6)
GREY = sight_colour(7)


def hexed(colour: RGB) -> str:
    """The colour as `#rrggbb`."""
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour)


def contrast(one: RGB, other: RGB) -> float:
    """Contrast ratio of two colours, from 1 to 21 (WCAG 2.2): text asks for 4.5, lines for 3."""

    def luminance(colour: RGB) -> float:
        red, green, blue = (part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in colour)
        return 0.2126 * red + 0.7152 * green + 0.0722 * blue

    darker, lighter = sorted(map(luminance, (one, other)))
    return (lighter + 0.05) / (darker + 0.05)


def mixed(one: RGB, other: RGB, share: float) -> RGB:
    """`share` of `one`, the rest of `other`."""
    red, green, blue = (share * a + (1.0 - share) * b for a, b in zip(one, other, strict=True))
    return red, green, blue


def ink_on(colour: RGB) -> str:
    """Black or white, whichever is easier to read on `colour`; the contrast is never below 4.5."""
    return "black" if contrast(colour, BLACK) >= contrast(colour, WHITE) else "white"


@dataclass(frozen=True, slots=True)
class Theme:
    """Colours that can be read where a plot goes."""

    ink: RGB  # of text and outlines
    paper: RGB  # of the ground

    def shade(self, strength: float) -> RGB:
        """From paper (0) to ink (1)."""
        return mixed(self.ink, self.paper, min(max(strength, 0.0), 1.0))

    def line(self, colour: RGB) -> RGB:
        """The colour for a line on this ground: made darker or lighter until its contrast is 3."""
        towards = BLACK if ink_on(self.paper) == "black" else WHITE
        shades = (mixed(towards, colour, share / 20) for share in range(20))
        return next((shade for shade in shades if contrast(shade, self.paper) >= 3.0), towards)


def theme_of(ax: Axes) -> Theme:
    """The theme of axes: the ground is their own or, where they have none, the figure's.

    The ink is that of the style; black or white where that could not be read on the ground.
    """
    from matplotlib import rcParams
    from matplotlib.colors import to_rgb, to_rgba

    figure = ax.get_figure(root=True)
    own = [ax.get_facecolor()] if ax.axison and ax.patch.get_visible() else []
    grounds = (*own, figure.get_facecolor() if figure else "none", rcParams["savefig.facecolor"])
    seen = (ground for ground in grounds if ground != "auto" and to_rgba(ground)[3] > 0.5)
    paper, ink = to_rgb(next(seen, "white")), to_rgb(rcParams["text.color"])
    return Theme(ink if contrast(ink, paper) >= READABLE else to_rgb(ink_on(paper)), paper)
