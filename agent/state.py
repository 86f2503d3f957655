"""What must be kept of an agent so that it walks on exactly: a JSON header and arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..inference.message import Belief, Message
from ..model.slices import Slice
from .labels import decode, encode

Arrays = dict[str, NDArray[Any]]

_SCALARS = ("evidence", "complexity", "accuracy", "moved", "dropped", "examined")


def belief_state(belief: Belief | None) -> tuple[dict[str, Any] | None, Arrays]:
    """A belief as header and arrays."""
    if belief is None:
        return None, {}
    header = {name: getattr(belief, name) for name in _SCALARS}
    message = belief.message
    parts = [message.places, message.positions, message.mass, *belief.walks]
    return header, {f"belief.{i}": part for i, part in enumerate(parts)}


def restore_belief(header: Mapping[str, Any] | None, arrays: Mapping[str, NDArray[Any]]) -> Belief | None:
    """The belief that `belief_state` took apart."""
    if header is None:
        return None
    parts = [arrays[f"belief.{i}"] for i in range(6)]
    return Belief(message=Message(*parts[:3]), walks=(parts[3], parts[4], parts[5]), **header)


def window_state(window: Sequence[Slice]) -> tuple[list[dict[str, Any]], Arrays]:
    """The slices of the window as headers and arrays."""
    headers: list[dict[str, Any]] = []
    arrays: Arrays = {}
    for i, slice_ in enumerate(window):
        header: dict[str, Any] = {}
        for field in fields(Slice):
            value = getattr(slice_, field.name)
            if isinstance(value, np.ndarray):
                arrays[f"window.{i}.{field.name}"] = value
            else:
                header[field.name] = encode(value)
        headers.append(header)
    return headers, arrays


def restore_window(headers: Sequence[Mapping[str, Any]], arrays: Mapping[str, NDArray[Any]]) -> list[Slice]:
    """The slices that `window_state` took apart."""
    names = [field.name for field in fields(Slice)]
    return [
        Slice(
            **{
                name: decode(header[name]) if name in header else arrays[f"window.{i}.{name}"]  # type: ignore[arg-type]
                for name in names
            }
        )
        for i, header in enumerate(headers)
    ]
