"""Colours of sights and of lines: functions of the label alone, told apart with any colour vision, on any ground."""

from __future__ import annotations

import operator
import zlib
from collections.abc import Hashable

RGB = tuple[float, float, float]

BLACK: RGB = (0.0, 0.0, 0.0)
WHITE: RGB = (1.0, 1.0, 1.0)

# Okabe and Ito (2008) without black, which is left to the walls
_PALETTE = (
    (230, 159, 0),
    (86, 180, 233),
    (0, 158, 115),
    (240, 228, 66),
    (0, 114, 178),
    (213, 94, 0),
    (204, 121, 167),
    (153, 153, 153),
)
_TINTS = (0.0, 0.5, -0.35)  # towards white (> 0) or black (< 0)

ORANGE, SKY, GREEN, YELLOW, BLUE, VERMILION, PURPLE, GREY = (
    (red / 255, green / 255, blue / 255) for red, green, blue in _PALETTE
)


def sight_colour(label: Hashable) -> RGB:
    """Red, green and blue of a label, each from 0 to 1.

    The whole numbers 0 to 23 have colours of their own, then they repeat; other labels are hashed.
    """
    try:
        number = operator.index(label)  # type: ignore[arg-type]
        index, tint = number % len(_PALETTE), _TINTS[number // len(_PALETTE) % len(_TINTS)]
    except TypeError:
        code = zlib.crc32(str(label).encode("utf-8", "replace"))
        index, tint = code % len(_PALETTE), (code >> 8) % 64 / 64 * 0.95 - 0.35
    towards = 255 if tint > 0 else 0
    red, green, blue = (int(part * (1 - abs(tint)) + towards * abs(tint)) / 255 for part in _PALETTE[index])
    return red, green, blue


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
    for share in range(20):
        shade = mixed(towards, colour, share / 20)
        if contrast(shade, paper) >= least:
            return shade
    return towards
