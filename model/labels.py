"""Labels as JSON and back, and when two of them are the same."""

import math
import re
from collections.abc import Hashable
from typing import Any, cast

import numpy as np

from .domain import FORGOTTEN
from .errors import CogmapError

_SURROGATE = re.compile(r"[\ud800-\udfff]")


def encode(label: Hashable, *, where: str = "save") -> Any:
    """A JSON value for a label: None, bool, int, float, str, or tuples of these.

    Args:
        label: the label.
        where: what the error begins with.

    Raises:
        CogmapError: the label is of another type, or a number that JSON does not have.
    """
    if type(label) is tuple and set(map(type, label)) == {int}:  # positions, of which there are many
        return {"tuple": list(label)}
    if isinstance(label, float) and not math.isfinite(label):
        raise CogmapError(
            f"{where}: cannot write label {label!r}, JSON has none such; label with a finite number or a str"
        )
    if isinstance(label, str) and _SURROGATE.search(label):
        raise CogmapError(f"{where}: cannot write label {label!r}, it has half of a character; label with whole text")
    if isinstance(label, tuple):
        return {"tuple": [encode(part, where=where) for part in cast(tuple[Hashable, ...], label)]}
    if label is None or isinstance(label, bool | int | float | str):
        return label
    if label is FORGOTTEN:
        return {"forgotten": True}
    kind = type(label).__name__
    raise CogmapError(
        f"{where}: cannot write label {label!r} of type {kind}; label with None, bool, int, float, str or tuple"
    )


def decode(value: Any) -> Hashable:
    """The label that `encode` wrote."""
    if isinstance(value, dict):
        if value == {"forgotten": True}:
            return FORGOTTEN
        parts = cast(dict[str, list[Any]], value)["tuple"]
        if dict not in map(type, parts):
            return tuple(parts)
        return tuple(decode(part) for part in parts)
    return value


def plain(label: Hashable) -> Hashable:
    """The label with numpy scalars replaced by Python numbers and strings, within tuples too."""
    if isinstance(label, tuple):
        return tuple(plain(part) for part in cast(tuple[Hashable, ...], label))
    return label.item() if isinstance(label, np.generic) else label


def identity(label: Hashable) -> Hashable:
    """A key that is equal for two labels if and only if they are the same label: 1, 1.0 and True are three."""
    label = plain(label)
    if isinstance(label, tuple):
        return ("tuple", *(identity(part) for part in cast(tuple[Hashable, ...], label)))
    kinds = (bool, int, float, str)
    return next((kind for kind in kinds if isinstance(label, kind)), type(label)), label


def shown(label: Hashable, *, most: int = 40) -> str:
    """The label on one line of `most` characters, for tables and pictures; a str without its quotation marks."""
    label = plain(label)
    bare = isinstance(label, str) and label.isprintable() and label.strip() == label != ""
    text = str(label) if bare else repr(label)
    return text if len(text) <= most else text[: most - 1] + "…"
