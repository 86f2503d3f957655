"""Rows of results: frozen dataclasses whose types say how they are written as JSON, and checked when they are read."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any, Self, cast, get_type_hints

import numpy as np

from ..model import CogmapError
from ..worlds import Place

OPTIONAL = {"optional": True}
"""Metadata of a field that is left out of the JSON where it is None."""


class Record:
    """What rows of results have in common; fields that are records themselves are written among the others."""

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
        """The row that `to_dict` gave.

        Raises:
            CogmapError: a value is missing, unknown or of a wrong kind.
        """
        known: set[str] = set()
        for name, hint, optional in _leaves(cls):
            kind, fits = _KINDS[hint]
            if name not in values and not optional:
                raise CogmapError(f"row has no {name}; remove it, its run is made again")
            if not fits(values.get(name)):
                raise CogmapError(f"row has {name} = {values[name]!r}, not {kind}; remove it, its run is made again")
            known.add(name)
        if unknown := sorted(set(values) - known):
            raise CogmapError(f"row has an unknown value {unknown[0]!r}; remove it, its run is made again")
        return cls._made(values)

    @classmethod
    def _made(cls, values: Mapping[str, Any]) -> Self:
        made: dict[str, Any] = {}
        for name, hint in get_type_hints(cls).items():
            value = cast(Any, hint)._made(values) if is_dataclass(hint) else values.get(name)
            made[name] = tuple(cast(list[Any], value)) if isinstance(value, list) else value
        return cls(**made)


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


def _leaves(cls: Any) -> Iterator[tuple[str, Any, bool]]:
    """Name and type of each field that is no record, and whether it may be missing."""
    for part in fields(cls):
        hint = get_type_hints(cls)[part.name]
        yield from _leaves(hint) if is_dataclass(hint) else [(part.name, hint, "optional" in part.metadata)]


def _whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _place(value: Any) -> bool:
    """A room of a maze, or the name of a node."""
    pair = isinstance(value, list) and len(cast(list[Any], value)) == 2 and all(map(_whole, cast(list[Any], value)))
    return pair or _whole(value) or isinstance(value, str)


_KINDS: dict[Any, tuple[str, Callable[[Any], bool]]] = {
    str: ("a word", lambda value: isinstance(value, str)),
    int: ("a whole number", _whole),
    int | None: ("a whole number or null", lambda value: value is None or _whole(value)),
    float: ("a number", lambda value: _whole(value) or isinstance(value, float)),
    Place: ("a room", _place),
}
