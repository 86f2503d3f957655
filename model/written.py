"""Attributes of the places of a graph, which files of graphs can hold."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, cast

import numpy as np

from .errors import CogmapError
from .labels import encode, plain


class PlaceFacts(dict[str, Any]):
    """What a graph says of a place; a position is a tuple, sights are a dict.

    Writers of GraphML and GEXF know numbers and text only, and go over `items()`: these have the others as JSON text,
    as `map_node_link` writes them, and leave out what is None.
    """

    __slots__ = ()

    def items(self) -> Any:
        """Names and values that any file of a graph can hold."""
        return {name: _held(self[name]) for name in self if self[name] is not None}.items()

    def copy(self) -> PlaceFacts:
        """A copy of it."""
        return PlaceFacts(self)

    def __reduce__(self) -> Any:
        return PlaceFacts, (dict(self),)


def shares_json(shares: Mapping[Any, float]) -> list[dict[str, Any]]:
    """Labels and their probabilities as JSON values. Raises CogmapError: a label cannot be written as JSON."""
    return [{"sight": encode(plain(label), where="map"), "probability": p} for label, p in shares.items()]


def jsonable(value: Any) -> Any:
    """The value as plain JSON values; what JSON has not is written out as Python would."""
    if isinstance(value, dict):
        return {str(plain(key)): jsonable(each) for key, each in cast(dict[Any, Any], value).items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [jsonable(each) for each in cast(list[Any], value)]
    try:
        return encode(plain(value))
    except CogmapError:
        return repr(value)


def _held(value: Any) -> Any:
    if isinstance(value, str | int | float | bool):
        return value
    try:
        return json.dumps(shares_json(cast(dict[Any, float], value)) if isinstance(value, dict) else jsonable(value))
    except CogmapError:  # labels that JSON has not
        return json.dumps(jsonable(value))
