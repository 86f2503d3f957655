"""The colour of a label, wherever it is drawn."""

import operator
import zlib
from collections.abc import Hashable

import numpy as np

# Okabe and Ito (2008), eight colours told apart with any colour vision; black is left to the walls
_PALETTE = np.array(
    [
        (230, 159, 0),
        (86, 180, 233),
        (0, 158, 115),
        (240, 228, 66),
        (0, 114, 178),
        (213, 94, 0),
        (204, 121, 167),
        (153, 153, 153),
    ]
)
_TINTS = (0.0, 0.5, -0.35)  # towards white (> 0) or black (< 0)


def label_colour(label: Hashable) -> tuple[int, int, int]:
    """RGB of a label, a function of the label alone.

    The whole numbers 0 to 23 have colours of their own; then they repeat. Other labels are hashed onto the palette.
    """
    try:
        number = operator.index(label)  # pyright: ignore[reportArgumentType]
        index, tint = number % len(_PALETTE), _TINTS[number // len(_PALETTE) % len(_TINTS)]
    except TypeError:
        code = zlib.crc32(str(label).encode("utf-8", "replace"))
        index, tint = code % len(_PALETTE), (code >> 8) % 64 / 64 * 0.95 - 0.35
    towards = 255 if tint > 0 else 0
    red, green, blue = (_PALETTE[index] * (1 - abs(tint)) + towards * abs(tint)).astype(int).tolist()
    return red, green, blue
