"""Sums of what is held as logarithms."""

from collections.abc import Sequence
from math import exp, log


def log_sum(logs: Sequence[float]) -> float:
    """log Σ exp."""
    most = max(logs)
    return most + log(sum(exp(value - most) for value in logs))


def log_add(a: float, b: float) -> float:
    """log(exp(a) + exp(b))."""
    a, b = max(a, b), min(a, b)
    return a + log(1.0 + exp(b - a))
