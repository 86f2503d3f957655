"""Variational free energy, split in three ways (eq. 3 of the paper).

The factors fall in two: likelihoods L (kinds sight, walls, likelihood, and factors that touch an observed variable)
and the prior R (the rest), with Z_R = Σ_x Π_R f(x). A product of experts such as place times motion has Z_R < 1; a
directed prior has Z_R = 1. F counts the factors as they are, so log Z_R stands beside the complexity.
"""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..model import AllEvidence, CogmapError, Factor, FactorGraph, FloatArray
from .evidence import given
from .posterior import Name, Posterior, expected_log
from .query import infer

LIKELIHOOD_KINDS = frozenset({"sight", "walls", "likelihood"})
PRIOR_KINDS = frozenset({"prior", "transition", "motion", "displacement", "place"})


@dataclass(frozen=True, slots=True)
class FreeEnergy:
    """F[Q] and its parts, all in nats. With Q(x) over the latent variables and evidence o:

    F = energy - entropy = divergence - log_evidence = complexity - accuracy - log_prior_normaliser.
    """

    free_energy: float  # F = E_Q[log Q(x) - log Π_f f(x, o)], never below -log Z
    energy: float  # -E_Q[log Π_f f(x, o)]
    entropy: float  # H[Q] = -E_Q[log Q(x)]
    divergence: float  # KL[Q || P(x | o)], the posterior approximation; 0 for the exact posterior
    log_evidence: float  # log Z = log Σ_x Π_f f(x, o)
    complexity: float  # KL[Q || Π_R f / Z_R], from the normalised prior
    accuracy: float  # E_Q[log Π_L f(x, o)]
    log_prior_normaliser: float  # log Z_R; 0 for a directed prior


def is_likelihood(graph: FactorGraph, factor: Factor) -> bool:
    """Whether a factor is a likelihood: by its kind if it has one, otherwise if it touches an observed variable."""
    if factor.kind in LIKELIHOOD_KINDS:
        return True
    return factor.kind not in PRIOR_KINDS and any(graph.is_observed(variable) for variable in factor.scope)


def free_energy(
    posterior: Posterior,
    *,
    likelihood: Callable[[Factor], bool] | None = None,
    engine: str = "numpy",
) -> FreeEnergy:
    """F at the exact posterior: F = -log Z and the divergence is 0, up to rounding.

    Args:
        posterior: from `infer`.
        likelihood: which factors are likelihoods; by default `is_likelihood`.
        engine: computes Z_R.
    """
    graph = _with_likelihoods(posterior.graph.without_evidence(), posterior.evidence, posterior.likelihoods)
    expected = {factor.label: posterior.expected_log(factor) for factor in graph.factors}
    return _parts(graph, expected, posterior.entropy, posterior.log_evidence, likelihood, engine)


def free_energy_of(
    graph: FactorGraph,
    q: Mapping[Name, ArrayLike],
    *,
    evidence: AllEvidence | None = None,
    likelihood: Callable[[Factor], bool] | None = None,
    engine: str = "numpy",
) -> FreeEnergy:
    """F of a factorised Q(x) = Π_i q_i(x_i); infinite where Q gives weight to what a factor forbids.

    Args:
        graph: the graph.
        q: probabilities `[cardinality]` for each latent variable, by name.
        evidence: labels of the observed variables.
        likelihood: which factors are likelihoods; by default `is_likelihood`.
        engine: computes log Z and Z_R.

    Raises:
        CogmapError: a latent variable is missing from `q`, or its probabilities are none.
    """
    known = given(graph, evidence)
    graph = _with_likelihoods(graph.without_evidence(), known.labels, known.likelihoods)
    beliefs = _checked(graph, q)
    expected = {factor.label: _factorised_log(factor, beliefs) for factor in graph.factors}
    entropy = -sum(expected_log(belief, belief) for belief in beliefs.values())
    return _parts(graph, expected, entropy, infer(graph, engine=engine).log_evidence, likelihood, engine)


def _parts(
    graph: FactorGraph,
    expected: Mapping[str, float],
    entropy: float,
    log_evidence: float,
    likelihood: Callable[[Factor], bool] | None,
    engine: str,
) -> FreeEnergy:
    prior = FactorGraph()
    for variable in graph.variables:
        prior.add_variable(variable)
    accuracy = log_prior = 0.0
    for factor in graph.factors:
        if likelihood(factor) if likelihood else is_likelihood(graph, factor):
            accuracy += expected[factor.label]
        else:
            log_prior += expected[factor.label]
            prior.add_factor(factor)
    log_normaliser = infer(prior, evidence=graph.evidence, engine=engine).log_evidence
    energy = -(accuracy + log_prior)
    return FreeEnergy(
        free_energy=energy - entropy,
        energy=energy,
        entropy=entropy,
        divergence=energy - entropy + log_evidence,
        log_evidence=log_evidence,
        complexity=-entropy - log_prior + log_normaliser,
        accuracy=accuracy,
        log_prior_normaliser=log_normaliser,
    )


def _with_likelihoods(
    graph: FactorGraph, labels: Mapping[str, Hashable], likelihoods: Mapping[str, tuple[float, ...]]
) -> FactorGraph:
    """The graph with these labels as evidence, and soft evidence as factors: likelihoods, like those of sights."""
    graph = graph.observe_all(labels)
    for name, values in likelihoods.items():
        graph.factor("evidence", [name], values, kind="likelihood")
    return graph


def _checked(graph: FactorGraph, q: Mapping[Name, ArrayLike]) -> dict[str, FloatArray]:
    """q for every variable: as given for the latent ones, one-hot for those that are known."""
    fixed = given(graph).fixed
    q = {graph.variable_named(name).name: belief for name, belief in q.items()}
    beliefs: dict[str, FloatArray] = {}
    for number, variable in enumerate(graph.variables):
        if number in fixed:
            beliefs[variable.name] = np.eye(variable.cardinality)[fixed[number]]
            continue
        if variable.name not in q:
            raise CogmapError(f"free energy: q has nothing for {variable.name!r}; give its probabilities")
        belief = np.asarray(q[variable.name], dtype=float)
        if belief.shape != (variable.cardinality,) or not (belief >= 0).all() or abs(belief.sum() - 1) > 1e-9:
            raise CogmapError(
                f"free energy: q of {variable.name!r} must be {variable.cardinality} probabilities that sum to 1"
            )
        beliefs[variable.name] = belief
    return beliefs


def _factorised_log(factor: Factor, beliefs: Mapping[str, FloatArray]) -> float:
    weights = np.ones(())
    for variable in factor.scope:
        weights = np.multiply.outer(weights, beliefs[variable.name])
    values = factor.dense()
    return expected_log(weights, values)
