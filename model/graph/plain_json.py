"""Factor graphs as plain JSON values and back, and when two of them are the same."""

import json
from collections.abc import Mapping, Sequence
from typing import Any, TypeVar, cast

import numpy as np

from ..errors import CogmapError
from ..labels import decode, encode, identity, plain
from ..reading import parse_json
from .conditional import ConditionalTable
from .factors import Factor, SparseValues, sparse_values
from .structure import GraphStructure
from .variables import Variable

AnyGraph = TypeVar("AnyGraph", bound=GraphStructure)
FORMAT = "cogmap factor graph"
SCHEMA = 1  # version of the layout


def graph_to_dict(graph: GraphStructure) -> dict[str, Any]:
    """The graph as plain JSON values; `graph_from_dict` gives an equal one.

    Of learnable tables, those of type `ConditionalTable` are kept, shared ones once; the mean of others is in the
    values, what they have counted is left out.

    Raises:
        CogmapError: a label is none of None, bool, int, float, str and tuples of these.
    """
    found = (factor.table for factor in graph.factors if isinstance(factor.table, ConditionalTable))
    tables = list({id(table): table for table in found}.values())
    places = {id(table): at for at, table in enumerate(tables)}
    return {
        "format": FORMAT,
        "schema": SCHEMA,
        "variables": [_variable(variable) for variable in graph.variables],
        "factors": [_factor(factor) | {"table": places.get(id(factor.table))} for factor in graph.factors],
        "evidence": {name: _label(label) for name, label in graph.evidence.items()},
        "likelihoods": {name: list(values) for name, values in graph.likelihoods.items()},
        "tables": [{"prior": table.prior.tolist(), "counts": table.counts.tolist()} for table in tables],
    }


def graph_from_dict(values: Mapping[str, Any], empty: AnyGraph) -> AnyGraph:
    """The graph that `graph_to_dict` took apart, as one of the type of `empty`.

    Raises:
        CogmapError: it is no such graph, from a newer version, or damaged.
    """
    if not isinstance(values, Mapping) or values.get("format") != FORMAT:  # pyright: ignore[reportUnnecessaryIsInstance]
        raise CogmapError("graph: the JSON is no factor graph; give what to_json or to_dict wrote")
    if values.get("schema") != SCHEMA:
        raise CogmapError(
            f"graph: the JSON has schema {values.get('schema')!r}, not {SCHEMA}; update cogmap to read it"
        )
    try:
        return _restored(values, empty)
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
        why = " ".join(f"{type(error).__name__}: {error}".split())[:300]
        raise CogmapError(f"graph: the JSON is damaged ({why}); export it again") from error


def graph_to_json(graph: GraphStructure, *, indent: int | None = None) -> str:
    """`graph_to_dict` as text; every number is written so that it is read back exactly."""
    return json.dumps(graph_to_dict(graph), allow_nan=False, indent=indent)


def graph_from_json(text: str, empty: AnyGraph) -> AnyGraph:
    """The graph that `graph_to_json` wrote, as one of the type of `empty`.

    Raises:
        CogmapError: what `graph_from_dict` raises, or the text is no JSON.
    """
    try:
        values = parse_json(text)
    except (AttributeError, TypeError, ValueError) as error:
        raise CogmapError(f"graph: this is no JSON ({error}); give what to_json wrote") from error
    return graph_from_dict(values, empty)


def same_graph(one: GraphStructure, other: GraphStructure) -> bool:
    """Whether variables, factors and evidence are the same, in the same order, to the last digit.

    Labels are the same if their types are as well (1 is not True). Learnable tables are not looked at.
    """
    variables = [list(map(_variable_identity, graph.variables)) for graph in (one, other)]
    evidence = [{name: identity(label) for name, label in graph.evidence.items()} for graph in (one, other)]
    evidence = [(labels, dict(graph.likelihoods)) for labels, graph in zip(evidence, (one, other), strict=True)]
    if variables[0] != variables[1] or evidence[0] != evidence[1] or len(one.factors) != len(other.factors):
        return False
    return all(_same_factor(a, b) for a, b in zip(one.factors, other.factors, strict=True))


def _label(label: Any) -> Any:
    return encode(plain(label), where="graph")


def _variable(variable: Variable) -> dict[str, Any]:
    return {
        "name": variable.name,
        "domain": [_label(label) for label in variable.domain],
        "time": None if variable.time is None else int(variable.time),
        "observed": bool(variable.observed),
    }


def _factor(factor: Factor) -> dict[str, Any]:
    values = factor.values
    numbers: dict[str, Any] = {"values": values.tolist()} if isinstance(values, np.ndarray) else _sparse(values)
    scope = [variable.name for variable in factor.scope]
    return {"name": factor.name, "scope": scope, "kind": factor.kind, "equation": factor.equation, **numbers}


def _sparse(values: SparseValues) -> dict[str, Any]:
    return {"indices": values.indices.tolist(), "sparse": values.values.tolist()}


def _restored(values: Mapping[str, Any], graph: AnyGraph) -> AnyGraph:
    for part in values["variables"]:
        domain = tuple(decode(label) for label in part["domain"])
        if not (type(part["time"]) in (int, type(None)) and isinstance(part["observed"], bool)):
            raise CogmapError(f"time and observed of {part['name']!r} are {part['time']!r}, {part['observed']!r}")
        graph.variable(part["name"], domain, time=part["time"], observed=part["observed"])
    tables = [_table(part) for part in values["tables"]]
    for part in values["factors"]:
        scope = [graph.variable_named(name) for name in part["scope"]]
        if not all(isinstance(part[name], str) for name in ("name", "kind", "equation")):
            raise CogmapError(f"a factor is called {part['name']!r}")
        table = None if part["table"] is None else tables[part["table"]]
        numbers = _numbers(part, [variable.cardinality for variable in scope])
        graph.factor(part["name"], scope, numbers, kind=part["kind"], equation=part["equation"], table=table)
    graph = graph.observe_all({name: decode(label) for name, label in values["evidence"].items()})
    for name, likelihoods in values.get("likelihoods", {}).items():  # files of before have none
        graph = graph.observe(name, dict(zip(graph.variable_named(name).domain, likelihoods, strict=True)))
    return graph


def _numbers(part: Mapping[str, Any], shape: Sequence[int]) -> Any:
    return sparse_values(shape, part["indices"], part["sparse"]) if "sparse" in part else part["values"]


def _table(part: Mapping[str, Any]) -> ConditionalTable:
    table = ConditionalTable(part["prior"])
    table.counts = np.array(part["counts"], dtype=float)
    if table.counts.shape != table.prior.shape or not (table.counts >= table.prior).all():
        raise CogmapError("the counts of a table are below its prior")
    return table


def _variable_identity(variable: Variable) -> tuple[Any, ...]:
    labels = tuple(identity(label) for label in variable.domain)
    return variable.name, labels, variable.time, bool(variable.observed)


def _same_factor(one: Factor, other: Factor) -> bool:
    facts = [(factor.label, factor.kind, factor.equation, factor.shape) for factor in (one, other)]
    if facts[0] != facts[1] or isinstance(one.values, SparseValues) != isinstance(other.values, SparseValues):
        return False
    if isinstance(one.values, SparseValues):
        return _entries(one.values) == _entries(cast(SparseValues, other.values))
    return bool(np.array_equal(one.dense(), other.dense()))


def _entries(values: SparseValues) -> dict[tuple[int, ...], float]:
    return dict(zip(map(tuple, values.indices.tolist()), values.values.tolist(), strict=True))
