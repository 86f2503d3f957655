"""Means and spreads of figures some of which are missing, and how figures are written."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np


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
    if total:
        return sum(steps) / total
    return 1.0 if steps and not sum(steps) else None


def number(value: float | None, *, digits: int = 1) -> str:
    """A number as text, or a dash for none."""
    return "-" if value is None else f"{value:.{digits}f}"


def spread(summary: dict[str, Any], name: str) -> str:
    """Mean ± standard deviation of a figure in a summary, as text."""
    average, deviation = summary[f"mean_{name}"], summary[f"std_{name}"]
    return "-" if average is None else f"{average:.1f} ± {deviation:.1f}"


def count(number: int, what: str) -> str:
    """`1 step`, `2 steps`."""
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
