"""Expected free energy of policies, term by term."""

from dataclasses import dataclass

import numpy as np

from ..model import CogmapError, Floats
from .terms import Term


@dataclass(frozen=True, slots=True)
class ExpectedFreeEnergy:
    """G(policy), term by term, summed over the steps of each policy; `energy["utility"]` is one term, `[P]`.

    Raises:
        CogmapError: there is not one row of values a term.
    """

    terms: tuple[Term, ...]  # what G is the sum of, with their signs
    values: Floats  # `[T, P]` of each term and policy, in nats, before its sign

    def __post_init__(self) -> None:
        if self.values.ndim != 2 or len(self.values) != len(self.terms):
            shape, many = self.values.shape, len(self.terms)
            raise CogmapError(f"expected free energy: values have shape {shape}; give a row for each of {many} terms")

    @property
    def names(self) -> tuple[str, ...]:
        """Of the terms."""
        return tuple(term.name for term in self.terms)

    @property
    def information(self) -> Floats:
        """`[P]` all information gains together."""
        return self.values[[term.kind == "information" for term in self.terms]].sum(axis=0)

    @property
    def G(self) -> Floats:
        """`[P]` the sum of the terms, each with its sign; the least is best."""
        return np.array([term.sign for term in self.terms]) @ self.values

    def __getitem__(self, name: str) -> Floats:
        """`[P]` the values of one term. Raises CogmapError: no term has this name."""
        if name not in self.names:
            raise CogmapError(f"expected free energy: no term is called {name!r}; there are {', '.join(self.names)}")
        return self.values[self.names.index(name)]

    def __len__(self) -> int:
        return self.values.shape[1]

    def row(self, policy: int) -> dict[str, float]:
        """The terms of one policy by name, and `G`."""
        values = dict(zip(self.names, self.values[:, policy].tolist(), strict=True))
        return {**values, "G": float(self.G[policy])}
