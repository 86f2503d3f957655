"""Evidence as a person gives it (labels, likelihoods) turned into what engines need (numbers)."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass

import numpy as np

from ..model import AllEvidence, CogmapError, FactorGraph, FloatArray


@dataclass(frozen=True, slots=True)
class Given:
    """What is known of the variables of a graph."""

    labels: Mapping[str, Hashable]  # the labels observed, by name
    likelihoods: Mapping[str, tuple[float, ...]]  # the likelihoods observed, by name, one a label of the domain
    # index of the one label left, by number of the variable; variables of one label are among them
    fixed: Mapping[int, int]
    soft: Mapping[int, FloatArray]  # `[cardinality]` likelihoods, by number of the variable


def given(graph: FactorGraph, evidence: AllEvidence | None = None) -> Given:
    """The graph's own evidence and the evidence given with a query.

    Raises:
        CogmapError: the two contradict each other, a name or label is unknown, or an observed variable
            with several labels has no evidence.
    """
    graph = graph.observe_all(evidence) if evidence else graph
    wiring, labels, likelihoods = graph.wiring, dict(graph.evidence), dict(graph.likelihoods)
    fixed = dict.fromkeys(wiring.single, 0)
    for name, label in labels.items():
        number = wiring.number[name]
        fixed[number] = wiring.variables[number].index(label)
    for number in wiring.observed:
        name = wiring.variables[number].name
        if number not in fixed and name not in likelihoods:
            raise CogmapError(
                f"evidence: {name!r} is declared observed but has none; pass evidence={{{name!r}: "
                "label}, or declare it without observed=True to sum over it"
            )
    soft = {wiring.number[name]: np.array(values) for name, values in likelihoods.items()}
    return Given(labels, likelihoods, fixed, soft)
