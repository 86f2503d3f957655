"""What a model of choice is: a sum of terms, and lapses."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...model import CogmapError, Floats
from ..choices import Choices
from ..terms import Parameter, Term

LAPSES = (1.5, 5.0)  # of the Beta prior over the lapse rate
LAPSE = Parameter(
    name="lapse",
    meaning="ε: share of the choices that are made at random",
    low=1e-4,
    high=0.9999,
    start=0.05,
    spread=0.03,
    typical=(0.01, 0.3),
)


@dataclass(frozen=True, eq=False)
class Prepared:
    """Choices prepared for a model: everything that does not depend on its parameters."""

    choices: Choices
    open: NDArray[np.bool_]
    parts: tuple[Any, ...]


@dataclass(frozen=True)
class ChoiceModel:
    """P(way) = (1 - ε) softmax(sum of the terms) + ε / number of ways."""

    name: str  # of it
    terms: tuple[Term, ...] = ()  # what the log weight of a way is the sum of; without any all ways are alike

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Those of its terms, in order, and the lapse rate; none where there are no terms."""
        found = [parameter for term in self.terms for parameter in term.parameters]
        return (*found, LAPSE) if found else ()

    @property
    def needs_agent(self) -> bool:
        """Whether an agent has to follow the walk before choices can be prepared."""
        return any(term.needs_agent for term in self.terms)

    def values(self, given: Mapping[str, float] | None = None) -> Floats:
        """Its parameters as a vector; those not given are where fits set out.

        Raises:
            CogmapError: an unknown name, or a value out of bounds.
        """
        given = given or {}
        names = [parameter.name for parameter in self.parameters]
        if unknown := [name for name in given if name not in names]:
            known = ", ".join(names) or "none"
            raise CogmapError(f"model {self.name} has no parameter {unknown[0]!r}; it has {known}")
        return np.array([p.check(given.get(p.name, p.start)) for p in self.parameters], dtype=np.float64)

    def prepare(self, choices: Choices) -> Prepared:
        """Choices as it reads them. Raises CogmapError: it needs prospects, and they have none."""
        return Prepared(choices, choices.open, tuple(term.prepare(choices) for term in self.terms))

    def probabilities(self, prepared: Prepared, values: Floats) -> Floats:
        """`[C, K]` P(way)."""
        _, probability, _ = self._weighed(prepared, values)
        lapse = values[-1] if len(values) else 0.0
        return (1.0 - lapse) * probability + lapse * prepared.open / prepared.open.sum(axis=1, keepdims=True)

    def log_likelihood(self, prepared: Prepared, values: Floats) -> tuple[Floats, Floats]:
        """`[C]` log P(the way that was taken), in nats, and `[C, p]` its derivatives by each parameter."""
        rows, taken = np.arange(len(prepared.choices)), prepared.choices.taken
        _, softmax, slopes = self._weighed(prepared, values)
        chosen = softmax[rows, taken]
        if not len(values):
            return np.log(chosen), np.zeros((len(rows), 0))
        lapse, even = values[-1], 1.0 / prepared.open.sum(axis=1)
        p = np.maximum((1.0 - lapse) * chosen + lapse * even, 1e-300)
        by_term = slopes[:, rows, taken].T - np.einsum("pck,ck->cp", slopes, softmax)
        slope = ((1.0 - lapse) * chosen / p)[:, None] * by_term
        return np.log(p), np.concatenate([slope, ((even - chosen) / p)[:, None]], axis=1)

    def log_prior(self, values: Floats) -> tuple[float, Floats]:
        """Nats of the prior over the parameters, and `[p]` its derivatives."""
        if not len(values):
            return 0.0, values
        (a, b), lapse = LAPSES, float(values[-1])
        total = (a - 1.0) * float(np.log(lapse)) + (b - 1.0) * float(np.log1p(-lapse))
        slopes = [np.array([(a - 1.0) / lapse - (b - 1.0) / (1.0 - lapse)])]
        for term, part in zip(self.terms, self._split(values), strict=True):
            nats, slope = term.log_prior(part)
            total += nats
            slopes.insert(-1, slope)
        return total, np.concatenate(slopes)

    def _weighed(self, prepared: Prepared, values: Floats) -> tuple[Floats, Floats, Floats]:
        """Log weights, their softmax over the open ways, and the derivatives of the log weights."""
        total, slopes = np.zeros(prepared.open.shape), list[Floats]()
        for term, part, own in zip(self.terms, prepared.parts, self._split(values), strict=True):
            nats, slope = term.weigh(part, own)
            total = total + nats
            slopes.append(slope)
        total = np.where(prepared.open, total, -np.inf)
        weight = np.exp(total - total.max(axis=1, keepdims=True))
        slope = np.concatenate(slopes) if slopes else np.zeros((0, *total.shape))
        return total, weight / weight.sum(axis=1, keepdims=True), slope

    def _split(self, values: Floats) -> Sequence[Floats]:
        ends = np.cumsum([len(term.parameters) for term in self.terms]).tolist()
        return [values[end - len(term.parameters) : end] for end, term in zip(ends, self.terms, strict=True)]
