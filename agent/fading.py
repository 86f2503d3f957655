"""What was known of a map before it is built anew: which place is which, and what is left of counts that fade."""

from collections.abc import Collection, Iterable, Mapping

from ..inference import NOWHERE, Hypothesis, Place
from ..model import CognitiveMap

Counts = tuple[float, float]
"""Evidence that a way is blocked, and that it leads on."""


def still_there(
    h: Hypothesis, records: Mapping[int, Place], places: Iterable[int], *, among: Collection[int] | None = None
) -> dict[int, int]:
    """By number of a place as it was, the place of a hypothesis where the agent was at its last visit.

    One that has kept its number comes last, so that it counts where others are one with it now.

    Args:
        h: the hypothesis.
        records: of the one before, by number.
        places: the numbers.
        among: of these at most something has changed; any unless given.
    """
    known = h.places if among is None else [number for number in among if h.places.get(number) is not None]
    visits = {time: number for number in known for time in h.places[number].recent}
    others, same = dict[int, int](), dict[int, int]()
    for old in places:
        number = visits.get(records[old].recent[-1]) if records[old].recent else None
        if h.places.get(old) is not None:
            same[old] = old
        elif number is not None:
            others[old] = number
    return others | same


def left_of(map_: CognitiveMap, place: int, action: int) -> Counts:
    """The counts of a way as they are."""
    transitions, beyond = map_.transitions, map_.beyond(place, action)
    row = transitions.row(place, action)
    leads = 0.0 if beyond is None else transitions.table.evidence(row, beyond)
    return transitions.table.evidence(row, place), leads


def fade_to(map_: CognitiveMap, place: int, action: int, counts: Counts) -> None:
    """Have no more counts of a way than these."""
    ends = place, map_.beyond(place, action)
    for next_, now, level in zip(ends, left_of(map_, place, action), counts, strict=True):
        if next_ is not None and now > level:
            map_.transitions.level(next_, place, action, level)


def unheard(h: Hypothesis, records: Mapping[int, Place], same: Mapping[int, int], step: int) -> list[tuple[int, int]]:
    """Number of a place as it was and way, of the ways of which the step says nothing: they lead where they led.

    Args:
        h: the hypothesis.
        records: of the one before, by number.
        same: the places of the hypothesis, by number as it was.
        step: the time step.
    """
    found: list[tuple[int, int]] = []
    for old, number in same.items():
        was, now = records[old].ways, h.places[number].ways
        came = h.places[number].recent[-1:] == (step - 1,)
        for way in h.awake if number != h.here else ():
            to, turned = now[way].to, (now[way].net > 0.0) != (was[way].net > 0.0)
            if same.get(was[way].to, NOWHERE) == to and not turned and not (came and to == h.here):
                found.append((old, way))
    return found
