"""The one door to inference: ask a factor graph, choose an engine."""

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import islice

import numpy as np

from ..model import AllEvidence, CogmapError, FactorGraph, Variable
from .approximate import APPROXIMATIONS, Loopy, Sampling
from .evidence import Given, given
from .exact import (
    ENGINES,
    MEMORY,
    Order,
    best_first,
    buckets,
    forward,
    marginal_maximum,
    maximise,
    plan_elimination,
    reduce,
    solve,
)
from .posterior import MostProbable, Name, Posterior

Engine = str | Loopy | Sampling


def _taken(graph: FactorGraph) -> FactorGraph:
    """A copy of the graph, which later changes do not reach. Raises CogmapError: it is no graph."""
    if not isinstance(graph, FactorGraph):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise CogmapError(f"inference: {type(graph).__name__} is no factor graph; give one, such as agent.graph")
    return graph.copy()


def infer(
    graph: FactorGraph,
    *,
    evidence: AllEvidence | None = None,
    targets: Iterable[Name] | None = None,
    pairs: Iterable[Sequence[Name]] = (),
    engine: Engine = "numpy",
    order: Order = None,
    memory: float = MEMORY,
) -> Posterior:
    """Posterior of a factor graph: log evidence, marginals, joints.

    Args:
        graph: the graph; evidence given by `graph.observe` counts too.
        evidence: by variable (its name, or itself) a label, or likelihoods of labels.
        targets: the variables asked for; the numpy engine leaves out whatever cannot tell anything about them. All
            by default.
        pairs: sets of variables (two, three, ...) whose joints are wanted at once; others can be asked for later.
        engine: exact are `"numpy"` (bucket elimination), `"gtsam"`, and `"brute"` (enumeration, small graphs).
            Approximations, for what is too large, are `"loopy"` and `"sampling"`, or a `Loopy` or `Sampling` with
            other options; the posterior then says how good it is (`posterior.approximation`).
        order: order of elimination, all latent variables; by default the cheapest of several.
        memory: bytes that products and messages may take.

    Raises:
        ImpossibleEvidence: no assignment has a product above zero.
        CogmapError: unknown engine, variable or label, a bad `order`, or not enough memory.
    """
    graph = _taken(graph)
    wanted = checked_pairs(graph, pairs)
    asked = None if targets is None else checked_targets(graph, targets)
    known = given(graph, evidence)
    method = APPROXIMATIONS.get(engine, engine) if isinstance(engine, str) else engine
    if isinstance(method, str):
        name, report = _exact(method, also=(*APPROXIMATIONS, "Loopy(…)", "Sampling(…)")), None
        solution = solve(graph, known, name, order=order, memory=memory, asked=asked)
    else:
        solution = method.solve(reduce(graph, known))
        name, report = method.name, solution.report
    posterior = Posterior(graph, name, report, known, solution, {})
    return replace(posterior, _joints={names: posterior.joint(*names) for names in wanted})


def most_probable(
    graph: FactorGraph,
    *,
    evidence: AllEvidence | None = None,
    engine: str = "numpy",
    order: Order = None,
    memory: float = MEMORY,
) -> MostProbable:
    """The most probable assignment, by max-product; ties are broken by the engine.

    Arguments and errors as for `infer`; `engine` is an exact one.
    """
    graph = _taken(graph)
    known = given(graph, evidence)
    labels = maximise(graph, known, _exact(engine), order=order, memory=memory)
    return MostProbable(graph, log_product(graph, labels, known), labels)


def k_most_probable(
    graph: FactorGraph, count: int, *, evidence: AllEvidence | None = None, memory: float = MEMORY
) -> list[MostProbable]:
    """The `count` most probable assignments, best first; fewer if fewer have a positive product.

    Raises:
        CogmapError: `count` is below 1, and what `infer` raises.
    """
    if count < 1:
        raise CogmapError(f"k_most_probable: cannot give {count} assignments; ask for 1 or more")
    graph = _taken(graph)
    known = given(graph, evidence)
    problem = reduce(graph, known)
    done = forward(buckets(problem, plan_elimination(problem, memory=memory)), problem.tables, maximum=True)
    found = (problem.labels(nodes) for nodes, _ in islice(best_first(done), count))
    return [MostProbable(graph, log_product(graph, labels, known), labels) for labels in found]


def marginal_map(
    graph: FactorGraph,
    variables: Iterable[Name],
    *,
    evidence: AllEvidence | None = None,
    memory: float = MEMORY,
) -> MostProbable:
    """The most probable assignment of some variables, with all others summed out. The cost can be high.

    Raises:
        CogmapError: no variable is named, and what `infer` raises.
    """
    graph = _taken(graph)
    names = checked_targets(graph, variables)
    known = given(graph, evidence)
    problem = reduce(graph, known, plain=True)
    indices, log_probability = marginal_maximum(problem, problem.nodes(names), memory)
    labels = problem.labels(indices)
    return MostProbable(graph, log_probability, {name: labels[name] for name in names})


def log_product(
    graph: FactorGraph, labels: Mapping[str, Hashable] | Mapping[Variable, Hashable], known: Given | None = None
) -> float:
    """log Π_f f(x_f) at a full assignment of labels, soft evidence included; -inf where a factor is zero.

    Raises:
        CogmapError: a variable has no label, or one that its domain has not.
    """
    known = known or Given({}, {}, {}, {number: np.array(values) for number, values in _soft(graph)})
    labels = {graph.variable_named(name).name: label for name, label in labels.items()}
    if missing := [variable.name for variable in graph.variables if variable.name not in labels]:
        raise CogmapError(f"log_product: there is no label for {missing[0]!r}; give one for every variable")
    indices = [np.array([variable.index(labels[variable.name])]) for variable in graph.variables]
    wiring = graph.wiring
    values = [
        factor.at([indices[i] for i in scope]) for factor, scope in zip(wiring.factors, wiring.scopes, strict=True)
    ]
    values += [likelihoods[indices[i]] for i, likelihoods in known.soft.items()]
    return math.fsum(math.log(value[0]) if value[0] > 0 else -math.inf for value in values)


def _soft(graph: FactorGraph) -> Iterable[tuple[int, tuple[float, ...]]]:
    return ((graph.wiring.number[name], values) for name, values in graph.likelihoods.items())


def checked_pairs(graph: FactorGraph, pairs: Iterable[Sequence[Name]]) -> list[tuple[str, ...]]:
    """Names of sets of variables."""
    wanted: list[tuple[str, ...]] = []
    for names in pairs:
        if isinstance(names, str | Variable) or not names:
            raise CogmapError(f"inference: pairs holds {names!r}; give tuples of variable names")
        wanted.append(tuple([graph.variable_named(name).name for name in names]))
    return wanted


def checked_targets(graph: FactorGraph, targets: Iterable[Name]) -> list[str]:
    """Names of the variables asked for."""
    if isinstance(targets, str | Variable):
        raise CogmapError(f"inference: the targets are {targets!r}; give a list of variables")
    names = [graph.variable_named(name).name for name in targets]
    if not names:
        raise CogmapError("inference: no target is named; name one variable at least")
    return names


def _exact(engine: str, *, also: Sequence[str] = ()) -> str:
    if engine not in ENGINES:
        raise CogmapError(f"inference: no engine {engine!r}; choose one of {', '.join([*ENGINES, *also])}")
    return engine
