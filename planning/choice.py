"""Which policy to follow: the posterior over policies, the choice, and the record of both."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..model.errors import CogmapError
from .energy import ExpectedFreeEnergy
from .policies import DEFAULT_BEAM, GENERATORS, Policies, map_guided
from .reach import Reach
from .rollout import evaluate

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
CHOICES = ("outward", "best", "sampled")
TIE = 1e-3  # nats; policies closer than this are equally good: at a precision of 16 their odds are 1.016 to 1
SLACK = 0.25  # nats that an agent which only explores gives up, at most, to go further out first


@dataclass(frozen=True, slots=True)
class Plan:
    """What was considered, what each policy was worth, and what was chosen.

    Attributes:
        reach: the tables that the plan was made with.
        policies: `[P, L]` action indices.
        expected_free_energy: G term by term, each `[P]`, in nats.
        probability: `[P]` P(policy) (eq. 6).
        chosen: index of the chosen policy.
        action: its first action, the one to take now.
        cut: prefixes that the bound on the search left out.
    """

    reach: Reach
    policies: Ints
    expected_free_energy: ExpectedFreeEnergy
    probability: Floats
    chosen: int
    action: int
    cut: int

    @property
    def policy(self) -> Ints:
        """`[L]` the chosen action sequence."""
        return self.policies[self.chosen]

    @property
    def names(self) -> list[str]:
        """The chosen action sequence by name."""
        return [self.reach.motions.names[action] for action in self.policy.tolist()]

    @property
    def places(self) -> Ints:
        """`[R]` the places of the map that the plan could see."""
        return self.reach.places

    @property
    def dropped(self) -> float:
        """Belief in places that the plan left out: an agent that may be anywhere plans from the likeliest ones."""
        return self.reach.dropped

    @property
    def action_probability(self) -> Floats:
        """`[K]` P(first action), the sum over the policies that begin with it."""
        first = self.policies[:, 0, None] == np.arange(len(self.reach.motions))
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


def choose(
    reach: Reach,
    policies: Policies,
    terms: ExpectedFreeEnergy,
    *,
    precision: float = 16.0,
    how: str = "outward",
    rng: np.random.Generator,
) -> Plan:
    """The plan, chosen in one of these ways.

    - "best" takes a policy of the least G. Among policies as good as the best (within `TIE`) the draw is even: an agent
      that knows its world walks about. Where something is preferred those that move least come first: an agent at its
      goal stays there.
    - "outward" does so too where something is preferred, or nothing is new within reach. While it only explores, it
      takes, of the policies within `SLACK` of the least G, those whose first place never entered lies furthest out
      (`Reach.frontier`), and the best of them: exploring leaves fewer pockets behind.
    - "sampled" draws from P(policy).

    Raises:
        CogmapError: unknown `how`, terms of other policies, or what `policy_posterior` raises.
    """
    if how not in CHOICES:
        raise CogmapError(f"choose: no way to choose is called {how!r}; take one of {', '.join(CHOICES)}")
    if len(terms) != len(policies):
        raise CogmapError(f"choose: {len(terms)} values of G for {len(policies)} policies; evaluate these")
    G = terms.G
    probability = policy_posterior(G, precision=precision)
    if how == "sampled":
        chosen = int(rng.choice(len(G), p=probability))
    else:
        best = contenders(reach, policies.actions, G, how=how)
        chosen = int(best[rng.integers(len(best))])
    action = int(policies.actions[chosen, 0])
    return Plan(reach, policies.actions, terms, probability, chosen, action, policies.cut)


def contenders(reach: Reach, actions: Ints, G: Floats, *, how: str) -> Ints:
    """Indices of the policies among which the lot is drawn, for every way to choose but "sampled"; see `choose`."""
    good = np.arange(len(G))
    if not reach.indifferent:
        good = _near(G, good, TIE)
        moves = (actions[good] != reach.motions.stay).sum(axis=1)
        good = good[moves == moves.min()]
    elif how == "outward" and reach.frontier.max(initial=-1.0) >= 0.0:
        good = _near(G, good, SLACK)
        outward = _outward(reach, actions[good])
        good = good[outward == outward.max()]
    return _near(G, good, TIE)


def _near(G: Floats, policies: Ints, nats: float) -> Ints:
    """Those of the policies that are so near to the best of them."""
    return policies[G[policies] <= G[policies].min() + nats]


def _outward(reach: Reach, actions: Ints) -> Floats:
    """`[P]` frontier of the first place never entered on the most probable way of each policy; -1 if there is none."""
    place = np.full(len(actions), reach.belief.argmax())
    outward = np.full(len(actions), -1.0)
    for action in actions.T:
        after = reach.successor[place, action]
        place = np.where(after >= 0, after, place)
        outward = np.where(outward >= 0.0, outward, reach.frontier[place])
    return outward


def plan(
    reach: Reach,
    *,
    generator: str | Callable[[Reach], Policies] = "map_guided",
    precision: float = 16.0,
    choice: str = "outward",
    rng: np.random.Generator,
    beam: int = DEFAULT_BEAM,
) -> Plan:
    """Check the tables, generate policies, evaluate them, choose one.

    Args:
        reach: the tables within reach.
        generator: a name in `GENERATORS`, or any function from Reach to Policies.
        precision: gamma of eq. 6.
        choice: "outward", "best" or "sampled", see `choose`.
        rng: breaks ties, and draws when sampling.
        beam: bound on the search of "map_guided".

    Raises:
        CogmapError: a table that does not fit (see `Reach.check`), an unknown name, or a bad option.
    """
    reach.check()
    return consider(reach, generator=generator, precision=precision, choice=choice, rng=rng, beam=beam)


def consider(
    reach: Reach,
    *,
    generator: str | Callable[[Reach], Policies],
    precision: float,
    choice: str,
    rng: np.random.Generator,
    beam: int,
) -> Plan:
    """`plan` for tables that are known to fit, as those of `cut_reach` are."""
    policies = _generator(generator, beam)(reach)
    return choose(reach, policies, evaluate(reach, policies), precision=precision, how=choice, rng=rng)


def _generator(generator: str | Callable[[Reach], Policies], beam: int) -> Callable[[Reach], Policies]:
    if not isinstance(generator, str):
        return generator
    if generator == "map_guided":
        return partial(map_guided, beam=beam)
    if generator not in GENERATORS:
        raise CogmapError(f"plan: no policy generator is called {generator!r}; take one of {', '.join(GENERATORS)}")
    return GENERATORS[generator]
