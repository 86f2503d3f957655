"""The error of evidence that cannot happen."""

from collections.abc import Iterable, Mapping

from ..model import CogmapError, FactorGraph


class ImpossibleEvidence(CogmapError):  # noqa: N818 - reads as what it says
    """No assignment has a product of factors above zero: the evidence contradicts the model."""


def impossible(graph: FactorGraph, given: Mapping[str, object], variables: Iterable[str]) -> ImpossibleEvidence:
    """The error that names the factors which leave no value to `variables`, and the evidence."""
    names = set(variables)
    touching = [f.label for f in graph.factors if f.label in names or names & {v.name for v in f.scope}]
    return ImpossibleEvidence(
        f"the evidence is impossible: every assignment of {_listed(sorted(names))} has probability 0; "
        f"check {_given(given)} and the zeros of {_listed(touching)}, or give the zeros a floor"
    )


def _given(evidence: Mapping[str, object]) -> str:
    pairs = [f"{name}={label!r}" for name, label in evidence.items()]
    return f"the evidence {_listed(pairs)}" if pairs else "the factors (no evidence was given)"


def _listed(items: list[str], most: int = 6) -> str:
    return ", ".join(items[:most]) + (f", … ({len(items)} in all)" if len(items) > most else "")
