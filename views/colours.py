"""Colours of sights and of lines: functions of the label alone, told apart with any colour vision, on any ground."""

from __future__ import annotations

from collections.abc import Hashable

from ..worlds import label_colour

RGB = tuple[float, float, float]

BLACK: RGB = (0.0, 0.0, 0.0)
WHITE: RGB = (1.0, 1.0, 1.0)


def sight_colour(label: Hashable) -> RGB:
    """Red, green and blue of a label, each from 0 to 1: its `label_colour`."""
    red, green, blue = label_colour(label)
    return red / 255, green / 255, blue / 255


# Okabe and Ito (2008) without black, which is left to the walls
ORANGE, SKY, GREEN, YELLOW, BLUE, VERMILION, PURPLE, GREY = map(sight_colour, range(8))


def hexed(colour: RGB) -> str:
    """The colour as `#rrggbb`."""
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour)


def luminance(colour: RGB) -> float:
    """Relative luminance of an sRGB colour, from 0 to 1 (WCAG 2.2)."""
    red, green, blue = (part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in colour)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: RGB, other: RGB) -> float:
    """Contrast ratio of two colours, from 1 to 21 (WCAG 2.2): text asks for 4.5, lines for 3."""
    darker, lighter = sorted((luminance(one), luminance(other)))
    return (lighter + 0.05) / (darker + 0.05)


def mixed(one: RGB, other: RGB, share: float) -> RGB:
    """`share` of `one`, the rest of `other`."""
    red, green, blue = (share * a + (1.0 - share) * b for a, b in zip(one, other, strict=True))
    return red, green, blue


def ink_on(colour: RGB) -> str:
    """Black or white, whichever is easier to read on `colour`; the contrast is never below 4.5."""
    return "black" if contrast(colour, BLACK) >= contrast(colour, WHITE) else "white"


def against(colour: RGB, paper: RGB, *, least: float = 3.0) -> RGB:
    """The colour, made darker or lighter until it has the contrast `least` with `paper`."""
    towards = BLACK if ink_on(paper) == "black" else WHITE
    shades = (mixed(towards, colour, share / 20) for share in range(20))
    return next((shade for shade in shades if contrast(shade, paper) >= least), towards)
