"""Checks an observation before anything believes it."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np

from ..model.errors import CogmapError
from ..model.motions import Motions


def perceive(observation: Mapping[str, Any], motions: Motions) -> tuple[Hashable, tuple[bool, ...]]:
    """The sight, and for each action whether its way is open.

    Raises:
        CogmapError: a key is missing, the sight is not hashable or NaN, or there is not one truth value an action.
    """
    if not isinstance(observation, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
        kind = type(observation).__name__
        raise CogmapError(f"observation: is a {kind}; give a mapping with keys 'sight' and 'open'")
    for key in ("sight", "open"):
        if key not in observation:
            raise CogmapError(f"observation: key {key!r} is missing; give 'sight' and 'open'")
    return _label(observation["sight"]), _doors(observation["open"], motions)


def _label(sight: Any) -> Hashable:
    label: Any = sight.item() if isinstance(sight, np.generic) or _is_scalar_array(sight) else sight
    try:
        hash(label)
    except TypeError as error:
        kind = type(sight).__name__
        raise CogmapError(
            f"observation: sight is a {kind}, not hashable; label sights with str, int or tuple"
        ) from error
    if label != label:  # a NaN would be a new sight each time
        raise CogmapError("observation: sight is NaN, which equals nothing; label sights with str, int or tuple")
    return label


def _is_scalar_array(sight: Any) -> bool:
    return isinstance(sight, np.ndarray) and sight.ndim == 0


def _doors(open_: Any, motions: Motions) -> tuple[bool, ...]:
    try:
        doors = np.asarray(open_)
    except ValueError as error:
        raise CogmapError(
            "observation: 'open' holds lists of different lengths; give one truth value an action"
        ) from error
    if doors.shape != (len(motions),):
        names = ", ".join(motions.names)
        raise CogmapError(f"observation: 'open' has shape {doors.shape}; give one truth value an action: {names}")
    if doors.dtype != np.bool_ and not (np.issubdtype(doors.dtype, np.integer) and set(doors.tolist()) <= {0, 1}):
        raise CogmapError(f"observation: 'open' holds {doors.dtype}; give truth values")
    return tuple(bool(is_open) or action == motions.stay for action, is_open in enumerate(doors.tolist()))
