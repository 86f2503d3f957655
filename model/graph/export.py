"""Factor graphs for other tools and for people: networkx, Graphviz, an equation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .structure import GraphStructure
from .variables import Variable

if TYPE_CHECKING:
    import networkx as nx

LONGEST = 3000
"""Characters of one text: Graphviz reads no string of more than 16384 bytes, and one of these takes five at most."""


def to_networkx(graph: GraphStructure) -> nx.Graph[Any]:
    """The bipartite graph of variables (by name) and factors (by label).

    Variable nodes carry `bipartite=0, node="variable", domain, time, observed, evidence`; factor nodes
    `bipartite=1, node="factor", name, kind, scope, shape, equation`; an edge carries `axis`, the axis of
    the factor's values that is the variable. All nodes carry `label`; the graph carries the `equation` of it all.
    """
    import networkx as nx

    result: nx.Graph[Any] = nx.Graph(equation=equation(graph))
    for variable in graph.variables:
        result.add_node(
            variable.name,
            bipartite=0,
            node="variable",
            label=_variable_text(graph, variable),
            domain=variable.domain,
            time=variable.time,
            observed=graph.is_observed(variable),
            evidence=graph.evidence.get(variable.name),
        )
    for factor in graph.factors:
        result.add_node(
            factor.label,
            bipartite=1,
            node="factor",
            label=factor.label,
            name=factor.name,
            kind=factor.kind,
            scope=tuple(variable.name for variable in factor.scope),
            shape=factor.shape,
            equation=factor.equation,
        )
        for axis, variable in enumerate(factor.scope):
            result.add_edge(variable.name, factor.label, axis=axis)
    return result


def to_dot(graph: GraphStructure) -> str:
    """Graphviz source: circles are variables (observed ones grey), squares are factors."""
    ids = {variable.name: f"v{i}" for i, variable in enumerate(graph.variables)}
    lines = ["graph factor_graph {", "  node [fontsize=11];"]
    for variable in graph.variables:
        style = "filled" if graph.is_observed(variable) else "solid"
        label = quoted(_variable_text(graph, variable))
        lines.append(f"  {ids[variable.name]} [shape=ellipse, style={style}, fillcolor=lightgrey, label={label}];")
    for i, factor in enumerate(graph.factors):
        lines.append(f"  f{i} [shape=box, height=0.2, label={quoted(factor.name)}, tooltip={quoted(factor.kind)}];")
        lines += [f"  f{i} -- {ids[variable.name]};" for variable in factor.scope]
    return "\n".join([*lines, "}"]) + "\n"


def equation(graph: GraphStructure, *, most_terms: int | None = None) -> str:
    """The graph as the equation it stands for, such as `P(s0, s1 | o1) ∝ prior(s0) · B_s(s1, s0) · A_o(o1, s1)`.

    Args:
        graph: the graph to print.
        most_terms: leave out the middle of longer products and lists of variables.
    """
    latent = [v.name for v in graph.variables if not graph.is_observed(v)]
    observed = [_variable_text(graph, v) for v in graph.variables if graph.is_observed(v)]
    terms = [factor.label for factor in graph.factors]
    given = f" | {_joined(observed, ', ', most_terms)}" if observed else ""
    return f"P({_joined(latent, ', ', most_terms)}{given}) ∝ {_joined(terms, ' · ', most_terms) or '1'}"


def quoted(text: str) -> str:
    """A Graphviz double-quoted string that shows `text` exactly, whatever it holds; the first `LONGEST` of it."""
    text = text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\0", "")
    escaped = escaped.replace("&", "&amp;")  # Graphviz reads the entities of HTML in every label
    return '"' + escaped.replace("\r", "").replace("\n", "\\n") + '"'


def _variable_text(graph: GraphStructure, variable: Variable) -> str:
    """The name, with the label where evidence or a single label fixes it, and with ~ where it has soft evidence."""
    if variable.name in graph.evidence:
        return f"{variable.name}={graph.evidence[variable.name]!r}"
    if variable.observed and variable.cardinality == 1:
        return f"{variable.name}={variable.domain[0]!r}"
    return f"{variable.name}~" if variable.name in graph.likelihoods else variable.name


def _joined(parts: list[str], separator: str, most: int | None) -> str:
    if most is None or len(parts) <= most:
        return separator.join(parts)
    head, tail = parts[: most - 2], parts[-1]
    return separator.join([*head, f"… ({len(parts)} in all)", tail])
