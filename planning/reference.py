"""Expected free energy once more, without sharing and without arrays, to be read against the equations."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, log

import numpy as np

from .energy import ExpectedFreeEnergy
from .policies.base import Policies
from .reach import Reach

TERMS = 6


def evaluate_plain(reach: Reach, policies: Policies) -> ExpectedFreeEnergy:
    """What `rollout.evaluate` computes (its docstring is the definition), policy by policy.

    Slow: meant for tests and for reading.
    """
    rows = [_terms(reach, policy) for policy in policies.actions.tolist()]
    columns = np.array(rows, dtype=np.float64).reshape(-1, TERMS).T
    return ExpectedFreeEnergy(*columns)


def _terms(reach: Reach, policy: Sequence[int]) -> list[float]:
    """State, sight, position and transition information, utility, collision of one policy (eqs. 4, 5, 8)."""
    places = range(len(reach.belief))
    total = [0.0] * TERMS
    belief: list[float] = reach.belief.tolist()
    visits = [0.0 for _ in places]
    reached = [0.0 for _ in places]
    tables = [reach.sight_information, reach.position_information, reach.transition_information]
    for step, action in enumerate(policy):
        weight = reach.discount**step
        before, belief = belief, predicted_places(reach, belief, action)
        if action != reach.motions.stay:
            total[0] += weight * state_information(reach, belief)
        for s in places:
            more, likelier = visits[s] + belief[s], max(reached[s], belief[s])
            for term, table in enumerate(tables, start=1):
                row: list[float] = table[s].tolist()
                total[term] += weight * (collected(row, more, likelier) - collected(row, visits[s], reached[s]))
            visits[s], reached[s] = more, likelier
        sights = enumerate(predicted_sights(reach, belief))
        total[4] += weight * sum(mass * float(reach.log_C[o]) for o, mass in sights)
        total[4] += weight * sum(belief[s] * float(reach.log_C_place[s]) for s in places)
        risk = sum(before[s] * float(reach.collision[s, action]) for s in places)
        total[5] += weight * reach.collision_cost * risk
    return [reach.information_weight * term for term in total[:4]] + total[4:]


def predicted_places(reach: Reach, Q: Sequence[float], action: int) -> list[float]:
    """Q_t(s') = sum_s B[s', s, a] Q_{t-1}(s)."""
    places = range(len(Q))
    return [sum(float(reach.B[after, s, action]) * Q[s] for s in places) for after in places]


def predicted_sights(reach: Reach, Q: Sequence[float]) -> list[float]:
    """P_t(o) = sum_s A[o, s] Q_t(s), lumped rows together."""
    return [sum(float(row[s]) * Q[s] for s in range(len(Q))) for row in reach.A]


def state_information(reach: Reach, Q: Sequence[float]) -> float:
    """H[o] - sum_s Q(s) H[o | s], the mutual information of sight and place (eq. 5)."""
    ambiguity = sum(Q[s] * entropy(reach, reach.A[:, s].tolist()) for s in range(len(Q)))
    return entropy(reach, predicted_sights(reach, Q)) - ambiguity


def entropy(reach: Reach, sights: Sequence[float]) -> float:
    """-sum m ln(m / k) over rows of mass m that stand for k sights each."""
    counts = reach.multiplicity.tolist()
    return -sum(mass * log(mass / k) for mass, k in zip(sights, counts, strict=True) if mass > 0.0)


def collected(table: Sequence[float], visits: float, reached: float) -> float:
    """C = q I(v / q): what `visits` teach if there is any visit with probability `reached`."""
    return reached * read(table, visits / reached) if reached > 0.0 else 0.0


def read(table: Sequence[float], visits: float) -> float:
    """I(visits), linear between integers, constant beyond the table."""
    last = len(table) - 1
    if visits >= last:
        return table[last]
    low = floor(visits)
    return table[low] + (visits - low) * (table[low + 1] - table[low])
