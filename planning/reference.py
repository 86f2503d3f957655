"""Expected free energy once more, without sharing and without arrays, to be read against the equations."""

from collections.abc import Sequence

import numpy as np

from .energy import ExpectedFreeEnergy
from .local import LocalModel
from .policies.base import Policies
from .terms import TERMS, Step, Term


def evaluate_plain(model: LocalModel, policies: Policies, terms: Sequence[Term] = TERMS) -> ExpectedFreeEnergy:
    """The same as `evaluate`, policy by policy and step by step in plain Python.

    Slow: meant for tests and for reading.
    """
    rows = [_values(model, policy, terms) for policy in policies.actions.tolist()]
    return ExpectedFreeEnergy(tuple(terms), np.array(rows, dtype=np.float64).reshape(-1, len(terms)).T)


def _values(model: LocalModel, policy: Sequence[int], terms: Sequence[Term]) -> list[float]:
    """sum_t discount^(t-1) gain_t of each term (eq. 4)."""
    steps = steps_of(model, policy)
    weights = [model.information_weight if term.kind == "information" else 1.0 for term in terms]
    return [
        weight * sum(model.discount**t * term.plain(step) for t, step in enumerate(steps))
        for term, weight in zip(terms, weights, strict=True)
    ]


def steps_of(model: LocalModel, policy: Sequence[int]) -> list[Step]:
    """What each step of one policy expects: beliefs, visits v_s(t) = sum Q_t'(s), and q_s(t) = max Q_t'(s)."""
    places = range(len(model.belief))
    belief: list[float] = model.belief.tolist()
    visits, reached = [0.0 for _ in places], [0.0 for _ in places]
    tried: dict[tuple[int, int], float] = {}
    steps: list[Step] = []
    for t, action in enumerate(policy):
        after = predicted_places(model, belief, action)
        more = [visits[s] + after[s] for s in places]
        likelier = [max(reached[s], after[s]) for s in places]
        also = tried | {(s, action): max(tried.get((s, action), 0.0), belief[s]) for s in places}
        path = policy[: t + 1]
        steps.append(Step(model, action, belief, after, visits, more, reached, likelier, path, tried, also))
        belief, visits, reached, tried = after, more, likelier, also
    return steps


def predicted_places(model: LocalModel, Q: Sequence[float], action: int) -> list[float]:
    """Q_t(s') = sum_s B[s', s, a] Q_{t-1}(s)."""
    places, B = range(len(Q)), model.B.dense
    return [sum(float(B[after, s, action]) * Q[s] for s in places) for after in places]
