"""What a hypothesis says: of ways, of sights, of its rates."""

from collections.abc import Mapping
from math import exp, log
from typing import NamedTuple

from .branches import Lead, leads
from .chances import Chances
from .evidence import label_shares, probability, way_odds
from .hypothesis import Hypothesis
from .rates import RATE_PRIORS, WAY_MISREAD, RateCounts
from .records import SightCounts

CLEAN = 0.002  # Share of readings that are expected to be misread by a sensor of which nothing says that it errs


class RateOf(NamedTuple):
    """A rate as one hypothesis has learned it.

    Attributes:
        name, meaning: what it is called, and what it is the rate of.
        mean: what is expected of it.
        yes, no: how often it was found true and false; soft counts are posterior probabilities.
    """

    name: str
    meaning: str
    mean: float
    yes: float
    no: float


def open_probability(h: Hypothesis, number: int, way: int) -> float:
    """P(a way of a place is open), by what was read on both of its sides."""
    return probability(way_odds(h, number, h.places[number], way))


def where_to(h: Hypothesis, number: int, way: int) -> Lead:
    """Where a way of a place leads if it is open: to a known place, with its probability, or to one never seen."""
    return leads(h, number, h.places[number], way)


def label_probabilities(h: Hypothesis, number: int, *, sensor: int = 0) -> dict[int, float]:
    """P(label) of the labels that were read in a place; those never read there share what is missing to one evenly."""
    return label_shares(h.chances, sensor, h.places[number].sights[sensor])


def whereabouts(h: Hypothesis) -> dict[int, float]:
    """P(place) of the agent under one hypothesis; more than one place only if the hypothesis leaves it open."""
    if h.crowd is None:
        return {h.here: 1.0}
    return {number: exp(weight) for number, weight in h.crowd.items()}


def together(one: Hypothesis, other: Hypothesis) -> bool:
    """Whether two hypotheses have the agent in the same place, wherever their charts have that.

    A place is the same where both have the agent in it since the same step, or have had it there last at the same step.
    """
    return one.here == other.here or _before(one) == _before(other)


def indistinguishable(one: Hypothesis, other: Hypothesis) -> bool:
    """Whether no walk tells two hypotheses apart: at most they differ in where they lay places that are linked alike.

    What nobody has written to since the two were one is the same in both, and so are the ways that lead from there.
    """
    if (one.here, one.size, one.digest) != (other.here, other.size, other.digest) or one.crowd or other.crowd:
        return False
    kept = one.places.kept(other.places)
    return kept is not None and all(_shows(one, number) == _shows(other, number) for number in kept.changed)


def _shows(h: Hypothesis, number: int) -> object:
    """What a place looks like, and where each way leads, and whether it is open; None where there is no such place."""
    place = h.places.get(number)
    if place is None:
        return None
    ways = [(h.neighbour(place, way), place.ways[way].net > 0.0) for way in h.awake]
    return place.label(), ways


def _before(h: Hypothesis) -> int | None:
    """When the agent was last where it is now, before now."""
    recent = h.places[h.here].recent
    return recent[-2] if len(recent) > 1 else None


def ways_misread(h: Hypothesis) -> float:
    """How many ways were misread so far, as is expected; none where a clean sensor seems to do so."""
    yes, no = h.counts.of(WAY_MISREAD)
    return yes if yes > CLEAN * (yes + no) else 0.0


def rates_of(h: Hypothesis) -> list[RateOf]:
    """Every rate, in the order in which they are declared."""
    counts = h.counts
    return [RateOf(prior.name, prior.meaning, counts.mean(k), *counts.of(k)) for k, prior in enumerate(RATE_PRIORS)]


def readings_of(shares: Mapping[int, float], labels: int, *, sure: float) -> SightCounts:
    """Readings after which labels are as probable as these shares, the most probable one read `sure` times.

    Args:
        shares: by number of the label, above zero.
        labels: number of labels of the sensor, one never met included.
        sure: at no doubt.
    """
    unit, most = Chances(RateCounts(), [labels]).sight_unit[0], max(shares.values())
    counts = {label: sure + log(share / most) / unit for label, share in shares.items()}
    return {label: count for label, count in counts.items() if count > 0.0}
