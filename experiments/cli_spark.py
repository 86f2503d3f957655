"""A series of numbers as a line of text."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

_BLOCKS, _ASCII = "▁▂▃▄▅▆▇█", "_.-=*#"


def sparkline(values: Sequence[float], *, width: int = 60, unicode: bool = True) -> str:
    """At most `width` signs from the least to the greatest value; longer series are averaged in parts."""
    parts = np.array_split(np.asarray(values, dtype=np.float64), min(width, len(values)))
    means = np.array([part.mean() for part in parts])
    signs = _BLOCKS if unicode else _ASCII
    low, span = means.min(), np.ptp(means)
    if span < 1e-9:
        return signs[len(signs) // 2] * len(means)
    return "".join(signs[round(level)] for level in ((means - low) / span * (len(signs) - 1)).tolist())
