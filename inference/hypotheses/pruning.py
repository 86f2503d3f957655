"""Which hypotheses are the same, and which are too improbable to keep."""

from __future__ import annotations

from collections.abc import Sequence

from .hypothesis import Hypothesis
from .layered import Kept
from .logs import log_add, log_sum
from .records import NOWHERE, Place, Position


def alike(one: Hypothesis, other: Hypothesis) -> bool:
    """Whether two hypotheses say the same of where the agent is, and of the map as far as it is linked.

    A breadth-first search from the agent's place walks through both maps side by side; where ways lead, sights and,
    with poses, positions seen from there are compared, until something differs. What nobody has written to since the
    two were one is the same in both, by its number, so that the search begins where it was left.
    """
    a, b = one.places[one.here], other.places[other.here]
    if (one.size, one.digest) != (other.size, other.digest) or one.crowd is not None or other.crowd is not None:
        return False
    if one.periods.get(a.frame, ()) != other.periods.get(b.frame, ()):
        return False
    order = [(one.here, other.here)]
    kept = one.places.kept(other.places) if _stands(one, a) == _stands(other, b) else None
    if kept is not None:
        order += [(number, number) for number in kept.changed if _linked(one, number, kept) and number != one.here]
    pairs, back = dict(order), {its: mine for mine, its in order}
    for mine, its in order:
        here, there = one.places[mine], other.places[its]
        if here is there and kept is not None:
            continue
        if here.label() != there.label() or _seen(one, a, here) != _seen(other, b, there):
            return False
        for way, its_way in ((here.ways[k], there.ways[k]) for k in one.awake):
            if (way.to == NOWHERE) != (its_way.to == NOWHERE):
                return False
            if way.to == NOWHERE:
                continue
            if way.to not in pairs and its_way.to not in back:
                if kept is not None and way.to != its_way.to and (way.to in kept or its_way.to in kept):
                    return False
                pairs[way.to], back[its_way.to] = its_way.to, way.to
                order.append((way.to, its_way.to))
            elif pairs.get(way.to) != its_way.to:
                return False
    return True


def _stands(h: Hypothesis, here: Place) -> object:
    return h.here, here.frame, here.position


def _linked(h: Hypothesis, number: int, kept: Kept[int]) -> bool:
    """Whether a place that was written to is the same one in both, since a place that was not leads there."""
    place = h.places.get(number)
    return place is not None and any(source in kept for source, _ in place.into)


def _seen(h: Hypothesis, start: Place, place: Place) -> object:
    """The position of a place as seen from another in the same chart; None in another chart."""
    if not place.position or place.frame != start.frame:
        return None
    return h.canonical(start.frame, [x - y for x, y in zip(place.position, start.position, strict=True)])[1]


def merged(hypotheses: Sequence[Hypothesis], proposed: Sequence[Hypothesis] = ()) -> list[Hypothesis]:
    """One of each kind, the most probable first.

    Hypotheses that say the same are histories of one map, so that their weights add up; one that was only proposed
    says nothing that those before it did not: of its weight and theirs the larger one counts.
    """
    if len(hypotheses) + len(proposed) == 1:
        return [*hypotheses, *proposed]
    kept: dict[object, list[Hypothesis]] = {}
    for h in sorted(hypotheses, key=lambda h: -h.weight):
        same = _kept(kept, h)
        if same is not h:
            same.weight = log_add(same.weight, h.weight)
    for h in sorted(proposed, key=lambda h: -h.weight):
        same = _kept(kept, h)
        same.weight = max(same.weight, h.weight)
    return sorted((h for group in kept.values() for h in group), key=lambda h: -h.weight)


def _kept(kept: dict[object, list[Hypothesis]], h: Hypothesis) -> Hypothesis:
    """The one that says the same, or this one, which is kept from now on."""
    group = kept.setdefault((h.digest, _lies(h)), [])
    same = next((other for other in group if alike(other, h)), h)
    if same is h:
        group.append(h)
    return same


def _lies(h: Hypothesis) -> Position | None:
    """How the chart lies about the agent (size, sums of coordinates), which tells most apart that are not alike."""
    here = h.places[h.here]
    if not here.position or h.periods.get(here.frame):
        return None
    size, *sums = h.laid[here.frame]
    return (size, *(total - size * x for total, x in zip(sums, here.position, strict=True)))


def normalised(hypotheses: Sequence[Hypothesis], *, drop: float, most: int) -> tuple[list[Hypothesis], float]:
    """Those within `drop` nats of the first, `most` at most; their weights add up to one, and what was divided by."""
    best = hypotheses[0].weight
    kept = [h for h in hypotheses[:most] if h.weight > best - drop]
    total = log_sum([h.weight for h in kept])
    for h in kept:
        h.weight -= total
    return kept, total
