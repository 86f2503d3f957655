"""Two places taken for one, and all that follows from it: state merging, weighed by the evidence."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import exp, inf, log
from typing import Any, NamedTuple

from .charts import Charts
from .evidence import before_reading, probability, way_odds
from .hypothesis import Hypothesis, Key
from .records import NOWHERE, RECENT, Place, SightCounts, Way

ATTEMPTS = 24
"""Pairs that one union tries to unite because of contradicting links; there may be exponentially many."""


class Fork(NamedTuple):
    """A way that leads to two places: `kept`, and `other`, where it led `walks` times."""

    number: int
    way: int
    kept: int
    other: int
    walks: int


class ContradictionError(Exception):
    """The places cannot be one, as far as anything is known here."""


class Union:
    """Classes of places that are one, and how much more probable that makes what was read.

    A place that leads by one action to two places makes these one as well, or else the link that was walked less was
    something else; two places at one position of a chart are one.

    Attributes:
        h: the hypothesis; it is not changed.
        gain: about log P(readings | united) - log P(readings | apart); what is below the floor is given up early.
        sights: the part of it that sights have, which is exact.
        cost: of links that were given up.
        classes: the records of united places, by their first one.
        charts: where places are, with the charts as they are when united.
        moved, astray: walks that were something else, if this is so.
    """

    def __init__(self, h: Hypothesis, *, floor: float) -> None:
        self.h, self._floor = h, floor
        self.gain = self.sights = self.cost = self.moved = self.astray = 0.0
        self.classes: dict[int, Place] = {}
        self.charts = Charts(h)
        self._attempts = 0
        self._first: dict[int, int] = {}
        self._pairs: list[tuple[int, int]] = []
        self._coincide: Iterator[tuple[int, int]] = iter(())
        self._forks: list[Fork] = []

    def find(self, number: int) -> int:
        """The place that stands for the class of one."""
        first = self._first
        while number in first:
            number = first[number]
        return number

    def view(self, number: int) -> Place:
        """The record of a place as it is when united."""
        number = self.find(number)
        return self.classes.get(number) or self.h.places[number]

    def members(self) -> set[int]:
        """Every place that is one with another."""
        return {*self.classes, *self._first}

    def gone(self) -> Iterable[int]:
        """The places that others stand for."""
        return self._first

    def key(self, number: int) -> Key:
        """Frame and position of a place."""
        return self.charts.key(self.find(number))

    def beside(self, number: int, way: int) -> int:
        """The place that poses say is beyond a way."""
        found = self.charts.beside(self.find(number), way)
        return NOWHERE if found == NOWHERE else self.find(found)

    def unite(self, one: int, other: int, *, period: bool = False) -> None:
        """Take two places for one.

        Args:
            one, other: the places.
            period: if they are in one chart, it closes on itself; otherwise only the ways that lead there do.

        Raises:
            ContradictionError: the readings become too improbable.
        """
        if self.h.scheme.displacements is not None:
            self._coincide = self.charts.overlay(one, other, period=period)
        self._pairs.append((one, other))
        self._follow()

    def _follow(self) -> None:
        """Unite what has to be, and then, of links that contradict each other, both ends or neither."""
        while True:
            if pair := self._pairs.pop() if self._pairs else next(self._coincide, None):
                a, b = (self.find(number) for number in pair)
                if a != b:
                    self._merge(min(a, b), max(a, b))
                    if self.gain < self._floor:
                        raise ContradictionError
            elif self._forks:
                self._settle(self._forks.pop())
            else:
                return

    def _settle(self, fork: Fork) -> None:
        """One way leads to two places: they are one, or the walks along one of the two links were something else."""
        kept, other = self.find(fork.kept), self.find(fork.other)
        if kept == other or self._attempt((kept, other), self._cost_of_moves(fork)):
            return
        number = self.find(fork.number)
        astray = fork.walks * -log(self.h.chances.astray / len(self.h.awake)) if fork.walks else inf
        for end in [number, *(self.find(way.to) for way in self.view(number).ways if way.to != NOWHERE)]:
            fits = end == other or self.view(end).label() == self.view(other).label()
            if fits and end != kept and astray < self._cost_of_moves(fork):
                cost = fork.walks * -log(self.h.chances.fails) if end == number else astray
                if self._attempt((end, other), self._cost_of_moves(fork) - cost):
                    self._give_up(fork, cost)
                    self.astray += fork.walks
                    return
        self._give_up(fork, self._cost_of_moves(fork))
        self.moved += fork.walks

    def _attempt(self, pair: tuple[int, int], worth: float) -> bool:
        """Unite a pair, and all that follows from it, unless that makes the readings less probable by `worth`."""
        if self._attempts >= ATTEMPTS:
            return False
        self._attempts += 1
        saved, floor = self._state(), self._floor
        self._floor = max(floor, self.gain - worth)
        self._pairs, self._forks = [pair], []
        try:
            self._follow()
        except ContradictionError:
            self._restore(saved)
            self._floor = floor
            return False
        self._pairs, self._forks = saved[-2:]
        self._floor = floor
        return True

    def _give_up(self, fork: Fork, cost: float) -> None:
        self._cut(self.find(fork.number), fork)
        self.gain -= cost
        self.cost += cost
        if self.gain < self._floor:
            raise ContradictionError

    def _state(self) -> tuple[Any, ...]:
        return (
            self.gain, self.sights, self.cost, self.moved, self.astray, self.classes.copy(), self._first.copy(),
            self._pairs, self._forks,
        )  # fmt: skip

    def _restore(self, saved: tuple[Any, ...]) -> None:
        self.gain, self.sights, self.cost, self.moved, self.astray = saved[:5]
        self.classes, self._first, self._pairs, self._forks = saved[5:]

    def _cost_of_moves(self, fork: Fork) -> float:
        """-log P(the walks along the link that is given up were silent moves)."""
        chances = self.h.chances
        if not fork.walks:
            return -log(1.0 - chances.undone)
        return -fork.walks * log(chances.moved / self.h.size)

    def _cut(self, number: int, fork: Fork) -> None:
        """Forget a link: the way leads to `kept`, and nothing is known from it of the way back."""
        other = self.find(fork.other)
        place = self.view(other)
        into = frozenset(
            (source, index) for source, index in place.into if index != fork.way or self.find(source) != number
        )
        ways = list(place.ways)
        if self.h.scheme.inverse is not None:
            back = self.h.scheme.inverse[fork.way]
            way = ways[back]
            if way.to != NOWHERE and self.find(way.to) == number and not way.walks:
                ways[back] = way._replace(to=NOWHERE)
        self.classes[other] = Place(
            place.sights, tuple(ways), place.frame, place.position, place.recent, into, place.share
        )

    def _merge(self, first: int, second: int) -> None:
        a, b = self.view(first), self.view(second)
        for sensor, (mine, its) in enumerate(zip(a.sights, b.sights, strict=True)):
            gained = sights_gain(self.h, sensor, mine, its)
            self.sights += gained
            self.gain += gained
        ways = list(a.ways)
        for index in self.h.awake:
            self.gain += self._ways_gain(first, a, second, b, index)
            ways[index] = self._one_way(first, index, a.ways[index], b.ways[index])
        recent = tuple(sorted({*a.recent, *b.recent}))[-RECENT:]
        sights = tuple(_sum(mine, its) for mine, its in zip(a.sights, b.sights, strict=True))
        self._first[second] = first
        self.classes.pop(second, None)
        self.classes[first] = Place(sights, tuple(ways), a.frame, a.position, recent, a.into | b.into, a.share)

    def _one_way(self, number: int, index: int, mine: Way, its: Way) -> Way:
        net = mine.net + its.net  # bounds are for the place when it is built: here they would lose evidence
        opened, blocked, stays = mine.open + its.open, mine.blocked + its.blocked, mine.stays + its.stays
        if mine.to == NOWHERE or its.to == NOWHERE or self.find(mine.to) == self.find(its.to):
            to = its.to if mine.to == NOWHERE else mine.to
            return Way(net, opened, blocked, mine.walks + its.walks, to, stays)
        kept, other = (mine, its) if mine.walks >= its.walks else (its, mine)
        self._forks.append(Fork(number, index, kept.to, other.to, other.walks))
        return Way(net, opened, blocked, kept.walks, kept.to, stays)

    def _ways_gain(self, first: int, a: Place, second: int, b: Place, index: int) -> float:
        """log Σ_s P(s | a) P(b's | s) - log Σ_s P(s) P(b's | s), s being open or blocked, b's what was read in b.

        Half of it where both sides of the door are united.
        """
        mine, its = a.ways[index], b.ways[index]
        if not (mine.net or mine.to != NOWHERE) or not (its.net or its.to != NOWHERE):
            return 0.0
        open_ = self.h.open(index)
        p, q = probability(self._odds(first, a, index)), probability(self._odds(second, b, index))
        as_open, as_blocked = q / open_, (1.0 - q) / (1.0 - open_)
        before = before_reading(self.h, second, b, index, self.view, self.find)
        gain = log((p * as_open + (1.0 - p) * as_blocked) / (before * as_open + (1.0 - before) * as_blocked))
        both = mine.to != NOWHERE and its.to != NOWHERE and self.h.scheme.inverse is not None
        return 0.5 * gain if both and gain > 0.0 else gain

    def _odds(self, number: int, place: Place, index: int) -> float:
        if number in self.classes:
            chances = self.h.chances
            odds = chances.odds + place.ways[index].net * chances.unit
            return min(max(odds, -chances.limit), chances.limit)
        return way_odds(self.h, number, place, index)


def sights_gain(h: Hypothesis, sensor: int, mine: SightCounts, its: SightCounts) -> float:
    """log P(both counts | one label) - log P(each | its own): what the labels are is left to the seating."""
    if not mine or not its:
        return 0.0
    unit, labels = h.chances.sight_unit[sensor], h.chances.labels[sensor]
    both = _sum(mine, its)
    return _log_sum(both, unit, labels) - _log_sum(mine, unit, labels) - _log_sum(its, unit, labels)


def _log_sum(counts: SightCounts, unit: float, labels: int) -> float:
    """log Σ_l exp(unit · counts[l])."""
    most = max(counts.values())
    rest = max(labels - len(counts), 0) * exp(-unit * most)
    return unit * most + log(rest + sum(exp(unit * (count - most)) for count in counts.values()))


def _sum(mine: SightCounts, its: SightCounts) -> SightCounts:
    return {label: mine.get(label, 0.0) + its.get(label, 0.0) for label in {**mine, **its}}
