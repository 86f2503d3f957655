"""What a recording says of the world, of a step's plan, and of the factor graph of its window, as JSON values."""

from typing import Any

import numpy as np

from ..inference import infer
from ..model import FactorGraph, encode, plain
from ..planning import TIE, Plan, Term
from .picture import Picture

MOST = 12  # policies that are kept, the best ones
DIGITS = 4
NUMBERS = ("certainty", "doubt", "moved", "free_energy", "complexity", "accuracy", "evidence")  # of a step
TERM = ("name", "label", "kind", "colour", "meaning")  # texts of a term


def term_json(term: Term) -> dict[str, Any]:
    """What a recording says of a term of G."""
    return {name: getattr(term, name) for name in (*TERM, "sign")}


def world_json(picture: Picture) -> dict[str, Any]:
    """What is drawn of a world: `[row, column, label]` of each place, `[a, b, one way]` and the bends of each way."""
    number = {place: at for at, place in enumerate(picture.cells)}
    lines, ways = picture.lines, {(a, b) for a, b, _ in picture.links}
    once = [(a, b) for a, b, _ in picture.links if number[a] < number[b] or (b, a) not in ways]
    return {
        "rooms": picture.rooms,
        "places": [
            [*(round(part, DIGITS) for part in cell), encode(plain(picture.labels[place]), where="recorder")]
            for place, cell in picture.cells.items()
        ],
        "ways": [
            [number[a], number[b], int((b, a) not in ways), *lines[a, b][1:-1].round(DIGITS).tolist()] for a, b in once
        ],
        "walls": [[*one, *other] for one, other, _ in picture.walls],
    }


def plan_frame(plan: Plan) -> dict[str, Any]:
    """What a person wants to know of a plan.

    `policies` (actions by index), `P`, `G`, `terms` (in the order of the terms of G) and `paths` (places of the map,
    the most probable ones, from the present one on, -1 from where nothing is imagined) have an entry a policy, the
    least G first. `mean` has the terms of all that were considered, on average.
    """
    energy, cost = plan.expected_free_energy, plan.expected_free_energy.G
    most = min(MOST, len(cost))
    best = np.argpartition(cost, most - 1)[:most]
    best = best[np.argsort(cost[best], kind="stable")]
    if plan.chosen not in best:
        best[-1] = plan.chosen
    paths, likely = [np.full(most, int(plan.model.belief.argmax()))], plan.model.B.dense.argmax(axis=0)
    for column in plan.policies[best].T:
        paths.append(likely[paths[-1], column])
    return {
        "considered": len(plan.policies),
        "cut": int(plan.cut),
        "ties": int((cost - cost.min() <= TIE).sum()),
        "chosen": int(np.flatnonzero(best == plan.chosen)[0]),
        "action": int(plan.action),
        "policies": plan.policies[best].tolist(),
        "P": plan.probability[best].round(DIGITS + 2).tolist(),
        "G": cost[best].round(DIGITS).tolist(),
        "terms": (energy.values[:, best].T.round(DIGITS) + 0.0).tolist(),
        "mean": (energy.values.mean(axis=1).round(DIGITS) + 0.0).tolist(),
        "paths": plan.model.places[np.stack(paths, axis=1)].tolist(),
    }


class WindowWatch:
    """Tells what is new in the windows that follow one another.

    Variables (name, time, label where observed) and factors (symbol, kind, scope) are told once, at the step that
    added them. The graph of a step is the prior of time `since`, the other factors of later times, and the variables
    in their scopes. `tops` has the latent variables whose most probable label, or its probability, is not what was
    told last.
    """

    def __init__(self) -> None:
        self._told: set[str] = set()
        self._tops: dict[str, list[Any]] = {}

    def delta(self, graph: FactorGraph) -> dict[str, Any]:
        """What is new since the last call."""
        variables = [variable for variable in graph.variables if variable.name not in self._told]
        factors = [factor for factor in graph.factors if factor.label not in self._told]
        self._told.update([*(variable.name for variable in variables), *(factor.label for factor in factors)])
        before, self._tops = self._tops, _tops(graph)
        return {
            "since": min(variable.time or 0 for variable in graph.variables),
            "variables": [[v.name, v.time, *([encode(v.domain[0])] if v.observed else [])] for v in variables],
            "factors": [[f.name, f.kind, *(variable.name for variable in f.scope)] for f in factors],
            "tops": [[name, *top] for name, top in self._tops.items() if before.get(name) != top],
        }


def _tops(graph: FactorGraph) -> dict[str, list[Any]]:
    """The most probable label of every latent variable, and its probability."""
    posterior, tops = infer(graph), dict[str, list[Any]]()
    for variable in graph.variables:
        if not variable.observed:
            q = posterior.marginal(variable.name)
            tops[variable.name] = [encode(variable.domain[int(q.argmax())]), round(float(q.max()), DIGITS)]
    return tops
