"""Small pictures as text, for recordings: what a body saw."""

import base64
import struct
import zlib
from typing import Any

import numpy as np

from ..model import CogmapError

PNG = "data:image/png;base64,"
MOST_SIDE = 64  # pixels: of larger ones each so many-th


def small_png(image: Any) -> str:
    """A PNG as a URI.

    Raises:
        CogmapError: it is no picture `[height, width, 3]` of whole numbers from 0 to 255.
    """
    pixels = np.asarray(image)
    if pixels.ndim != 3 or pixels.shape[2] != 3 or not pixels.size or pixels.dtype != np.uint8:
        told = f"{pixels.dtype} of shape {pixels.shape}"
        raise CogmapError(f"recorder: pixels are {told}, no RGB; give uint8 of shape (height, width, 3)")
    every = -(-max(pixels.shape[:2]) // MOST_SIDE)
    pixels = pixels[::every, ::every]
    high, wide = pixels.shape[:2]
    rows = np.concatenate([np.zeros((high, 1), np.uint8), pixels.reshape(high, -1)], axis=1)  # 0: no filter
    head = struct.pack(">IIBBBBB", wide, high, 8, 2, 0, 0, 0)
    parts = ((b"IHDR", head), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b""))
    png = b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in parts
    )
    return PNG + base64.b64encode(png).decode()
