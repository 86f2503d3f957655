"""Colours of sights: functions of the label alone, told apart with any colour vision."""

from __future__ import annotations

import operator
import zlib
from collections.abc import Hashable

RGB = tuple[float, float, float]

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


def ink_on(colour: RGB) -> str:
    """Black or white, whichever is easier to read on `colour`."""
    red, green, blue = colour
    return "black" if 0.299 * red + 0.587 * green + 0.114 * blue > 0.45 else "white"
