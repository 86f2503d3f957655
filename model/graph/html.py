"""A factor graph as HTML, for notebooks."""

from ..labels import shown
from ..markup import html_table, safe
from .export import equation
from .structure import GraphStructure
from .variables import Variable

MOST = 30  # rows a table


def graph_html(graph: GraphStructure) -> str:
    """The equation, and a table of the variables and one of the factors, the first `MOST` of each."""
    variables = [(v.name, _domain(v), "" if v.time is None else v.time, _role(graph, v)) for v in graph.variables]
    factors = [(f.label, f.kind, " x ".join(map(str, f.shape)), f.equation) for f in graph.factors]
    return (
        f"<div><code>{safe(equation(graph, most_terms=12))}</code>"
        + html_table(("variable", "domain", "time", "role"), variables, most=MOST)
        + html_table(("factor", "kind", "shape", "implements"), factors, most=MOST)
        + "</div>"
    )


def _domain(variable: Variable, most: int = 6) -> str:
    labels = ", ".join(shown(label, most=20) for label in variable.domain[:most])
    return labels if variable.cardinality <= most else f"{labels}, … ({variable.cardinality} in all)"


def _role(graph: GraphStructure, variable: Variable) -> str:
    if variable.name in graph.evidence:
        return f"observed: {shown(graph.evidence[variable.name])}"
    if variable.name in graph.likelihoods:
        return "soft evidence"
    return "observed" if variable.observed else "latent"
