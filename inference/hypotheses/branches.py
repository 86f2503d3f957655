"""What may have happened in one step, under one hypothesis."""

from collections.abc import Iterator, Mapping
from heapq import nlargest
from math import exp, inf, log
from typing import NamedTuple

from .chances import Chances
from .evidence import log_likelihood, log_predictive, probability, reading_probability, way_odds
from .hypothesis import Hypothesis
from .logs import log_sum
from .rates import OPEN
from .records import NOWHERE, Place
from .scheme import Sensed
from .squares import across

CROWD = 8  # Places from which on those that a silent move may have led to are one hypothesis, with a message over them
MOST = 4096  # Places into which a silent move is thought of at most, the last ones first seen
SQUARES = 0.1  # Rate of squares that close below which none is thought of
FEW = 512  # Places up to which all are looked at when the agent is told that it was moved
FAINT = 18.0  # Nats below which a place of a crowd is let go


class Alternative(NamedTuple):
    """One thing that may have happened.

    Attributes:
        weight: log P(branch, sensed | hypothesis), times the weight of the hypothesis.
        parent: the hypothesis it continues.
        way: the way that was walked; `NOWHERE` if none was.
        to: the place the agent is in now; `NOWHERE` for one never seen.
        charted: the new place is where the pose says.
        astray, failed, moved: posterior probabilities that this is how it happened; where a move did not lead on and
            nothing says why, only the last is counted (`RateCounts.blame` says the others).
        crowd: where the agent may be, with log probabilities, in one map; None where that is `to`.
    """

    weight: float
    parent: Hypothesis
    way: int
    to: int
    charted: bool
    astray: float
    failed: float
    moved: float
    crowd: Mapping[int, float] | None = None


def apart(branch: Alternative, best: Alternative) -> bool:
    """Whether a branch says of a new place only that it is not where the pose says, as the best one does.

    Both expect the same until a chart contradicts one of them.
    """
    return branch.to == NOWHERE and not branch.charted and best.charted


class Lead(NamedTuple):
    """Where an open way may lead: `to` (if that is a place) with `sure`, a new place where the pose says, or off it."""

    to: int
    sure: float
    new: float
    off: float


def branches(h: Hypothesis, sensed: Sensed, *, drop: float, floor: float = -inf) -> Iterator[Alternative]:
    """What may have happened, as far as it is above `floor` and within `drop` (nats) of the most probable so far."""
    if h.crowd is not None and not sensed.told:
        yield from strayed(h, sensed, h.crowd, drop=drop)
        return
    walker = Walker(h, sensed)
    walker.floor = floor
    for branch in walker.moves():
        walker.floor = max(walker.floor, branch.weight - drop)
        yield branch


class Walker:
    """The branches of one hypothesis; evidence of a place is worked out once.

    Attributes:
        floor: log weight below which branches need not be named.
        surplus: how far above zero a log-likelihood may be.
        fails: P(the move failed | its way is open).
        given: the way that was to be taken; `NOWHERE` for staying.
        astray: P(another one was taken).
        unseen: places that are thought to be there but were never seen.
        put_there: log P(the agent was moved into a certain place).
        arrived: places that a branch leads to with no change of the map.
    """

    def __init__(self, h: Hypothesis, sensed: Sensed) -> None:
        self.h, self.sensed, self.chances = h, sensed, h.chances
        self.place = h.places[h.here]
        self._open: dict[int, float] = {}
        self.evidence: dict[int, float] = {}
        self.floor = -inf
        self.surplus = 0.0 if sensed.others is None else inf
        self.fails = max(self.chances.fails, sensed.fails)
        self.given = NOWHERE if sensed.action is None else sensed.action
        self.astray = 0.0 if sensed.certain else self.chances.astray
        self.unseen = unseen(h)
        self.put_there = (0.0 if sensed.told else log(self.chances.moved)) - log(h.size + self.unseen)
        self.arrived: set[int] = set()

    def moves(self) -> Iterator[Alternative]:
        """All branches but those that are far below `floor`."""
        h, given = self.h, self.given
        if self.sensed.told:
            yield from self._moved()
            return
        stayed = h.weight + log(1.0 - self.chances.moved)
        if given != NOWHERE:
            yield from self._walk(given, stayed + log(1.0 - self.astray), 0.0)
        staying = self.stay(stayed)
        if staying is not None:
            yield staying
        if self.astray > 0.0 and stayed + log(self.astray) > self.floor - self.surplus:
            for way in h.awake:
                if way != given and (each := stayed + log(self.each(way))) > self.floor - self.surplus:
                    yield from self._walk(way, each, 1.0)
        yield from self._moved()

    def each(self, way: int) -> float:
        """P(this way was taken, and another one was given)."""
        return self.astray * self.h.slip(self.given, way)

    def open(self, way: int) -> float:
        """P(open) of a way of the place it is in."""
        found = self._open.get(way)
        if found is None:
            found = self._open[way] = probability(way_odds(self.h, self.h.here, self.place, way))
        return found

    def stay(self, before: float) -> Alternative | None:
        """It is where it was: told to stay, blocked, failed, or put there; None if that is below the floor."""
        action, fails, astray = self.sensed.action, self.fails, self.astray
        self.arrived.add(self.h.here)
        opened = {way: once_read(self.chances, self.open(way), self.sensed.ways[way]) for way in self.h.awake}
        stays = {way: 1.0 - p * (1.0 - fails) for way, p in opened.items()}
        lost = astray * slips_into_staying(self.h, self.given, stays)
        given = (1.0 - astray) * (1.0 if action is None else stays[action])
        failed = 0.0 if action is None else (1.0 - astray) * opened[action] * fails
        put_here = exp(self.put_there + self.h.weight - before)
        walked = (given + lost) * exp(self.sensed.of_taking(NOWHERE))
        total = walked + put_here
        if before + log(total) <= self.floor - self.surplus:
            return None
        weight = before + log(total) + self.at(self.h.here)
        share = walked / (given + lost) / total
        parts = lost * share, failed * share, put_here / total
        return Alternative(weight, self.h, NOWHERE, self.h.here, False, *parts)

    def _walk(self, way: int, before: float, astray: float) -> Iterator[Alternative]:
        h, p = self.h, self.open(way) * (1.0 - self.fails)
        before += log(p) + self.sensed.of_taking(way)
        lead = leads(h, h.here, self.place, way)
        if lead.to != NOWHERE and max(before, self.h.weight + self.put_there) + log(2.0) > self.floor - self.surplus:
            yield self.along(way, lead, before, astray)
        if lead.new > 0.0 and before + log(lead.new) > self.floor - self.surplus:
            yield self.new(way, before + log(lead.new), astray)
        if lead.off > 0.0 and before + log(lead.off) > self.floor - self.surplus:
            yield self.off(way, lead, before, astray)

    def off(self, way: int, lead: Lead, before: float, astray: float) -> Alternative:
        """Along a way, to a place never seen that is not where the pose says."""
        h = self.h
        back = None if h.scheme.inverse is None else h.scheme.inverse[way]
        weight = before + log(lead.off) + log_predictive(h, self.sensed, None, back, h.here)
        return Alternative(weight, h, way, NOWHERE, False, astray, 0.0, 0.0)

    def new(self, way: int, before: float, astray: float) -> Alternative:
        """Along a way, to a place never seen that is where the pose says, if it says that."""
        h = self.h
        back = None if h.scheme.inverse is None else h.scheme.inverse[way]
        weight = before + log_predictive(h, self.sensed, h.beyond(self.place, way), back, h.here)
        return Alternative(weight, h, way, NOWHERE, True, astray, 0.0, 0.0)

    def put_elsewhere(self) -> Alternative:
        """Put into a place never seen, without a word."""
        weight = log_predictive(self.h, self.sensed, None, None, NOWHERE)
        weight += self.h.weight + self.put_there + log(self.unseen)
        return Alternative(weight, self.h, NOWHERE, NOWHERE, False, 0.0, 0.0, 1.0)

    def along(self, way: int, lead: Lead, before: float, astray: float) -> Alternative:
        """Along a way; if it was walked before, being put there makes the same map, so the two are one branch."""
        weight, moved = before + log(lead.sure), 0.0
        if self.place.ways[way].walks and lead.to not in self.arrived:
            self.arrived.add(lead.to)
            ratio = exp(self.put_there + self.h.weight - weight)
            weight, moved = weight + log(1.0 + ratio), ratio / (1.0 + ratio)
        weight += self.at(lead.to) + self._read_from_behind(way, lead.to)
        return Alternative(weight, self.h, way, lead.to, False, astray * (1.0 - moved), 0.0, moved)

    def _read_from_behind(self, way: int, to: int) -> float:
        """How much more probable what is read of the way back is for having walked here: mostly it is the same door."""
        inverse, chances = self.h.scheme.inverse, self.chances
        if inverse is None or (reading := self.sensed.ways[inverse[way]]) is None or inverse[way] not in self.h.awake:
            return 0.0
        there, back = self.h.places[to], inverse[way]
        if there.ways[back].to not in (NOWHERE, self.h.here):
            return 0.0
        before = probability(way_odds(self.h, to, there, back))
        after = chances.undone + (1.0 - chances.undone) * before
        return log(reading_probability(chances, after, reading) / reading_probability(chances, before, reading))

    def _moved(self) -> Iterator[Alternative]:
        h, each = self.h, self.h.weight + self.put_there
        if each + log(h.size + self.unseen) <= self.floor - self.surplus:
            return
        found = {k: each + self.at(k) for k in look_alikes(h, self.sensed) if k not in self.arrived}
        if len(found) > CROWD:
            yield self._crowd(found)
        else:
            for number, weight in found.items():
                yield Alternative(weight, h, NOWHERE, number, False, 0.0, 0.0, 1.0)
        yield self.put_elsewhere()

    def _crowd(self, found: Mapping[int, float]) -> Alternative:
        """Put into one of many places."""
        total = log_sum(list(found.values()))
        crowd = {number: weight - total for number, weight in found.items() if weight > total - FAINT}
        to = max(crowd, key=crowd.__getitem__)
        return Alternative(total, self.h, NOWHERE, to, False, 0.0, 0.0, 1.0, crowd)

    def at(self, number: int) -> float:
        """log P(sensed | that place)."""
        found = self.evidence.get(number)
        if found is None:
            found = self.evidence[number] = log_likelihood(self.h, number, self.sensed)
        return found


def once_read(chances: Chances, p_open: float, reading: float | None) -> float:
    """P(a way is open | what is read of it now): what keeps the agent in its place is read there as well."""
    if reading is None:
        return p_open
    as_open, as_blocked = (reading_probability(chances, p, reading) for p in (1.0, 0.0))
    return p_open * as_open / (p_open * as_open + (1.0 - p_open) * as_blocked)


def slips_into_staying(h: Hypothesis, given: int, stays: Mapping[int, float]) -> float:
    """P(it stayed | another way than the one given was taken), by how each of those that are thought of keeps it."""
    lost = sum(h.slip(given, way) * p for way, p in stays.items() if way != given)
    return lost if given == NOWHERE else lost + h.slip(given, NOWHERE)


def unseen(h: Hypothesis) -> float:
    """Places that are thought to be there but were never seen: half of the open ways that lead to no known place."""
    return max(0.5, 0.5 * (h.counts.yes[OPEN] - h.links))


def look_alikes(h: Hypothesis, sensed: Sensed) -> tuple[int, ...]:
    """Places that may look like what is sensed, to any sensor that is sure of it; those first seen last."""
    if sensed.told and h.size <= FEW:  # any place may show it, however rarely
        return tuple(h.places)
    sure = [(sensor, reading) for sensor, reading in enumerate(sensed.sights) if isinstance(reading, int)]
    if len(sure) == 1:
        return (h.shown.get(sure[0]) or ())[-MOST:]
    alike = {number for key in sure for number in h.shown.get(key) or ()} if sure else h.places
    return tuple(sorted(alike))[-MOST:]


def leads(h: Hypothesis, number: int, place: Place, way: int) -> Lead:
    """Where an open way leads, as far as one place is more probable than any other.

    What a hypothesis takes for a place never seen may be a known one: that is left to folding, which weighs it.
    """
    chances, known = h.chances, place.ways[way]
    off = 1.0 / (h.size + 1.0)
    if known.walks:
        doubt = chances.relinked / (known.walks * known.walks)
        return Lead(known.to, 1.0 - doubt, 0.0, doubt * off)
    if known.to != NOWHERE:
        return Lead(known.to, chances.undone, 0.0, (1.0 - chances.undone) * off)
    if h.scheme.displacements is None:
        return _returns(h, place, way)
    beside = h.beside(place, way)
    elsewhere = chances.elsewhere
    if beside == NOWHERE:
        return Lead(NOWHERE, 0.0, 1.0 - elsewhere, elsewhere * off)
    assert h.scheme.inverse is not None
    back = h.places[beside].ways[h.scheme.inverse[way]]
    if back.walks and back.to != number:
        elsewhere = chances.undone
    return Lead(beside, 1.0 - elsewhere, 0.0, elsewhere * off)


def _returns(h: Hypothesis, place: Place, way: int) -> Lead:
    """Without poses: to where the way closes a square, as far as they do; or back to where the agent once came from,
    as far as actions were found to undo each other."""
    best = across(h, place, way) if h.chances.square > SQUARES else NOWHERE
    sure = 0.0 if best == NOWHERE else h.chances.square
    if h.scheme.inverse is None:
        for source, by in sorted(place.into):
            yes, no = h.undo.get((by, way), (0.0, 0.0))
            p = (yes + 0.3) / (yes + no + 0.3 * h.scheme.count)
            if p > sure:
                best, sure = source, p
    return Lead(best, min(sure, 0.98), (1.0 - min(sure, 0.98)) * h.chances.new, 0.0)


def strayed(h: Hypothesis, sensed: Sensed, crowd: Mapping[int, float], *, drop: float) -> Iterator[Alternative]:
    """The branches of a hypothesis whose map is known, but not where in it the agent is.

    One message over the places goes a step ahead; where few are left they are branches of their own, and so are new
    places that are entered from the most probable ones.
    """
    ahead: dict[int, float] = {}
    beyond: list[tuple[float, int]] = []
    for number, weight in crowd.items():
        for to, p in _ahead(h, number, sensed):
            if to == NOWHERE:
                beyond.append((weight + log(p), number))
            else:
                ahead[to] = ahead.get(to, 0.0) + p * exp(weight)
    found = {to: h.weight + log(p) + log_likelihood(h, to, sensed) for to, p in ahead.items() if p > 0.0}
    if found:
        total = log_sum(list(found.values()))
        kept = {to: weight - total for to, weight in found.items() if weight > total - FAINT}
        if len(kept) > CROWD:
            yield Alternative(total, h, NOWHERE, max(kept, key=kept.__getitem__), False, 0.0, 0.0, 0.0, kept)
        else:
            for to in kept:
                yield Alternative(found[to], h, NOWHERE, to, False, 0.0, 0.0, 0.0)
    for weight, number in nlargest(CROWD, beyond):
        parent = h.fork()
        parent.crowd, parent.here, parent.weight = None, number, h.weight + weight
        if sensed.action is not None and weight > -drop:
            yield Walker(parent, sensed).new(sensed.action, parent.weight, 0.0)


def _ahead(h: Hypothesis, number: int, sensed: Sensed) -> Iterator[tuple[int, float]]:
    """Where a step from a place may have led, if the action given was carried out; `NOWHERE` for a new place."""
    action, chances = sensed.action, h.chances
    stayed = exp(sensed.of_taking(NOWHERE))
    if action is None:
        yield number, stayed
        return
    place = h.places[number]
    walks = probability(way_odds(h, number, place, action)) * (1.0 - max(chances.fails, sensed.fails))
    lead = leads(h, number, place, action)
    yield number, (1.0 - walks) * stayed
    walks *= exp(sensed.of_taking(action))
    if lead.to != NOWHERE:
        yield lead.to, walks * lead.sure
    if lead.new > 0.0:
        yield NOWHERE, walks * lead.new
