"""The one door to inference: ask a factor graph, choose an engine."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence

from ..model import CogmapError, FactorGraph
from .evidence import all_evidence
from .exact import maximise, reduce, solve
from .posterior import MostProbable, Posterior


def infer(
    graph: FactorGraph,
    *,
    evidence: Mapping[str, Hashable] | None = None,
    pairs: Iterable[Sequence[str]] = (),
    engine: str = "numpy",
    order: Sequence[str] | None = None,
) -> Posterior:
    """Exact posterior of a factor graph: log evidence, all marginals, the joints asked for.

    Args:
        graph: the graph; evidence given by `graph.observe` counts too.
        evidence: a label for each observed variable, by name.
        pairs: sets of names (two, three, ...) whose joints are wanted at once; others can be asked for later.
        engine: `"numpy"` (bucket elimination), `"gtsam"`, or `"brute"` (enumeration, small graphs).
        order: order of elimination, all latent variables by name; by default along time, else minimum fill.

    Raises:
        ImpossibleEvidence: no assignment has a product above zero.
        CogmapError: unknown engine, variable or label, a bad `order`, or a cluster too large for the engine.
    """
    graph = graph.copy()
    wanted = _checked_pairs(graph, pairs)
    problem = reduce(graph, all_evidence(graph, evidence))
    solution = solve(problem, engine, order)
    joints = {names: solution.joint(names) for names in wanted}
    return Posterior(graph, problem.given, engine, solution.log_evidence, solution, joints)


def most_probable(
    graph: FactorGraph,
    *,
    evidence: Mapping[str, Hashable] | None = None,
    engine: str = "numpy",
    order: Sequence[str] | None = None,
) -> MostProbable:
    """The most probable assignment, by max-product; ties are broken by the engine.

    Arguments and errors as for `infer`.
    """
    graph = graph.copy()
    problem = reduce(graph, all_evidence(graph, evidence))
    labels = maximise(problem, engine, order)
    return MostProbable(graph, labels, log_product(graph, labels))


def log_product(graph: FactorGraph, labels: Mapping[str, Hashable]) -> float:
    """log Π_f f(x_f) at a full assignment of labels; -inf where a factor is zero."""
    indices = {variable.name: variable.index(labels[variable.name]) for variable in graph.variables}
    total = 0.0
    for factor in graph.factors:
        value = float(factor.dense()[tuple(indices[v.name] for v in factor.scope)])
        total += math.log(value) if value > 0 else -math.inf
    return total


def _checked_pairs(graph: FactorGraph, pairs: Iterable[Sequence[str]]) -> list[tuple[str, ...]]:
    wanted: list[tuple[str, ...]] = []
    for names in pairs:
        if isinstance(names, str) or not names:
            raise CogmapError(f"inference: pairs holds {names!r}; give tuples of variable names")
        for name in names:
            graph.variable_named(name)
        wanted.append(tuple(names))
    return wanted
