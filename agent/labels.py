"""Labels as JSON and back: what a saved map may be labelled with."""

from __future__ import annotations

import math
from collections.abc import Hashable
from typing import Any, cast

from ..model.errors import CogmapError


def encode(label: Hashable) -> Any:
    """A JSON value for a label: None, bool, int, float, str, or tuples of these.

    Raises:
        CogmapError: the label is of another type.
    """
    if isinstance(label, float) and not math.isfinite(label):
        raise CogmapError(
            f"save: cannot write label {label!r}, JSON has none such; label with a finite number or a str"
        )
    if isinstance(label, tuple):
        return {"tuple": [encode(part) for part in cast(tuple[Hashable, ...], label)]}
    if label is None or isinstance(label, bool | int | float | str):
        return label
    kind = type(label).__name__
    raise CogmapError(
        f"save: cannot write label {label!r} of type {kind}; label with None, bool, int, float, str or tuple"
    )


def decode(value: Any) -> Hashable:
    """The label that `encode` wrote."""
    if isinstance(value, dict):
        return tuple(decode(part) for part in cast(dict[str, list[Any]], value)["tuple"])
    return value
