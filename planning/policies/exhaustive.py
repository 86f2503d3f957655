"""Every sequence of actions."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..reach import Reach
from .base import Policies, check_count, check_look_ahead, frozen


def exhaustive(reach: Reach) -> Policies:
    """All K^L sequences, the paper's first way to make policies.

    Raises:
        CogmapError: `look_ahead` is below one, or there are more than two million sequences.
    """
    check_look_ahead("exhaustive", reach.look_ahead)
    return _exhaustive(len(reach.motions), reach.look_ahead)


@lru_cache(maxsize=4)
def _exhaustive(actions: int, look_ahead: int) -> Policies:
    check_count("exhaustive", actions**look_ahead, look_ahead)
    digits = actions ** np.arange(look_ahead - 1, -1, -1)
    return frozen(np.arange(actions**look_ahead)[:, None] // digits % actions)
