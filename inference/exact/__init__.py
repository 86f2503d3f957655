"""The exact engines: bucket elimination in numpy, gtsam, and enumeration."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from ...model import CogmapError
from . import brute, elimination, gtsam_engine
from .problem import Problem, reduce
from .solution import Solution

__all__ = ["ENGINES", "Problem", "Solution", "maximise", "reduce", "solve"]

ENGINES = ("numpy", "gtsam", "brute")


def solve(problem: Problem, engine: str, order: Sequence[str] | None) -> Solution:
    """Sum-product by the engine of that name; see `infer`."""
    if engine == "brute":
        return brute.solve(problem)
    return (gtsam_engine if _checked(engine) == "gtsam" else elimination).solve(problem, order)


def maximise(problem: Problem, engine: str, order: Sequence[str] | None) -> dict[str, Hashable]:
    """The most probable label of every variable, by the engine of that name; see `most_probable`."""
    if engine == "brute":
        best = brute.most_probable(problem)
        return {variable.name: variable.domain[best[variable.name]] for variable in problem.graph.variables}
    chosen = gtsam_engine if _checked(engine) == "gtsam" else elimination
    return problem.labels(chosen.maximise(problem, order))


def _checked(engine: str) -> str:
    if engine not in ENGINES:
        raise CogmapError(f"inference: no engine {engine!r}; choose one of {', '.join(ENGINES)}")
    return engine
