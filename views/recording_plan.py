"""The plan of a step for a recording: the best policies, what they are worth, and where they lead."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..planning import TIE, Plan

MOST = 12
"""Policies that are kept, the best ones."""

DIGITS = 4


def plan_frame(plan: Plan) -> dict[str, Any]:
    """What a person wants to know of a plan, as JSON values.

    `policies` (actions by index), `P`, `G`, `terms` (in the order of the terms of G) and `paths` (places of the map,
    the present one first, -1 from where nothing is imagined) have an entry a policy, the least G first. `mean` has
    the terms of all that were considered, on average.
    """
    cost, terms = plan.expected_free_energy.G, plan.expected_free_energy
    best = _best(plan, cost)
    every = terms.values.T
    return {
        "considered": len(plan.policies),
        "cut": int(plan.cut),
        "ties": int((cost - cost.min() <= TIE).sum()),
        "chosen": int(np.flatnonzero(best == plan.chosen)[0]),
        "action": int(plan.action),
        "policies": plan.policies[best].tolist(),
        "P": plan.probability[best].round(DIGITS + 2).tolist(),
        "G": cost[best].round(DIGITS).tolist(),
        "terms": (every[best].round(DIGITS) + 0.0).tolist(),
        "mean": (every.mean(axis=0).round(DIGITS) + 0.0).tolist(),
        "paths": _paths(plan, best).tolist(),
    }


def _best(plan: Plan, cost: np.ndarray[Any, np.dtype[np.float64]]) -> np.ndarray[Any, np.dtype[np.int64]]:
    """Indices of the policies to keep; the chosen one is among them, whatever its rank."""
    most = min(MOST, len(cost))
    best = np.argpartition(cost, most - 1)[:most]
    best = best[np.argsort(cost[best], kind="stable")]
    if plan.chosen not in best:
        best[-1] = plan.chosen
    return best


def _paths(plan: Plan, best: np.ndarray[Any, np.dtype[np.int64]]) -> np.ndarray[Any, np.dtype[np.int64]]:
    """`[n, L + 1]` the most probable places along each policy, from the most probable one now."""
    model = plan.model
    likely = model.B.dense.argmax(axis=0)
    actions = plan.policies[best]
    here = np.full(len(best), int(model.belief.argmax()))
    paths = [here]
    for column in actions.T:
        here = likely[here, column]
        paths.append(here)
    return model.places[np.stack(paths, axis=1)]
