"""What an agent holds possible of its map, to be read."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import exp

from ..inference import NOWHERE, Hypothesis
from .mirror import Mirror


@dataclass(frozen=True, slots=True)
class MapHypothesis:
    """One hypothesis about the map, and where the agent is in it."""

    probability: float  # its posterior probability
    places: int  # how many places were visited, if it is so
    place: int | None  # the place of the agent's map where the agent is; None for one that its map does not have
    differences: tuple[str, ...]  # how it differs from the one that the map says, in words; none if it is that one


def compared(followed: Hypothesis, hypotheses: Sequence[Hypothesis], mirror: Mirror) -> tuple[MapHypothesis, ...]:
    """Every hypothesis beside the one that the map says."""
    found: list[MapHypothesis] = []
    for h in hypotheses:
        place = mirror.place(h)
        differences = tuple(_differences(followed, h, place, mirror)) if h is not followed else ()
        found.append(MapHypothesis(exp(h.weight), h.size, place, differences))
    return tuple(found)


def _differences(best: Hypothesis, h: Hypothesis, place: int | None, mirror: Mirror) -> Iterator[str]:
    if h.size != best.size:
        yield f"{h.size} places instead of {best.size}"
    if h.periods != best.periods:
        yield "the map closes on itself" if h.periods else "the map does not close on itself"
    if place != mirror.place(best):
        yield "the agent is " + ("in a place that the map does not have" if place is None else f"in place {place}")
    for number, mine in mirror.places.items():
        its = h.places.get(number)
        if its is None:
            yield f"place {mine} is another one"
            continue
        for way, (one, other) in enumerate(zip(best.places[number].ways, its.ways, strict=True)):
            if NOWHERE not in (one.to, other.to) and one.to != other.to:
                to = mirror.places.get(other.to, "a place that the map does not have")
                yield f"{mirror.action(way)} of place {mine} leads to {to}"
