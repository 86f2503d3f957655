"""The record of a plan, and the posterior over policies."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..model import CogmapError, Floats, Ints, html_table
from .choices import Choice
from .energy import ExpectedFreeEnergy
from .local import LocalModel
from .policies import PolicyGenerator

SHOWN = 12  # actions of a plan that its text has


@dataclass(frozen=True, slots=True)
class Plan:
    """The policies that were compared, their values, and the choice."""

    model: LocalModel  # the local model that the plan was made with
    policies: Ints  # `[P, L]` action indices
    expected_free_energy: ExpectedFreeEnergy  # G term by term, each `[P]`, in nats
    probability: Floats  # `[P]` P(policy) (eq. 6)
    chosen: int  # index of the chosen policy
    action: int  # its first action, the one to take now
    cut: int  # prefixes that the bound on the search left out
    generator: PolicyGenerator  # what made the policies
    choice: Choice  # what chose among them

    def __repr__(self) -> str:
        G = float(self.expected_free_energy.G[self.chosen])
        names, more = self.names[:SHOWN], len(self.policy) - SHOWN
        steps = ", ".join(names) + (f", … {more} more" if more > 0 else "")
        odds = f"P {float(self.probability[self.chosen]):.3g} of {len(self.policies)} policies"
        return f"Plan({steps}; G {G:.3f} nats, {odds}, over {len(self.places)} places)"

    def _repr_html_(self) -> str:
        """The most probable policies, the chosen one first."""
        G, most = self.expected_free_energy.G, 8
        best = [k for k in np.argsort(-self.probability, kind="stable")[: most + 1].tolist() if k != self.chosen]
        rows: list[tuple[object, ...]] = []
        for k in (self.chosen, *best[: most - 1]):
            names = [self.model.motions.names[action] for action in self.policies[k, :SHOWN].tolist()]
            rows.append((", ".join(names), f"{float(G[k]):.3f}", f"{float(self.probability[k]):.3g}"))
        return html_table(("policy", "G, nats", "P(policy)"), rows, most=most, caption=f"{len(self.policies)} policies")

    @property
    def policy(self) -> Ints:
        """`[L]` the chosen action sequence."""
        return self.policies[self.chosen]

    @property
    def names(self) -> list[str]:
        """The chosen action sequence by name."""
        return [self.model.motions.names[action] for action in self.policy.tolist()]

    @property
    def places(self) -> Ints:
        """`[R]` the places of the map that the plan could see."""
        return self.model.places

    @property
    def dropped(self) -> float:
        """Belief in places that the plan left out: an agent that may be anywhere plans from the likeliest ones."""
        return self.model.dropped

    @property
    def action_probability(self) -> Floats:
        """`[K]` P(first action), the sum over the policies that begin with it."""
        first = self.policies[:, 0, None] == np.arange(len(self.model.motions))
        return self.probability @ first


def policy_posterior(G: ArrayLike, *, precision: float = 16.0) -> Floats:
    """P(policy) = softmax(-precision G), once (eq. 6).

    Args:
        G: `[P]` expected free energies, nats.
        precision: gamma; 0 makes all policies alike.

    Returns:
        `[P]`, sums to one.

    Raises:
        CogmapError: `G` is empty or not finite, `precision` is negative or not finite.
    """
    cost = np.asarray(G, dtype=np.float64)
    if cost.ndim != 1 or not len(cost) or not np.isfinite(cost).all():
        raise CogmapError("policy_posterior: G must be a non-empty vector of finite numbers; check the tables")
    if not (np.isfinite(precision) and precision >= 0.0):
        raise CogmapError(f"policy_posterior: precision is {precision}; give a finite number, 0 or more")
    weight = np.exp(-precision * (cost - cost.min()))
    return weight / weight.sum()
