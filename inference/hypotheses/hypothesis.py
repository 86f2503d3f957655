"""One hypothesis about the map: which visits were to the same place, and what is known of each place."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from operator import add

from ...model import FEW_WAYS, Periods, reduced
from .chances import Chances
from .layered import Layered
from .rates import BESIDE, OPEN, SIGHT_MISREAD, STAYED, UNDONE, WAY_MISREAD, RateCounts
from .records import NOWHERE, Place, Position, Share
from .scheme import Sensed, WayScheme
from .squares import across

SHARES = (
    (OPEN, True), (OPEN, False), (WAY_MISREAD, True), (WAY_MISREAD, False), (SIGHT_MISREAD, True),
    (SIGHT_MISREAD, False), (BESIDE, True), (BESIDE, False), (UNDONE, True), (UNDONE, False), (STAYED, True),
    (STAYED, False),
)  # fmt: skip
"""Which rate each part of a share counts for, and whether as true."""

SQUARES = 0.6
"""Rate of squares that close from which on a way is taken to lead where it closes one."""

OWN = 2.0
"""Looks at one way that count as much as all looks at any way."""

EVEN, ROUND = 1.0, 0.25
"""Concentration of what is taken instead of the way given, before anything was seen of it: of each way, and of the one
that leads back. A slip seldom turns round: without that, a map that is turned would explain a slippery world as well.
"""

Key = tuple[int, Position]
Label = tuple[int, int]


class Hypothesis:
    """A hypothesis: a map, the agent's place in it, and the counts of its rates.

    Attributes:
        scheme: what is known of ways beforehand.
        places: by number; the number of a place is the time it was first visited.
        at: the place at (frame, position).
        shown: the places that most probably have a sight, by (sensor, label).
        kinds: how many different sights they have, a sensor each.
        counts: of the rates.
        slips: how often another way than the one given was taken, by (given, taken); by (given, given) how often any
            was; `NOWHERE` stands for staying.
        undo: (times it did, times it did not) that an action led back, by (action, action after it); counted where
            it is not known beforehand which do.
        periods: of the charts that close on themselves, by frame.
        looks: times each way was read open and blocked at first visits of places.
        here: the place the agent is in.
        crowd: where the agent may be, with log probabilities, if that is open in this map: `here` is the likeliest, and
            nothing is learned of places; None otherwise.
        weight: log posterior weight.
        digest: the same for maps that are the same, whatever their places are numbered; hardly ever for others.
        laid: number of places in each chart that has positions, and the sums of their coordinates.
        size, links: number of places, and of ways between them (both directions are one).
        chances: the rates expected at this step.
        origin: the hypothesis before the last step, if this one only extends it.
        apart: it says of some place that it is not where the pose says; that may be all that it differs in.
        awake: the ways that are thought of: where there are many, those that were ever open, or not read.
        touched: numbers of the records changed since it was forked.
        clan: the same of those that go back to one hypothesis at the last time that was decided.
    """

    __slots__ = (
        "apart", "at", "awake", "chances", "clan", "counts", "crowd", "digest", "here", "kinds", "laid", "links",
        "looks", "origin", "periods", "places", "scheme", "shown", "size", "slips", "touched", "undo", "weight",
    )  # fmt: skip

    def __init__(self, scheme: WayScheme) -> None:
        self.scheme = scheme
        self.places: Layered[int, Place] = Layered()
        self.at: Layered[Key, int] = Layered()
        self.shown: Layered[Label, tuple[int, ...]] = Layered()
        self.kinds = [0] * scheme.sensors
        self.counts = RateCounts()
        self.periods: dict[int, Periods] = {}
        self.slips: dict[tuple[int, int], float] = {}
        self.undo: dict[tuple[int, int], tuple[float, float]] = {}
        self.looks = [(0.0, 0.0)] * scheme.count
        self.laid: dict[int, Position] = {}
        self.here = NOWHERE
        self.weight = 0.0
        self.size = self.links = self.digest = 0
        self.origin: Hypothesis | None = None
        self.apart, self.clan = False, 0
        self.awake = awake_ways(scheme)
        self.crowd: Mapping[int, float] | None = None
        self.touched: dict[int, None] = {}
        self.chances = Chances(self.counts, [1] * scheme.sensors)

    def fork(self) -> Hypothesis:
        """One that goes its own way from now on."""
        other = Hypothesis.__new__(Hypothesis)
        other.scheme, other.chances = self.scheme, self.chances
        other.places, other.at, other.shown = self.places.fork(), self.at.fork(), self.shown.fork()
        other.kinds, other.counts, other.periods = self.kinds.copy(), self.counts.copy(), self.periods.copy()
        other.slips, other.undo, other.looks = self.slips.copy(), self.undo.copy(), self.looks.copy()
        other.laid = self.laid.copy()
        other.here, other.weight, other.size, other.links = self.here, self.weight, self.size, self.links
        other.origin, other.touched, other.digest = None, {}, self.digest
        other.apart, other.crowd, other.clan = self.apart, self.crowd, self.clan
        other.awake = self.awake
        return other

    def emptied(self) -> Hypothesis:
        """One that goes on from nothing, in the same layers."""
        other, new = self.fork(), Hypothesis(self.scheme)
        for number in list(other.places):
            other.remove(number)
        for name in ("counts", "periods", "slips", "undo", "looks", "here", "weight", "links", "apart", "crowd"):
            setattr(other, name, getattr(new, name))
        other.digest, other.chances = 0, Chances(other.counts, self.chances.labels)
        return other

    @property
    def marks(self) -> tuple[int, int, int]:
        """The state of the shared layers, for `as_of`."""
        return self.places.mark, self.at.mark, self.shown.mark

    def as_of(self, marks: tuple[int, int, int]) -> Hypothesis | None:
        """A fork as it was when these were its marks, whatever was settled since; None where that is forgotten."""
        places, at, shown = self.places.as_of(marks[0]), self.at.as_of(marks[1]), self.shown.as_of(marks[2])
        if places is None or at is None or shown is None:
            return None
        other = self.fork()
        other.places, other.at, other.shown = places, at, shown
        return other

    def settle(self) -> None:
        """Make its entries the shared ones; only for the last one of its kind."""
        self.places.settle()
        self.at.settle()
        self.shown.settle()

    # -- reading -------------------------------------------------------------------------------------------

    def open(self, way: int) -> float:
        """P(a way is open) of a place of which nothing is known: some ways are open more often than others."""
        opened, blocked = self.looks[way]
        return (opened + OWN * self.chances.open) / (opened + blocked + OWN)

    def slip(self, given: int, taken: int) -> float:
        """P(a way is taken | another than the one given is): a Dirichlet a way given, that all places share.

        To stay is taken no oftener than evenly: whatever keeps the agent where it is beyond that is a move that failed.
        """
        count = max(len(self.awake), 1)  # the others are never taken
        if not (slips := self.slips.get((given, given))):
            return 1.0 / count
        total, even = slips + EVEN * (count - 1) + ROUND, 1.0 / count
        stays = 0.0 if given == NOWHERE else (self.slips.get((given, NOWHERE), 0.0) + EVEN) / total
        if taken == NOWHERE:
            return min(stays, even)
        inverse = self.scheme.inverse
        turns = taken >= 0 <= given and inverse is not None and inverse[given] == taken != given
        p = (self.slips.get((given, taken), 0.0) + (ROUND if turns else EVEN)) / total
        return p * (1.0 - even) / (1.0 - stays) if stays > even else p

    def slipped(self, given: int, taken: int, weight: float) -> None:
        """Count that another way than the one given was taken."""
        for key in ((given, taken), (given, given)):
            self.slips[key] = self.slips.get(key, 0.0) + weight

    def wake(self, ways: tuple[int, ...]) -> None:
        """Think of these ways; those that it did not think of were read blocked in every place so far."""
        if ways is not self.awake:
            for way in set(ways).difference(self.awake):
                self.looks[way] = 0.0, float(self.size)
            self.awake = ways

    def beyond(self, place: Place, way: int) -> Key | None:
        """The (frame, position) that a way leads to as far as poses say; None without poses."""
        displacements = self.scheme.displacements
        if displacements is None:
            return None
        position = tuple(map(add, place.position, displacements[way]))
        periods = self.periods.get(place.frame) if self.periods else None
        return place.frame, reduced(position, periods) if periods else position

    def canonical(self, frame: int, position: Sequence[int]) -> Key:
        """The one key of a position, which may be many in a chart that closes on itself."""
        periods = self.periods.get(frame)
        return frame, reduced(position, periods) if periods else tuple(position)

    def beside(self, place: Place, way: int) -> int:
        """The place that poses say is beyond a way; `NOWHERE` if none was ever visited there."""
        key = self.beyond(place, way)
        found = None if key is None else self.at.get(key)
        return NOWHERE if found is None else found

    def neighbour(self, place: Place, way: int) -> int:
        """The place beyond a way: where it was found to lead, else where poses say, or else squares."""
        to = place.ways[way].to
        if to != NOWHERE:
            return to
        if self.scheme.displacements is None:
            return across(self, place, way) if self.chances.square > SQUARES else NOWHERE
        return self.beside(place, way)

    # -- writing -------------------------------------------------------------------------------------------

    def put(self, number: int, place: Place) -> None:
        """Replace the record of a place, and count what it shares anew."""
        before = self.places.get(number)
        if before is None:
            self.size += 1
            if place.position:
                self.at[place.frame, place.position] = number
                self.lay(place, 1)
            self._count(place, 1.0)
            self.digest += digest(place, self.awake)
        else:
            self._recount(before.share, place.share)
            if before.position is not place.position or before.frame != place.frame:
                self.lay(before, -1)
                self.lay(place, 1)
            if before.ways is not place.ways or before.sights is not place.sights:
                self.digest += digest(place, self.awake) - digest(before, self.awake)
        if before is None or before.sights is not place.sights:
            for sensor in range(self.scheme.sensors):
                was, now = -1 if before is None else before.label(sensor), place.label(sensor)
                if was != now:
                    self._relabel(sensor, number, was, now)
        self.places[number] = place
        self.touched[number] = None

    def remove(self, number: int) -> None:
        """Take a place away."""
        self._count(self.places[number], -1.0)
        self.forget(number)

    def forget(self, number: int) -> None:
        """Take a place away; what it shares stays counted."""
        place = self.places[number]
        self.lay(place, -1)
        self.digest -= digest(place, self.awake)
        for sensor in range(self.scheme.sensors):
            self._relabel(sensor, number, place.label(sensor), -1)
        if place.position and self.at.get((place.frame, place.position)) == number:
            del self.at[place.frame, place.position]
        del self.places[number]
        self.size -= 1

    def lay(self, place: Place | None, sign: int) -> None:
        """Count a place among those of its chart, or no more."""
        if place is not None and place.position:
            more = (1, *place.position)
            before = self.laid.get(place.frame, (0,) * len(more))
            self.laid[place.frame] = tuple([x + sign * y for x, y in zip(before, more, strict=True)])
            if not self.laid[place.frame][0]:
                del self.laid[place.frame]  # nothing lies in it any more

    def _count(self, place: Place, sign: float) -> None:
        yes, no = self.counts.yes, self.counts.no
        for (rate, true), value in zip(SHARES, place.share, strict=True):
            (yes if true else no)[rate] += sign * value

    def _recount(self, before: Share, after: Share) -> None:
        if before is after:
            return
        yes, no = self.counts.yes, self.counts.no
        for (rate, true), was, now in zip(SHARES, before, after, strict=True):
            (yes if true else no)[rate] += now - was

    def _relabel(self, sensor: int, number: int, was: int, now: int) -> None:
        if was >= 0:
            rest = tuple(k for k in self.shown[sensor, was] if k != number)
            if rest:
                self.shown[sensor, was] = rest
            else:
                del self.shown[sensor, was]
            self.kinds[sensor] -= not rest
        if now >= 0:
            others = self.shown.get((sensor, now)) or ()
            self.shown[sensor, now] = (*others, number)
            self.kinds[sensor] += not others


def awake_ways(scheme: WayScheme, known: tuple[int, ...] = (), sensed: Sensed | None = None) -> tuple[int, ...]:
    """The ways that are thought of.

    Of a long list of actions most may never be open. What they say of a place is the same of all places, and were they
    weighed, each place would be expected to have some of them open. So they are left out until they are first read as
    anything but blocked, are not read, or are to be taken.

    Args:
        scheme: the ways.
        known: those that were thought of so far.
        sensed: what is sensed now.
    """
    if scheme.count <= FEW_WAYS:
        return tuple(range(scheme.count))
    if sensed is None:
        return known
    now = {way for way, reading in enumerate(sensed.ways) if reading != 0.0 or way == sensed.action}
    return known if now <= set(known) else with_reverse(scheme, now.union(known))


def with_reverse(scheme: WayScheme, ways: Collection[int]) -> tuple[int, ...]:
    """These ways and those that undo them: who knows where one leads knows where the other does."""
    back = () if scheme.inverse is None else (scheme.inverse[way] for way in ways)
    return tuple(sorted({*ways, *back}))


def settle_alike(hypotheses: Sequence[Hypothesis]) -> None:
    """Share what hypotheses have in common."""
    Layered.settle_alike([h.places for h in hypotheses])
    Layered.settle_alike([h.at for h in hypotheses])
    Layered.settle_alike([h.shown for h in hypotheses])


def digest(place: Place, awake: Iterable[int]) -> int:
    """What a place adds to the digest of its map; no way that nobody thinks of leads anywhere."""
    ways = place.ways
    return hash((place.label(), *[way for way in awake if ways[way].to != NOWHERE]))
