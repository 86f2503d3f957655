"""Evidence as a person gives it (labels) turned into what engines need (indices)."""

from __future__ import annotations

from collections.abc import Hashable, Mapping

from ..model import CogmapError, FactorGraph


def all_evidence(graph: FactorGraph, evidence: Mapping[str, Hashable] | None) -> dict[str, Hashable]:
    """The graph's own evidence and the given one, by variable name.

    Raises:
        CogmapError: the two contradict each other, a name or label is unknown, or an observed variable
            with several labels has no evidence.
    """
    merged = dict(graph.observe_all(evidence).evidence if evidence else graph.evidence)
    for variable in graph.variables:
        if variable.observed and variable.cardinality > 1 and variable.name not in merged:
            raise CogmapError(
                f"evidence: {variable.name!r} is declared observed but has none; pass evidence={{{variable.name!r}: "
                "label}, or declare it without observed=True to sum over it"
            )
    return merged


def fixed_indices(graph: FactorGraph, given: Mapping[str, Hashable]) -> dict[str, int]:
    """Index of every variable that has one possible label: by evidence, or by a domain of one label."""
    fixed = {variable.name: 0 for variable in graph.variables if variable.cardinality == 1}
    for name, label in given.items():
        fixed[name] = graph.variable_named(name).index(label)
    return fixed
