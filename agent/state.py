"""What must be kept of an agent so that it walks on exactly: a JSON header and arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..inference.message import Belief, Message
from ..model.errors import CogmapError
from ..model.labels import decode, encode
from ..model.slices import Slice

Arrays = dict[str, NDArray[Any]]

_SCALARS = ("evidence", "moved", "dropped", "examined", "doubt")


def belief_state(belief: Belief | None) -> tuple[dict[str, Any] | None, Arrays]:
    """A belief as header and arrays."""
    if belief is None:
        return None, {}
    header = {name: getattr(belief, name) for name in _SCALARS}
    message = belief.message
    parts = [message.places, message.positions, message.mass, *belief.walks, belief.log_likelihood]
    return header, {f"belief.{i}": part for i, part in enumerate(parts)}


def restore_belief(header: Mapping[str, Any] | None, arrays: Mapping[str, NDArray[Any]]) -> Belief | None:
    """The belief that `belief_state` took apart.

    Raises:
        CogmapError: the arrays do not fit one another.
        KeyError: an array is missing.
    """
    if header is None:
        return None
    parts = [arrays[f"belief.{i}"] for i in range(7)]
    if any(part.ndim != 1 or part.dtype.kind != kind for part, kind in zip(parts, "iifiiff", strict=True)):
        raise CogmapError("belief: an array is no list of numbers of its kind; save the agent again")
    lengths = [len(part) for part in parts]
    if len({*lengths[:3], lengths[6]}) > 1 or len(set(lengths[3:6])) > 1 or not abs(parts[2].sum() - 1.0) < 1e-6:
        raise CogmapError("belief: the masses do not belong to its places and positions; save the agent again")
    if not (np.isfinite(parts[6]).all() and (parts[6] <= 1e-9).all()):
        raise CogmapError("belief: a likelihood is no probability; save the agent again")
    message, walks = Message(*parts[:3]), (parts[3], parts[4], parts[5])
    return Belief(message=message, walks=walks, log_likelihood=parts[6], **header)


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
    """The slices that `window_state` took apart.

    Raises:
        CogmapError: an array does not fit the places and positions of its slice.
        KeyError: an array is missing.
    """
    for i in range(len(headers)):
        n, m = (arrays[f"window.{i}.{name}"].shape for name in ("places", "positions"))
        joint, arrival = (arrays[f"window.{i}.{name}"].shape for name in ("joint", "arrival"))
        if len(n) != 1 or joint != (*n, *m) or arrival != n:
            raise CogmapError(f"window: slice {i} does not fit its places and positions; save the agent again")
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
