"""Compares a walk with its recording, and says where they part."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, cast

from .adapters import Facts

CLOSE = 1e-9
"""How far a number may be from the recorded one, plus this share of it."""

ABSENT_IS_ZERO = ("belief", "learned", "G")
"""Facts where what is not listed is zero."""


def first_difference(name: str, recorded: list[Facts], now: Iterable[Facts]) -> str | None:
    """Walk, step and fields of the first facts that differ, or None; nothing is asked of `now` beyond that."""
    steps = iter(now)
    for step, then in enumerate(recorded):
        where = f"step {step}" if step < len(recorded) - 1 else "map at the end"
        if different := list(_differences("", then, next(steps, None))):
            return f"golden walk {name!r}, {where}: " + "; ".join(different)
    return None if next(steps, None) is None else f"golden walk {name!r}: goes on after {len(recorded) - 1} steps"


def _differences(path: str, then: Any, now: Any, *, absent: Any = None) -> Iterator[str]:
    if isinstance(then, Mapping) and isinstance(now, Mapping):
        yield from _different_entries(path, cast(Mapping[str, Any], then), cast(Mapping[str, Any], now), absent)
    elif isinstance(then, list) and isinstance(now, list) and len(then) == len(now):
        for i, (one, other) in enumerate(zip(then, now, strict=True)):
            yield from _differences(f"{path}[{i}]", one, other)
    elif not _same(then, now):
        yield f"{path or 'everything'} was {then!r}, is {now!r}"


def _different_entries(path: str, then: Mapping[str, Any], now: Mapping[str, Any], absent: Any) -> Iterator[str]:
    for key in dict.fromkeys([*then, *now]):
        missing = 0.0 if key in ABSENT_IS_ZERO else None
        inner = f"{path}[{key}]" if path else key
        yield from _differences(inner, then.get(key, absent), now.get(key, absent), absent=missing)


def _same(then: Any, now: Any) -> bool:
    """Whether two values are equal, or two numbers of which one is no whole number close."""
    if isinstance(then, float) and isinstance(now, int | float) and not isinstance(now, bool):
        return then == now or (math.isfinite(then) and abs(now - then) <= CLOSE + CLOSE * abs(then))
    return type(then) is type(now) and then == now
