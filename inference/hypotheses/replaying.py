"""Places that were never there: steps replayed in the map as it is, and in the map without them."""

from collections import deque
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from math import exp, log

from .branches import leads, once_read, slips_into_staying
from .evidence import before_reading, log_likelihood, probability, way_odds
from .hypothesis import Hypothesis
from .rates import MOVED
from .records import NOWHERE, RECENT, Place, Way
from .scheme import Sensed
from .weighing import seating

MARGIN = 3  # Steps before and after a visit that are replayed with it

OFTEN = 0.02
"""Rate of silent moves from which on a place that looks like another may be that one, to which the agent was moved."""

SELDOM = 8  # Visits from which on a place is not doubted any more; the times of fewer are all known
LARGEST = 64  # Places of a fragment that is doubted as a whole

STAGE = 64
"""Places of a map up to which steps are replayed among all of them; and, of a larger one, that look like one step."""


class History:
    """The last percepts, by time.

    Attributes:
        norms: (time, nats): how probable each step was after those before it, with all that was thought of by then.

    Args:
        length: how many are read; one more is kept, so that the last one can be taken back.
    """

    def __init__(self, length: int = 512) -> None:
        self.length = length
        self._percepts: deque[tuple[int, Sensed]] = deque(maxlen=length + 1)
        self.norms: deque[tuple[int, float]] = deque(maxlen=length + 1)

    def add(self, sensed: Sensed, time: int) -> None:
        """Append one step; what neither labels nor ways say is left out."""
        self._percepts.append((time, sensed if sensed.others is None else replace(sensed, others=None)))

    def weigh(self, norm: float) -> None:
        """Note how probable the last step was."""
        self.norms.append((self.end - 1, norm))

    def revalue(self, more: float) -> None:
        """All steps together are by so many nats more probable than they were thought."""
        time, norm = self.norms.pop()
        self.norms.append((time, norm + more))

    def norm(self, first: int) -> float:
        """log P(steps from `first` on | those before)."""
        return sum(norm for time, norm in self.norms if time >= first)

    def cut(self, end: int) -> None:
        """Forget what was sensed at `end` or later."""
        for kept in (self._percepts, self.norms):
            while kept and kept[-1][0] >= end:
                kept.pop()

    @property
    def end(self) -> int:
        """The time of the step to come."""
        return self._percepts[-1][0] + 1 if self._percepts else 0

    @property
    def start(self) -> int:
        """The time of the first step that is read."""
        return self.end - min(self.length, len(self._percepts))

    def __getitem__(self, time: int) -> Sensed:
        return self._percepts[time - self.end][1]

    def __iter__(self) -> Iterator[tuple[int, Sensed]]:
        return iter(self._percepts)


def doubted(h: Hypothesis, number: int, history: History) -> set[int]:
    """Places that may never have been: a fragment that was left long ago, or some that do not fit their neighbours."""
    place = h.places[number]
    if not _long_ago(h, place, history):
        return set()
    if fragment := _fragment(h, number, history):
        return fragment if number == min(fragment) else set()
    if not _seldom(h, number, history):
        return set()
    if h.chances.moved > OFTEN and _has_twin(h, place):
        return {number}
    if not _misfit(h, number):
        return set()
    found, queue = {number}, [number]
    for one in queue:
        for way in (h.places[one].ways[index] for index in h.awake):
            if way.to != NOWHERE and way.net >= 0.0 and way.to not in found and _seldom(h, way.to, history):
                found.add(way.to)
                queue.append(way.to)
    return found if h.here not in found and len(found) < h.size else set()


def _fragment(h: Hypothesis, number: int, history: History) -> set[int]:
    """All places that hang together with one, if the agent's is not among them, and every visit of theirs is known."""
    found, queue = {number}, [number]
    for one in queue:
        place = h.places[one]
        if not _long_ago(h, place, history) or len(place.recent) >= RECENT or len(found) > LARGEST:
            return set()
        ahead = [h.neighbour(place, way) for way in h.awake]
        for other in (*ahead, *(source for source, _ in place.into)):
            if other != NOWHERE and other not in found:
                found.add(other)
                queue.append(other)
    return found


def _long_ago(h: Hypothesis, place: Place, history: History) -> bool:
    """Whether its visits are all in the history, and long over."""
    known = history.start == 0 or place.recent[0] >= history.start + MARGIN
    return known and place.recent[-1] < history.end - 2 * MARGIN


def without(h: Hypothesis, numbers: Collection[int], history: History, *, floor: float) -> Hypothesis | None:
    """The hypothesis in which some places never were; None where its log weight is below `floor`.

    Its weight changes by what was to be explained of those places (their sights, their ways), and by how much better
    or worse the steps around their visits are explained without them.
    """
    gain, moves = _prior_cost(h, numbers), 0.0
    for spell in _spells(h, numbers, history):
        among = _stage(h, numbers, spell, history)
        for sign, skip in ((1.0, numbers), (-1.0, ())):
            evidence, moved = replayed(h, history, *spell, skip=skip, start_without=numbers, among=among)
            gain += sign * evidence
            moves += sign * moved
    if h.weight + gain < floor:
        return None
    other = h.fork()
    other.chances, other.weight = h.chances, h.weight + gain
    _remove(other, numbers)
    moves = min(max(moves, -other.counts.yes[MOVED]), other.counts.no[MOVED])
    other.counts.yes[MOVED] += moves
    other.counts.no[MOVED] -= moves
    return other


def _stage(h: Hypothesis, numbers: Collection[int], spell: tuple[int, int], history: History) -> Sequence[int]:
    """The places among which a spell is replayed: of a large map those that are near, and those that look like it."""
    if h.size <= STAGE:
        return [*h.places]
    near, edge = {*numbers}, {*numbers}
    for _ in range(MARGIN + 1):
        records = [h.places[number] for number in edge]
        ahead = {h.neighbour(place, way) for place in records for way in h.awake}
        edge = ahead.union(source for place in records for source, _ in place.into) - near - {NOWHERE}
        near |= edge
    for time in range(spell[0], spell[1] + 1):
        for key in enumerate(history[time].sights):
            if isinstance(key[1], int):
                near.update((h.shown.get((key[0], key[1])) or ())[-STAGE:])
    return sorted(near)


def replayed(
    h: Hypothesis,
    history: History,
    first: int,
    last: int,
    *,
    skip: Collection[int],
    start_without: Collection[int],
    among: Sequence[int],
) -> tuple[float, float]:
    """log P(percepts first … last | the map), started anywhere but in the places `start_without`, never in `skip`;
    and how many silent moves there were in these steps, as is expected. The places `among` which it was moved are all
    that it may have started in; where they are all left out, it is any other.
    """
    start = [k for k in among if k not in start_without] or [k for k in h.places if k not in start_without]
    logs = {k: log_likelihood(h, k, history[first]) for k in start}
    most = max(logs.values())
    belief = {k: exp(value - most) for k, value in logs.items() if value > most - 14.0}
    total = sum(belief.values())
    evidence = moves = 0.0
    for time in range(first + 1, last + 1):
        sensed = history[time]
        ahead = _predicted(h, {k: p / total for k, p in belief.items()}, sensed, skip, among)
        fits = {k: exp(log_likelihood(h, k, sensed)) for k in ahead}
        belief = {k: p * fits[k] for k, p in ahead.items()}
        total = sum(belief.values())
        evidence += log(total)
        moves += h.chances.moved / h.size * sum(fits.values()) / total
        belief = {k: p for k, p in belief.items() if p > 1e-6 * total}
    return evidence, moves


def _predicted(
    h: Hypothesis, belief: dict[int, float], sensed: Sensed, skip: Collection[int], among: Sequence[int]
) -> dict[int, float]:
    """Where the agent is before the sensed, with silent moves to every place evenly, of those `among` which it is."""
    chances, action = h.chances, sensed.action
    ahead: dict[int, float] = {k: chances.moved / h.size for k in among if k not in skip}
    given, fails = NOWHERE if action is None else action, max(chances.fails, sensed.fails)
    always = slips_into_staying(h, given, dict.fromkeys(h.awake, 0.0))
    stays_anyway = (1.0 - chances.astray) * (action is None) + chances.astray * always
    each = {way: chances.astray * h.slip(given, way) for way in h.awake}
    for number, p in belief.items():
        p *= 1.0 - chances.moved
        place, stays = h.places[number], stays_anyway
        for way in h.awake:
            q = p * (1.0 - chances.astray if way == action else each[way])
            opened = probability(way_odds(h, number, place, way))
            lead = leads(h, number, place, way)
            stays += (q / p) * (1.0 - once_read(chances, opened, sensed.ways[way]) * (1.0 - fails))
            opened *= 1.0 - fails
            if lead.to != NOWHERE and lead.to not in skip:
                ahead[lead.to] = ahead.get(lead.to, 0.0) + q * opened * lead.sure * exp(sensed.of_taking(way))
        ahead[number] = ahead.get(number, 0.0) + p * stays * exp(sensed.of_taking(NOWHERE))
    return ahead


def _spells(h: Hypothesis, numbers: Collection[int], history: History) -> Iterator[tuple[int, int]]:
    """(first, last) time of each run of visits, with a margin; runs that overlap are one."""
    times = sorted(time for number in numbers for time in h.places[number].recent)
    first = last = times[0]
    for time in times[1:]:
        if time > last + 2 * MARGIN:
            yield max(first - MARGIN, history.start), min(last + MARGIN, history.end - 1)
            first = time
        last = time
    yield max(first - MARGIN, history.start), min(last + MARGIN, history.end - 1)


def _prior_cost(h: Hypothesis, numbers: Collection[int]) -> float:
    """-log P(the places show what they show, and have the ways they have)."""
    cost = seating(h, removed=numbers)
    for number in numbers:
        place = h.places[number]
        for index in h.awake:
            if place.ways[index].net:
                p = probability(way_odds(h, number, place, index))
                half = 0.5 if h.neighbour(place, index) != NOWHERE else 1.0
                open_ = before_reading(h, number, place, index, h.places.__getitem__, int)
                cost -= half * (p * log(open_) + (1.0 - p) * log(1.0 - open_))
    return cost


def _remove(h: Hypothesis, numbers: Collection[int]) -> None:
    links: set[tuple[int, int]] = set()
    touched: set[int] = set()
    for number in numbers:
        place = h.places[number]
        links |= {(min(number, way.to), max(number, way.to)) for way in place.ways if way.to != NOWHERE}
        touched |= {way.to for way in place.ways if way.to != NOWHERE} | {source for source, _ in place.into}
    for number in sorted(touched - set(numbers)):
        place = h.places[number]
        ways = tuple(
            Way(way.net if way.open + way.blocked else 0.0, way.open, way.blocked, stays=way.stays)
            if way.to in numbers
            else way
            for way in place.ways
        )
        into = frozenset(source for source in place.into if source[0] not in numbers)
        h.put(number, Place(place.sights, ways, place.frame, place.position, place.recent, into, place.share))
    for number in sorted(numbers):
        h.remove(number)
    h.links = max(h.links - len(links), 0)


def _seldom(h: Hypothesis, number: int, history: History) -> bool:
    place = h.places[number]
    return len(place.recent) < min(SELDOM, RECENT) and _long_ago(h, place, history)


def _has_twin(h: Hypothesis, place: Place) -> bool:
    """Whether another place looks like it."""
    return any(len(h.shown.get((sensor, place.label(sensor))) or ()) > 1 for sensor in range(h.scheme.sensors))


def _misfit(h: Hypothesis, number: int) -> bool:
    """Whether no open way leads to the place, or one of its ways contradicts the place it leads to or the chart."""
    place = h.places[number]
    if all(h.places[source].ways[by].net < 0.0 for source, by in place.into):
        return number != 0  # the walk began somewhere
    for index in h.awake:
        if (way := place.ways[index]).to == NOWHERE:
            continue
        if h.scheme.displacements is not None and h.beside(place, index) != way.to:
            return True
        if h.scheme.inverse is not None:
            back = h.places[way.to].ways[h.scheme.inverse[index]]
            if back.net * way.net < 0.0 or (back.to not in (NOWHERE, number)):
                return True
    return False
