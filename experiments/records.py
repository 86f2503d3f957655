"""Rows of results: frozen dataclasses whose types say how they are written as JSON, and checked when they are read."""

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any, Self, cast, get_type_hints

import numpy as np

from ..model import CogmapError
from ..worlds import Place

OPTIONAL = {"optional": True}  # metadata of a field that is left out of the JSON where it is None


class Record:
    """The base of all rows of results. Fields that are records themselves are written among the others."""

    __slots__ = ()

    def to_dict(self) -> dict[str, Any]:
        """The row as plain JSON values, in the order of its fields."""
        row: dict[str, Any] = {}
        for part in fields(cast(Any, self)):
            value = getattr(self, part.name)
            if isinstance(value, Record):
                row |= value.to_dict()
            elif value is not None or not part.metadata.get("optional"):
                row[part.name] = list(cast(tuple[Any, ...], value)) if isinstance(value, tuple) else value
        return row

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Self:
        """The row that `to_dict` gave. Raises CogmapError: a value is missing, unknown or of a wrong kind."""
        left, again = dict(values), "remove it, its run is made again"
        row = cls._taken(left, again)
        if left:
            raise CogmapError(f"row has an unknown value {min(left)!r}; {again}")
        return row

    @classmethod
    def _taken(cls, left: dict[str, Any], again: str) -> Self:
        """The row of values that are taken out of `left`."""
        made: dict[str, Any] = {}
        for part, hint in zip(fields(cast(Any, cls)), get_type_hints(cls).values(), strict=True):
            if is_dataclass(hint):
                made[part.name] = cast(Any, hint)._taken(left, again)
                continue
            if part.name not in left and "optional" not in part.metadata:
                raise CogmapError(f"row has no {part.name}; {again}")
            kind, value = _KINDS[hint], left.pop(part.name, None)
            listed = tuple(cast(list[Any], value)) if isinstance(value, list) else value
            room = isinstance(listed, tuple) and list(map(type, cast(Any, listed))) == [int, int]
            if type(listed) not in kind[1] and not (room and hint is Place):
                raise CogmapError(f"row has {part.name} = {value!r}, not {kind[0]}; {again}")
            made[part.name] = listed
        return cls(**made)


_KINDS: dict[Any, tuple[str, tuple[type, ...]]] = {
    str: ("a word", (str,)),
    str | None: ("a word or null", (str, type(None))),
    int: ("a whole number", (int,)),
    int | None: ("a whole number or null", (int, type(None))),
    float: ("a number", (int, float)),
    float | None: ("a number or null", (int, float, type(None))),
    bool | None: ("true, false or null", (bool, type(None))),
    bool: ("true or false", (bool,)),
    tuple[float, ...]: ("a list of numbers", (tuple,)),
    dict[str, float]: ("numbers by name", (dict,)),
    Place: ("a room", (int, str)),  # or a pair of whole numbers
}


def mean(values: Iterable[float | None]) -> float | None:
    """The mean of those that are there; None where none is."""
    there = [value for value in values if value is not None]
    return float(np.mean(there)) if there else None


def std(values: Iterable[float | None]) -> float | None:
    """The standard deviation (population) of those that are there; None where none is."""
    there = [value for value in values if value is not None]
    return float(np.std(there)) if there else None


def ratio(steps: Iterable[int | None], least: Iterable[int | None]) -> float | None:
    """Sum over sum: 1 where neither takes a step, None where only the second takes none, or nothing is there."""
    steps, total = [step or 0 for step in steps], sum(step or 0 for step in least)
    return sum(steps) / total if total else 1.0 if steps and not sum(steps) else None
