"""The explanation of the last choice of an agent."""

from collections.abc import Hashable
from dataclasses import replace

import numpy as np

from ..agent import Agent
from ..model import CogmapError
from ..planning import TIE, Plan, Policies, Term, evaluate
from .explanation import BelievedPlace, Explanation, FirstAction, Rejected, WeighedPolicy
from .speaking import spoken


def explain(agent: Agent, *, most: int = 5) -> Explanation:
    """Explain the last choice of an agent: its belief, its policies, and why the others were not taken.

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
    order = np.argsort(G, kind="stable").tolist()
    equals = set(plan.choice.contenders(plan.model, plan.policies, G).tolist())
    lesser = [policy for policy in order if policy not in equals][:most]
    others = [policy for policy in dict.fromkeys([*order[:most], *lesser]) if policy != plan.chosen]
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
        best=tuple(_weighed(plan, policy) for policy in order[:most]),
        rejected=_rejected(plan, others) if others else (),
        actions=tuple(_first(plan, action) for action in range(len(plan.model.motions))),
        sights=tuple(wishes.sights.items()),
        places=tuple(wishes.places.items()),
        goal_weight=settings.goal_weight,
        collision_cost=settings.collision_cost,
        spoken=spoken(agent),
        sensors=tuple((name, *wish) for name, labels in wishes.sensors.items() for wish in labels.items()),
    )


def _believed(agent: Agent, place: int, probability: float) -> BelievedPlace:
    map_, senses = agent.map, dict[str, Hashable]()
    for sensor in map_.sights_sensed if map_.visited[place] else ():
        keys, p, _ = sensor.table.mean(np.array([place]))
        if (best := int(keys[0, p[0].argmax()])) >= 0:
            senses[sensor.name] = sensor.labels[best]
    return BelievedPlace(place, map_.position(place), senses, probability)


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
    energy, chosen = plan.expected_free_energy, plan.chosen
    undiscounted = replace(plan.model, discount=1.0)
    in_full = evaluate(undiscounted, Policies(plan.policies[[chosen, *policies]]), energy.terms)
    found: list[Rejected] = []
    for at, policy in enumerate(policies, start=1):
        gains = {term.name: energy[term.name][policy] - energy[term.name][chosen] for term in energy.terms}
        worse = {term.name: float(term.sign * gains[term.name]) for term in energy.terms}
        lost = max(energy.terms, key=lambda term: worse[term.name])
        later = lost.sign * float(np.diff(in_full[lost.name][[0, at]])[0]) <= TIE < worse[lost.name]
        weighed = _weighed(plan, policy)
        verdict = plan.choice.passed_over(plan.model, plan.policies, energy.G, chosen, policy)
        if verdict is not None:
            found.append(Rejected(weighed, worse, None, verdict.name, verdict.words))
        else:
            words = f"{sum(worse.values()):.3f} nats worse, most of all {_loss(lost, worse[lost.name], later=later)}"
            found.append(Rejected(weighed, worse, lost.name, "later" if later else "less", words))
    return tuple(found)


def _loss(term: Term, nats: float, *, later: bool) -> str:
    if term.sign > 0.0:
        return f"by its {term.meaning} ({nats:.3f} more)"
    if later:
        return f"in {term.meaning}: it gets as much, but later, a longer way ({nats:.3f} less for it)"
    return f"in {term.meaning} ({nats:.3f} less)"


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
