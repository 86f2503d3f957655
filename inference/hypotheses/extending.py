"""A hypothesis one step further: one branch carried out on its map."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from math import log

from ...model import SHOWN
from .branches import Alternative, once_read, slips_into_staying
from .chances import Chances
from .evidence import count_alike, label_shares, odds_beyond, probability, same_door, was_rebuilt, way_odds
from .hypothesis import Hypothesis
from .rates import ASTRAY, CHANGED, ELSEWHERE, FAILS, MEETING, MOVED, NEW, RELINKED, SQUARE, UNDONE
from .records import NOWHERE, RECENT, Place, Share, SightCounts, Way
from .scheme import Reading, Sensed
from .squares import across, around, tally

SHUT = Way(-1.0, 0.0, 1.0)
"""What is known of a way that nobody thinks of: it was read blocked."""


def begin(h: Hypothesis, sensed: Sensed, time: int) -> None:
    """Put the agent into the first place."""
    _place_new(h, time, frame=time, position=h.scheme.origin)
    _look(h, time, sensed, time)


def extend(h: Hypothesis, branch: Alternative, sensed: Sensed, time: int) -> None:
    """Carry out `branch` on `h`, which becomes what the branch says."""
    here, to, lost = h.here, branch.to, h.crowd is not None
    h.weight, h.crowd = branch.weight, branch.crowd
    if not sensed.told and not lost:
        _count_how(h, branch, sensed)
    if branch.crowd is not None:
        h.here = to
        return
    if stays := branch.way == NOWHERE and to == here and not sensed.told and not lost:
        _bump(h, branch, sensed)
    if to == NOWHERE:
        to = time
        key = h.beyond(h.places[here], branch.way) if branch.charted else None
        frame, position = key or (time, h.scheme.origin)
        h.apart = h.apart or not branch.charted
        if branch.way != NOWHERE:
            back = None if h.scheme.inverse is None else h.scheme.inverse[branch.way]
            count_alike(h, sensed, key, back, here)
        _place_new(h, to, frame=frame, position=position)
    if branch.way != NOWHERE:
        _walk(h, here, branch.way, to, branch)
    _look(h, to, sensed, time)
    if stays:
        h.counts.blame()


def _place_new(h: Hypothesis, number: int, *, frame: int, position: tuple[int, ...]) -> None:
    scheme = h.scheme
    sights: tuple[SightCounts, ...] = ({},) * scheme.sensors
    h.put(number, Place(sights, _unread(scheme.count, h.awake), frame, position, (), frozenset(), Share()))


@lru_cache(maxsize=64)
def _unread(count: int, awake: tuple[int, ...]) -> tuple[Way, ...]:
    """The ways of a place never seen, as one that all such places share: those that nobody thinks of are shut."""
    return tuple(Way() if way in awake else SHUT for way in range(count))


def _count_how(h: Hypothesis, branch: Alternative, sensed: Sensed) -> None:
    yes, no = h.counts.yes, h.counts.no
    kept = 1.0 - branch.moved
    yes[MOVED] += branch.moved
    no[MOVED] += kept
    if branch.way == NOWHERE and branch.to == h.here and _unexplained(sensed):
        _count_walls(h, sensed, kept)
        return
    if branch.astray and branch.way != NOWHERE:
        h.slipped(NOWHERE if sensed.action is None else sensed.action, branch.way, branch.astray)
    yes[ASTRAY] += branch.astray
    no[ASTRAY] += kept - branch.astray
    yes[FAILS] += branch.failed
    no[FAILS] += kept * (branch.way != NOWHERE)


def _count_walls(h: Hypothesis, sensed: Sensed, weight: float) -> None:
    """A move did not lead on: another way may have been taken that is shut, as far as the one given is open."""
    given, place, chances = sensed.action, h.places[h.here], h.chances
    if given is None:
        return
    fails, astray = chances.fails, chances.astray
    opened = {way: probability(way_odds(h, h.here, place, way)) for way in h.awake}
    stays = {way: 1.0 - once_read(chances, p, sensed.ways[way]) * (1.0 - fails) for way, p in opened.items()}
    own = stays.pop(given, 1.0) * (1.0 - astray)
    others = {way: astray * h.slip(given, way) * p for way, p in (stays | {NOWHERE: 1.0}).items()}
    total = weight / (own + sum(others.values()))
    for way, p in others.items():
        h.slipped(given, way, total * p)


def _unexplained(sensed: Sensed) -> bool:
    """Whether nothing says why a move did not lead on."""
    return sensed.action is not None and not sensed.certain and not sensed.fails


def _bump(h: Hypothesis, branch: Alternative, sensed: Sensed) -> None:
    """It stayed where it is: log P(stays | open) / P(stays | blocked), in readings."""
    way, chances, place = sensed.action, h.chances, h.places[h.here]
    if way is None:
        return
    astray = 0.0 if sensed.certain else chances.astray
    given, lost = 1.0 - astray, astray * 0.5
    worth = log((given * max(chances.fails, sensed.fails) + lost) / (given + lost)) / chances.unit
    known = place.ways[way]
    net = max(known.net + worth, -chances.most)
    stays = known.stays + (1.0 - branch.moved) * _unexplained(sensed)
    h.put(h.here, with_way(place, way, known._replace(net=net, stays=stays)))


def with_way(place: Place, index: int, way: Way) -> Place:
    """The place with one of its ways replaced."""
    ways = (*place.ways[:index], way, *place.ways[index + 1 :])
    return Place(place.sights, ways, place.frame, place.position, place.recent, place.into, place.share)


def _walk(h: Hypothesis, here: int, index: int, to: int, branch: Alternative) -> None:
    place = h.places[here]
    way = place.ways[index]
    if h.scheme.displacements is None and way.to != to:
        with _squares(h, (here, to)):
            _lead(h, here, index, to, branch)
    else:
        _lead(h, here, index, to, branch)


def _lead(h: Hypothesis, here: int, index: int, to: int, branch: Alternative) -> None:
    place = h.places[here]
    way = place.ways[index]
    if way.walks:
        h.counts.yes[RELINKED] += way.to != to
        h.counts.no[RELINKED] += (way.to == to) / (way.walks * way.walks)
    if way.to not in (NOWHERE, to):
        _relink(h, here, index, to, branch)
        way = way._replace(walks=0, to=NOWHERE)
    elif way.to == NOWHERE:
        _count_link(h, place, index, to, branch)
    if not way.walks and h.scheme.inverse is None:
        _count_returns(h, place, index, to)
    net = max(way.net, h.chances.most)
    walked = Way(net, way.open, way.blocked, way.walks + 1, to, way.stays)
    if to == here or (here, index) not in h.places[to].into:
        h.put(here, with_way(h.places[here], index, walked))
        _arrive(h, here, index, to)
        h.put(here, shared(h, here, h.places[here]))
    else:
        h.put(here, shared(h, here, with_way(h.places[here], index, walked)))


def _relink(h: Hypothesis, here: int, index: int, to: int, branch: Alternative) -> None:
    """A way leads elsewhere than was thought: the link there was is gone, or leads here only."""
    place, inverse = h.places[here], h.scheme.inverse
    way = place.ways[index]
    if inverse is not None and (back := h.places[way.to].ways[inverse[index]]).walks and back.to == here:
        h.counts.no[UNDONE] += not way.walks
        h.links += 1  # that it leads off the chart says no more than that it does not lead back
    elif h.scheme.displacements is not None:
        off = float(h.beside(place, index) != way.to)
        h.links -= 1
        h.counts.yes[ELSEWHERE] = max(h.counts.yes[ELSEWHERE] - off, 0.0)
        h.counts.no[ELSEWHERE] = max(h.counts.no[ELSEWHERE] - 1.0 + off, 0.0)
        _count_link(h, place, index, to, branch)
    unlink(h, here, index, way)


@contextmanager
def _squares(h: Hypothesis, numbers: Sequence[int]) -> Generator[None]:
    """Count the squares that close, or do not, by what is done within to the ways of some places."""
    centres = around(h, numbers)
    before = tally(h, centres)
    yield
    after = tally(h, centres)
    for counts, was, now in zip((h.counts.yes, h.counts.no), before, after, strict=True):
        counts[SQUARE] = max(counts[SQUARE] + now - was, 0.0)


def _arrive(h: Hypothesis, here: int, index: int, to: int) -> None:
    place = h.places[to]
    into = place.into | {(here, index)}
    ways = place.ways
    if h.scheme.inverse is not None:
        back = h.scheme.inverse[index]
        if ways[back].to == NOWHERE:
            ways = (*ways[:back], ways[back]._replace(to=here), *ways[back + 1 :])
        elif ways[back].walks:
            led_back = ways[back].to == here
            h.counts.yes[UNDONE] += led_back and (here, index) not in place.into
            h.counts.no[UNDONE] += not led_back and (here, index) not in place.into
    h.put(to, Place(place.sights, ways, place.frame, place.position, place.recent, into, place.share))


def unlink(h: Hypothesis, here: int, index: int, way: Way) -> None:
    """A way leads elsewhere than was thought: its way back is not known from it any more."""
    old = h.places.get(way.to)
    if old is None:
        return
    ways = old.ways
    if h.scheme.inverse is not None:
        back = h.scheme.inverse[index]
        if ways[back].to == here and not ways[back].walks:
            ways = (*ways[:back], ways[back]._replace(to=NOWHERE), *ways[back + 1 :])
    into = old.into - {(here, index)}
    h.put(way.to, Place(old.sights, ways, old.frame, old.position, old.recent, into, old.share))


def _count_link(h: Hypothesis, place: Place, index: int, to: int, branch: Alternative) -> None:
    h.links += 1
    new = branch.to == NOWHERE
    if h.scheme.inverse is None:
        meets = any(by == index for _, by in h.places[to].into)
        h.counts.yes[MEETING] += meets
        h.counts.no[MEETING] += not meets
    if h.scheme.displacements is None:
        h.counts.yes[NEW] += new
        h.counts.no[NEW] += not new and across(h, place, index) != to
        return
    off = not branch.charted if new else h.beside(place, index) != to
    h.counts.yes[ELSEWHERE] += off
    h.counts.no[ELSEWHERE] += not off


def _count_returns(h: Hypothesis, place: Place, index: int, to: int) -> None:
    for source, by in place.into:
        yes, no = h.undo.get((by, index), (0.0, 0.0))
        h.undo[by, index] = (yes + 1.0, no) if source == to else (yes, no + 1.0)


def _look(h: Hypothesis, number: int, sensed: Sensed, time: int) -> None:
    place, chances = h.places[number], h.chances
    sights = tuple(
        seen(chances, sensor, counts, reading)
        for sensor, (counts, reading) in enumerate(zip(place.sights, sensed.sights, strict=True))
    )
    rebuilt = bool(place.recent) and was_rebuilt(h, number, place, sensed)
    ways = list(place.ways)
    for index in h.awake:
        reading, way = sensed.ways[index], place.ways[index]
        if reading is not None:
            before = way._replace(net=0.0, open=0.0, blocked=0.0, stays=0.0) if rebuilt else way
            ways[index] = _read(h, before, reading)
        else:
            ways[index] = way
    if not place.recent:
        _count_looks(h, sensed)
    recent = (*place.recent[-RECENT + 1 :], time)
    looked = Place(sights, tuple(ways), place.frame, place.position, recent, place.into, place.share)
    h.here = number
    _turn(h, place, ways)
    h.put(number, shared(h, number, looked))


def _turn(h: Hypothesis, before: Place, ways: Sequence[Way]) -> None:
    """A door that was found to have changed has changed on its other side too."""
    if h.scheme.inverse is None:
        return
    for index in h.awake:
        old, new = before.ways[index], ways[index]
        if old.net * new.net < 0.0 and (other := h.neighbour(before, index)) != NOWHERE:
            there, back = h.places[other], h.scheme.inverse[index]
            if there.ways[back].net * new.net < 0.0:
                h.put(other, with_way(there, back, there.ways[back]._replace(net=new.net)))


def _count_looks(h: Hypothesis, sensed: Sensed) -> None:
    """What a place never seen before says of how often each way is open."""
    for way in h.awake:
        if (reading := sensed.ways[way]) is not None:
            opened, blocked = h.looks[way]
            h.looks[way] = opened + reading, blocked + 1.0 - reading


def seen(chances: Chances, sensor: int, counts: SightCounts, reading: Reading) -> SightCounts:
    """The counts of a place after one more reading; of likelihoods each label counts as the readings it is worth.

    That is log P(reading | label) beyond that of a label which is not named, over what one sure reading is worth.
    """
    if reading is None:
        return counts
    if isinstance(reading, int):
        return _bounded({**counts, reading: counts.get(reading, 0.0) + 1.0}, reading)
    misread, right = chances.misread[sensor], chances.right[sensor]
    other, more = misread * sum(reading.values()), dict(counts)
    for label, likelihood in reading.items():
        worth = log(1.0 + (right - misread) * likelihood / other) / chances.sight_unit[sensor]
        if worth > 1e-3:
            more[label] = more.get(label, 0.0) + worth
    return _bounded(more)


def _bounded(counts: SightCounts, last: int | None = None) -> SightCounts:
    """The counts without the least of them, where they are too many; the label that was read last stays."""
    while len(counts) > SHOWN:
        del counts[min((label for label in counts if label != last), key=counts.__getitem__)]
    return counts


def _read(h: Hypothesis, way: Way, reading: float) -> Way:
    """One more reading; where the ways that were read open last contradict all that was read before, it has changed."""
    chances = h.chances
    most = max(chances.most, 0.5)
    net = min(max(way.net + _worth(chances, reading), -most), most)
    opened, blocked = way.open + reading, way.blocked + 1.0 - reading
    changed = net * (opened - blocked) < 0.0 and abs(opened - blocked) > 1.0
    h.counts.yes[CHANGED] += changed
    h.counts.no[CHANGED] += not changed
    if changed:
        opened, blocked = max(net, 0.0), max(-net, 0.0)
    return Way(net, opened, blocked, way.walks, way.to, 0.0 if changed else way.stays)


def _worth(chances: Chances, reading: float) -> float:
    """What a reading is worth in readings that are sure: log P(it | open) / P(it | blocked)."""
    if reading in (0.0, 1.0):
        return 2.0 * reading - 1.0
    as_open = reading * (1.0 - chances.wrong) + (1.0 - reading) * chances.wrong
    return log(as_open / (1.0 - as_open)) / chances.unit


def shared(h: Hypothesis, number: int, place: Place) -> Place:
    """The place with what it adds to the counts of the rates worked out anew.

    A door between two places is shared by both: each adds half of it.
    """
    opened, blocked, wrong, right, beside, shut, undone, one_way = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    chances = h.chances
    for index in h.awake:
        way = place.ways[index]
        other = way.to if way.to != NOWHERE else h.neighbour(place, index)
        known = other != NOWHERE
        odds = odds_beyond(h, number, way.net, index, other)
        if way.net or odds != (chances.beside if known else chances.odds):
            p = probability(odds)
            half = 0.5 if h.scheme.inverse is not None and known else 1.0
            opened += half * p
            blocked += half * (1.0 - p)
            beside += half * p * known
            shut += half * (1.0 - p) * known
            if not way.open % 1.0 or not _whole(way.open + way.blocked):
                wrong += p * way.blocked + (1.0 - p) * way.open
                right += p * way.open + (1.0 - p) * way.blocked
            if known and number != other and (same := same_door(h, place, index, other, number)) is not None:
                undone += 0.5 * same
                one_way += 0.5 * (1.0 - same)
    misread, read = 0.0, 0.0
    for sensor, counts in enumerate(place.sights):
        if any(count % 1.0 for count in counts.values()):
            continue  # likelihoods say themselves how sure they are
        for label, p in label_shares(chances, sensor, counts).items():
            misread += counts[label] * (1.0 - p)
            read += counts[label] * p
    stayed = _stayed(h, number, place) if any(place.ways[way].stays for way in h.awake) else (0.0, 0.0)
    share = Share(opened, blocked, wrong, right, misread, read, beside, shut, undone, one_way, *stayed)
    return Place(place.sights, place.ways, place.frame, place.position, place.recent, place.into, share)


def _whole(looks: float) -> bool:
    """Whether so many looks are whole ones: parts are left of a door that has changed, not of looks that were not sure.

    Those say themselves how sure they are, and nothing of how often one is wrong.
    """
    return abs(looks - round(looks)) < 1e-6


def _stayed(h: Hypothesis, number: int, place: Place) -> tuple[float, float]:
    """Moves through open ways of a place that did not lead on, and the share of other actions that would not either."""
    leads_on = 1.0 - h.chances.fails
    opened = {way: probability(way_odds(h, number, place, way)) for way in h.awake}
    stays = {way: 1.0 - p * leads_on for way, p in opened.items()}
    stayed = strayed = 0.0
    for way, p in opened.items():
        if failed := place.ways[way].stays * p:
            stayed += failed
            strayed += failed * slips_into_staying(h, way, stays)
    return stayed, strayed
