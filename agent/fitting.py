"""Whether a value from a file is what an annotation says."""

import math
import types
from collections.abc import Callable, Hashable, Mapping, Sequence
from reprlib import repr as shown
from typing import Any, Literal, TypeVar, Union, cast, get_args, get_origin, get_type_hints

import numpy as np

from ..model import CogmapError

Made = TypeVar("Made")


def checked(kind: type[Made], parts: Mapping[str, Any]) -> Made:
    """A record of these parts, each of which fits its annotation.

    Raises:
        CogmapError: one does not.
        TypeError: one is missing, or unknown.
    """
    hints = get_type_hints(kind)
    for name, part in parts.items():
        if name not in hints or not fits(part, hints[name]):
            raise CogmapError(f"{name} of a {kind.__name__} is {shown(part)}")
    return kind(**parts)


def fits(value: Any, annotation: Any) -> bool:
    """Whether the value is one of the annotated type, all parts of it too, and every number of it is finite.

    Lists stand for deques and any other sequence, but not for tuples. Functions never come from files.
    """
    if annotation is Any:
        return True
    if annotation is None or annotation is type(None):
        return value is None
    origin, parts = get_origin(annotation), get_args(annotation)
    if hasattr(origin, "__value__"):  # a name for a type, as numpy's NDArray is from its version 2.5 on
        return fits(value, origin.__value__[parts])
    if origin in (Union, types.UnionType):
        return any(fits(value, part) for part in parts)
    if origin is Literal:
        return value in parts
    if origin is None:
        return _is_plain(value, annotation)
    if origin is np.ndarray:
        return _is_array(value, parts[1])
    if origin is Callable:
        return False
    return _is_made_of(value, origin, parts)


def _is_made_of(value: Any, origin: type[Any], parts: tuple[Any, ...]) -> bool:
    if origin is tuple:
        items = cast(tuple[Any, ...], value) if isinstance(value, tuple) else None
        kinds = parts[:1] * len(items or ()) if parts[-1] is ... else parts
        return items is not None and len(kinds) == len(items) and all(map(fits, items, kinds))
    if issubclass(origin, Mapping):
        pairs = cast(Mapping[Any, Any], value).items() if isinstance(value, Mapping) else None
        return pairs is not None and all(fits(key, parts[0]) and fits(part, parts[1]) for key, part in pairs)
    return isinstance(value, list | tuple) and all(fits(part, parts[0]) for part in cast(Sequence[Any], value))


def _is_plain(value: Any, kind: Any) -> bool:
    if kind is float:
        return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    if kind is int:
        return isinstance(value, int) and not isinstance(value, bool)
    if kind is Hashable:
        return _is_label(value)
    return isinstance(value, kind)


def _is_label(value: Any) -> bool:
    try:
        hash(value)
    except TypeError:
        return False
    return not isinstance(value, float) or math.isfinite(value)


def _is_array(value: Any, dtype: Any) -> bool:
    if not isinstance(value, np.ndarray):
        return False
    array: np.ndarray[Any, Any] = value
    wanted = get_args(dtype)[0] if get_args(dtype) else np.generic
    kind = "i" if wanted is np.int64 else "f" if wanted is np.float64 else "b" if wanted is np.bool_ else None
    return kind is None or array.dtype.kind == kind or (not array.size and array.dtype.kind in "if")
