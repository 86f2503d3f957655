"""Why the agent did what it did: its last choice in words and numbers."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from ..agent import Agent
from ..model.errors import CogmapError
from ..model.labels import encode, plain
from ..planning import TIE, Plan, Policies, Term, evaluate
from .explain_text import explanation_html, explanation_text


@dataclass(frozen=True, slots=True)
class BelievedPlace:
    """A place that holds belief.

    Attributes:
        place: its number.
        position: relative to the start, or None.
        sight: label of its most probable sight; None where it was never visited.
        probability: Q(s).
    """

    place: int
    position: tuple[int, ...] | None
    sight: Hashable
    probability: float


@dataclass(frozen=True, slots=True)
class WeighedPolicy:
    """One of the policies of a plan.

    Attributes:
        index: its row in `plan.policies`.
        actions: by name.
        terms: of its expected free energy, and their sum under `G`, in nats: `plan.expected_free_energy.row(index)`.
        probability: P(policy).
        place: the place where it most probably ends; None for somewhere never imagined.
        place_probability: how probable that is.
        contributions: the terms with the sign they have in G: they add up to it.
    """

    index: int
    actions: tuple[str, ...]
    terms: dict[str, float]
    probability: float
    place: int | None
    place_probability: float
    contributions: dict[str, float]


@dataclass(frozen=True, slots=True)
class Rejected:
    """A good policy that was not chosen, and what spoke against it.

    Attributes:
        policy: the policy.
        worse: for each term, how much it adds to G beyond what it adds for the chosen policy, in nats.
        term: the term in which it lost most; None where it is as good as the chosen one, or better.
        verdict: `lot` (as good; the lot fell on another), `moves` (as good, but it moves more), `outward` (nearly as
            good or better, but it does not lead as far out), `drawn` (as good or better; policies are drawn from
            P(policy)), `later` (it lost most in a term that it gets as much of, only later: a longer way), or `less`
            (it lost most in that term).
        words: the verdict for people; empty where a term tells.
    """

    policy: WeighedPolicy
    worse: dict[str, float]
    term: str | None
    verdict: str
    words: str

    @property
    def difference(self) -> float:
        """G beyond that of the chosen policy, in nats."""
        return sum(self.worse.values())


@dataclass(frozen=True, slots=True)
class FirstAction:
    """What the plan made of one action as the first.

    Attributes:
        action: its name.
        blocked: P(blocked) in the places that hold belief, as sensed.
        policies: how many of the policies begin with it.
        probability: the sum of their P(policy).
        best: the least of their G, in nats; None where there are none.
    """

    action: str
    blocked: float
    policies: int
    probability: float
    best: float | None


@dataclass(frozen=True, slots=True)
class Explanation:
    """The last choice of an agent; `str` and `text` tell it in words.

    Attributes:
        step: the time step of the choice.
        terms: of G.
        belief: the most probable places.
        certainty: Q of the first of them.
        doubt: probability that the belief went astray at an earlier step.
        considered: number of policies.
        length: their number of steps.
        cut: prefixes that the bound on the search left out.
        generator: the policy generator.
        choice: `outward`, `best` or `sampled`.
        how: what that means.
        precision: γ of P(policy).
        chosen: the policy chosen.
        equals: policies that were as good, this one included: among them the lot was drawn (with `sampled`, none was).
        best: the policies of the least G, in its order.
        rejected: those of them that were not chosen, and the best of those that were not as good.
        actions: what was made of each action as the first.
        sights: preferred sights, log preferences in nats, before `goal_weight`.
        places: preferred places, likewise.
        goal_weight: weight of the preferences.
        collision_cost: what a collision costs, in nats.
    """

    step: int
    terms: tuple[Term, ...]
    belief: tuple[BelievedPlace, ...]
    certainty: float
    doubt: float
    considered: int
    length: int
    cut: int
    generator: str
    choice: str
    how: str
    precision: float
    chosen: WeighedPolicy
    equals: int
    best: tuple[WeighedPolicy, ...]
    rejected: tuple[Rejected, ...]
    actions: tuple[FirstAction, ...]
    sights: tuple[tuple[Hashable, float], ...]
    places: tuple[tuple[int, float], ...]
    goal_weight: float
    collision_cost: float

    @property
    def text(self) -> str:
        """The explanation as plain text."""
        return explanation_text(self)

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return explanation_html(self)

    def to_dict(self) -> dict[str, Any]:
        """The explanation as plain JSON values.

        Raises:
            CogmapError: a label cannot be written as JSON.
        """
        values = asdict(replace(self, terms=()))
        values["terms"] = [
            {name: getattr(term, name) for name in ("name", "label", "sign", "kind")} for term in self.terms
        ]
        values["sights"] = [[_json(label), value] for label, value in self.sights]
        values["belief"] = [{**asdict(place), "sight": _json(place.sight)} for place in self.belief]
        return values


def explain(agent: Agent, *, most: int = 5) -> Explanation:
    """The last choice of an agent: what it believed, what it weighed, and what ruled the others out.

    Args:
        agent: after a step; one that was loaded works its last plan out again.
        most: how many places, how many of the best policies, and how many of those less good are told.

    Raises:
        CogmapError: the agent has planned nothing yet, or `most` is below 1.
    """
    if most < 1:
        raise CogmapError(f"explain: most is {most}; give 1 or more policies to tell of")
    plan, belief, settings, wishes = agent.plan, agent.belief, agent.settings, agent.preferences
    G = plan.expected_free_energy.G
    ranked = [int(policy) for policy in np.argsort(G, kind="stable")[:most]]
    equals = set(plan.choice.contenders(plan.model, plan.policies, G).tolist())
    lesser = [int(policy) for policy in np.argsort(G, kind="stable") if int(policy) not in equals][:most]
    told = [policy for policy in dict.fromkeys([*ranked, *lesser]) if policy != plan.chosen]
    return Explanation(
        step=agent.steps - 1,
        terms=plan.expected_free_energy.terms,
        belief=tuple(_believed(agent, place, q) for place, q in list(belief.places.items())[:most]),
        certainty=belief.certainty,
        doubt=belief.doubt,
        considered=len(plan.policies),
        length=plan.policies.shape[1],
        cut=plan.cut,
        generator=plan.generator.name,
        choice=plan.choice.name,
        how=plan.choice.how,
        precision=settings.precision,
        chosen=_weighed(plan, plan.chosen),
        equals=len(equals) if plan.choice.by_lot else 1,
        best=tuple(_weighed(plan, policy) for policy in ranked),
        rejected=_rejected(plan, told),
        actions=tuple(_first(plan, action) for action in range(len(plan.model.motions))),
        sights=tuple(wishes.sights.items()),
        places=tuple(wishes.places.items()),
        goal_weight=settings.goal_weight,
        collision_cost=settings.collision_cost,
    )


def _believed(agent: Agent, place: int, probability: float) -> BelievedPlace:
    map_ = agent.map
    keys, p, _ = map_.A_o.mean(np.array([place]))
    best = int(keys[0, p[0].argmax()])
    sight = map_.sights[best] if map_.visited[place] and best >= 0 else None
    return BelievedPlace(place, map_.position(place), sight, probability)


def _weighed(plan: Plan, policy: int) -> WeighedPolicy:
    model, actions = plan.model, plan.policies[policy].tolist()
    q, row = model.belief, plan.expected_free_energy.row(policy)
    for action in actions:
        q = model.B.predicted(q[None], np.zeros(1, dtype=np.int64), np.array([action]))[0]
    place = int(model.places[q.argmax()])
    return WeighedPolicy(
        index=policy,
        actions=tuple(model.motions.names[action] for action in actions),
        terms=row,
        probability=float(plan.probability[policy]),
        place=None if place < 0 else place,
        place_probability=float(q.max()),
        contributions={term.name: term.sign * row[term.name] for term in plan.expected_free_energy.terms},
    )


def _rejected(plan: Plan, policies: list[int]) -> tuple[Rejected, ...]:
    if not policies:
        return ()
    energy = plan.expected_free_energy
    chosen, G = energy.row(plan.chosen), energy.G
    sooner = Policies(plan.policies[[plan.chosen, *policies]])
    undiscounted = evaluate(replace(plan.model, discount=1.0), sooner, energy.terms)
    found: list[Rejected] = []
    for at, policy in enumerate(policies, start=1):
        row = energy.row(policy)
        worse = {term.name: term.sign * (row[term.name] - chosen[term.name]) for term in energy.terms}
        verdict = plan.choice.passed_over(plan.model, plan.policies, G, plan.chosen, policy)
        if verdict is not None:
            found.append(Rejected(_weighed(plan, policy), worse, None, verdict.name, verdict.words))
            continue
        lost = max(energy.terms, key=lambda term: worse[term.name])
        later = lost.sign * float(np.diff(undiscounted[lost.name][[0, at]])[0]) <= TIE < worse[lost.name]
        found.append(Rejected(_weighed(plan, policy), worse, lost.name, "later" if later else "less", ""))
    return tuple(found)


def _first(plan: Plan, action: int) -> FirstAction:
    begins = plan.policies[:, 0] == action
    G = plan.expected_free_energy.G[begins]
    return FirstAction(
        action=plan.model.motions.names[action],
        blocked=float(plan.model.belief @ plan.model.blocked[:, action]),
        policies=int(begins.sum()),
        probability=float(plan.probability[begins].sum()),
        best=float(G.min()) if len(G) else None,
    )


def _json(label: Hashable) -> Any:
    return encode(plain(label), where="explain")
