"""A tracker that begins with a map that is known."""

from collections.abc import Mapping, Sequence

from .chances import Chances
from .extending import shared
from .hypothesis import Hypothesis, awake_ways, with_reverse
from .options import TrackerOptions
from .records import NOWHERE, Place
from .scheme import WayScheme
from .tracker import Tracker


def tracker_knowing(
    scheme: WayScheme,
    places: Mapping[int, Place],
    *,
    here: int,
    time: int,
    labels: Sequence[int],
    options: TrackerOptions | None = None,
) -> Tracker:
    """A tracker with one hypothesis, built from known places: their readings and where their ways lead.

    Args:
        scheme: the ways.
        places: numbers are times of first visits, below `time`.
        here: the number of the place where the agent is.
        time: of the next step.
        labels: how many labels each sensor has shown.
        options: how many hypotheses are kept.
    """
    h = Hypothesis(scheme)
    open_ = {
        way
        for place in places.values()
        for way, known in enumerate(place.ways)
        if known.net > 0.0 or known.walks or known.to != NOWHERE
    }
    h.awake = with_reverse(scheme, {*awake_ways(scheme), *open_})
    h.chances = Chances(h.counts, [n + 1 for n in labels], size=max(len(places), 1))
    for number, place in places.items():
        h.put(number, place)
    for number in places:
        h.put(number, shared(h, number, h.places[number]))
    links = {frozenset((k, way.to)) for k, place in places.items() for way in place.ways if way.to != NOWHERE}
    h.links, h.here = len(links), here
    h.settle()
    tracker = Tracker(scheme, options)
    tracker.awake = h.awake
    tracker.hypotheses, tracker.time, tracker.labels = [h], time, tuple(n + 1 for n in labels)
    return tracker
