"""Which hypotheses are the same, and which are too improbable to keep."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, log

from .hypothesis import Hypothesis
from .records import NOWHERE

Signature = tuple[object, ...]


def signature(h: Hypothesis) -> Signature:
    """The same for two hypotheses that say the same of where the agent is, and of the map as far as it is linked.

    Places are numbered anew in the order in which a breadth-first search from the agent's place finds them; where
    they lead, their sights and, with poses, their positions seen from there are compared.
    """
    numbers = {h.here: 0}
    order = [h.here]
    start = h.places[h.here]
    found: list[object] = [h.size, h.periods.get(start.frame, ())]
    for number in order:
        place = h.places[number]
        found.append(place.label())
        if place.position and place.frame == start.frame:
            found.append(h.canonical(0, [x - y for x, y in zip(place.position, start.position, strict=True)])[1])
        for way in place.ways:
            if way.to == NOWHERE:
                found.append(NOWHERE)
                continue
            if way.to not in numbers:
                numbers[way.to] = len(order)
                order.append(way.to)
            found.append(numbers[way.to])
    return tuple(found)


def merged(hypotheses: Sequence[Hypothesis], proposed: Sequence[Hypothesis] = ()) -> list[Hypothesis]:
    """One of each kind, the most probable first.

    Hypotheses that say the same are histories of one map, so that their weights add up; one that was only proposed
    says nothing that those before it did not: of its weight and theirs the larger one counts.
    """
    if len(hypotheses) + len(proposed) == 1:
        return [*hypotheses, *proposed]
    kept: dict[Signature, Hypothesis] = {}
    for h in sorted(hypotheses, key=lambda h: -h.weight):
        same = kept.setdefault(signature(h), h)
        if same is not h:
            same.weight = log_add(same.weight, h.weight)
    for h in sorted(proposed, key=lambda h: -h.weight):
        same = kept.setdefault(signature(h), h)
        same.weight = max(same.weight, h.weight)
    return sorted(kept.values(), key=lambda h: -h.weight)


def normalised(hypotheses: Sequence[Hypothesis], *, drop: float, most: int) -> list[Hypothesis]:
    """Those within `drop` nats of the first, `most` at most; their weights add up to one."""
    best = hypotheses[0].weight
    kept = [h for h in hypotheses[:most] if h.weight > best - drop]
    total = log_sum([h.weight for h in kept])
    for h in kept:
        h.weight -= total
    return kept


def log_sum(logs: Sequence[float]) -> float:
    """log Σ exp."""
    most = max(logs)
    return most + log(sum(exp(value - most) for value in logs))


def log_add(a: float, b: float) -> float:
    """log(exp(a) + exp(b))."""
    a, b = max(a, b), min(a, b)
    return a + log(1.0 + exp(b - a))
