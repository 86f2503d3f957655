"""How likely a sensed is at a place, known or never seen, under one hypothesis."""

from collections.abc import Callable, Mapping, Sequence
from math import exp, log

from .chances import Chances
from .hypothesis import Hypothesis, Key
from .rates import ALIKE, crp_predictive
from .records import NOWHERE, Place, SightCounts
from .scheme import Reading, Sensed

LEAST = 1e-300


def log_likelihood(h: Hypothesis, number: int, sensed: Sensed) -> float:
    """log P(sensed | the agent is in that place), by what was read there before."""
    place, chances = h.places[number], h.chances
    p = 1.0
    for sensor, reading in enumerate(sensed.sights):
        if reading is not None:
            p *= sight_probability(chances, sensor, place.sights[sensor], reading)
    q = _ways_as_they_were(h, number, place, sensed)
    if q < chances.rebuilt:
        q = (1.0 - chances.rebuilt) * q + chances.rebuilt * _anew(h, sensed)
    return log(max(p * q, LEAST)) + (0.0 if sensed.others is None else sensed.others(number))


def was_rebuilt(h: Hypothesis, number: int, place: Place, sensed: Sensed) -> bool:
    """Whether the ways of a place more probably all are others than they were, by how they are read."""
    ways, looks = place.ways, sensed.ways
    against = sum((look := looks[way]) is not None and ways[way].net * (look - 0.5) < 0.0 for way in h.awake)
    if against < 2:
        return False
    rebuilt, q = h.chances.rebuilt, _ways_as_they_were(h, number, place, sensed)
    return rebuilt * _anew(h, sensed) > (1.0 - rebuilt) * q


def _ways_as_they_were(h: Hypothesis, number: int, place: Place, sensed: Sensed) -> float:
    return _read_so(h, sensed, lambda way: probability(way_odds(h, number, place, way)))


def _anew(h: Hypothesis, sensed: Sensed) -> float:
    """P(ways as they are read), of a place of which nothing is known: that of one that was rebuilt."""
    return _read_so(h, sensed, h.open)


def _read_so(h: Hypothesis, sensed: Sensed, open_: Callable[[int], float]) -> float:
    """P(ways as they are read), by P(open) of each."""
    looks = sensed.ways
    return readings_probability(h.chances, [(open_(way), look) for way in h.awake if (look := looks[way]) is not None])


def log_predictive(h: Hypothesis, sensed: Sensed, key: Key | None, back: int | None, source: int) -> float:
    """log P(sensed | a place never seen), by what places are like here.

    Args:
        h: the hypothesis.
        sensed: what is sensed.
        key: frame and position of the new place; None where it has none, or neighbours unknown.
        back: the way back to where the agent came from, where that is known.
        source: where it came from.
    """
    p = 1.0
    for sensor, reading in enumerate(sensed.sights):
        if reading is not None:
            p *= new_sight_probability(h, sensor, reading)
    p *= _read_so(h, sensed, lambda way: _expected_open(h, key, way, back, source))
    return log(max(p, LEAST)) + (0.0 if sensed.others is None else sensed.others(None))


def sight_probability(chances: Chances, sensor: int, counts: SightCounts, reading: Reading) -> float:
    """Σ_l P(reading | l) P(l | counts), where P(l | counts) ∝ exp(unit · counts[l])."""
    misread, right = chances.misread[sensor], chances.right[sensor]
    if isinstance(reading, int):
        q = label_probability(chances, sensor, counts, reading)
        return right * q + misread * (1.0 - q)
    assert isinstance(reading, Mapping)
    mean = sum(reading.values()) / max(chances.labels[sensor], len(reading))
    known = sum(label_probability(chances, sensor, counts, label) * likelihood for label, likelihood in reading.items())
    return (right - misread) * known + misread * chances.labels[sensor] * mean


def label_probability(chances: Chances, sensor: int, counts: SightCounts, label: int) -> float:
    """P(the place has this sight | what was read there), every label alike before."""
    unit = chances.sight_unit[sensor]
    if len(counts) == 1:
        ((only, count),) = counts.items()
        total = 1.0 + (chances.labels[sensor] - 1) * exp(-unit * count)
        return 1.0 / total if label == only else exp(-unit * count) / total
    most = max(counts.values(), default=0.0)
    others = max(chances.labels[sensor] - len(counts), 0) * exp(-unit * most)
    total = others + sum(exp(unit * (count - most)) for count in counts.values())
    return exp(unit * (counts.get(label, 0.0) - most)) / total


def label_shares(chances: Chances, sensor: int, counts: SightCounts) -> dict[int, float]:
    """`label_probability` of each label that was read there."""
    if len(counts) < 2:
        return {label: label_probability(chances, sensor, counts, label) for label in counts}
    unit, most = chances.sight_unit[sensor], max(counts.values())
    odds = {label: exp(unit * (count - most)) for label, count in counts.items()}
    total = max(chances.labels[sensor] - len(counts), 0) * exp(-unit * most) + sum(odds.values())
    return {label: p / total for label, p in odds.items()}


def new_sight_probability(h: Hypothesis, sensor: int, reading: Reading) -> float:
    """P(reading | a place never seen): what it shows is drawn by a Chinese restaurant process, and may be misread."""
    chances, misread = h.chances, h.chances.misread[sensor]
    if isinstance(reading, int):
        alike = len(h.shown.get((sensor, reading)) or ())
        drawn = crp_predictive(alike, h.kinds[sensor], h.size)
        return (chances.right[sensor] - misread) * drawn + misread
    assert isinstance(reading, Mapping)
    return sum(new_sight_probability(h, sensor, label) * likelihood for label, likelihood in reading.items())


def way_odds(h: Hypothesis, number: int, place: Place, way: int) -> float:
    """Log odds that a way is open: what was read here, and from the other side of the door."""
    if len(h.awake) < h.scheme.count and way not in h.awake:
        return -h.chances.limit
    known = place.ways[way]
    return odds_beyond(h, number, known.net, way, known.to if known.to != NOWHERE else h.neighbour(place, way))


def odds_beyond(h: Hypothesis, number: int, net: float, way: int, other: int) -> float:
    """Log odds that a way with so many readings is open, that leads to the place `other` if to any."""
    chances, inverse = h.chances, h.scheme.inverse
    if other == NOWHERE:
        odds = chances.odds + net * chances.unit
    else:
        odds = chances.beside + net * chances.unit
        if inverse is not None:
            back = h.places[other].ways[inverse[way]]
            if back.net and (not back.walks or back.to == number):
                odds += _same_door(chances, back.net)
    limit = chances.limit
    return limit if odds > limit else -limit if odds < -limit else odds


def other_side(h: Hypothesis, other: int, back: int, number: int) -> float:
    """Log odds that what was read of the way back adds: P(it is the same door) is the rate `undone`.

    log [ρ l + (1 - ρ) m] / [ρ + (1 - ρ) m],   l = exp(net · unit),   m = π l + 1 - π
    """
    way = h.places[other].ways[back]
    if not way.net or (way.walks and way.to != number):
        return 0.0
    return _same_door(h.chances, way.net)


def _same_door(chances: Chances, net: float) -> float:
    found = chances.doors.get(net)
    if found is None:
        likelihood = strength(net * chances.unit)
        apart = (1.0 - chances.undone) * (chances.open * likelihood + 1.0 - chances.open)
        found = chances.doors[net] = log((chances.undone * likelihood + apart) / (chances.undone + apart))
    return found


def same_door(h: Hypothesis, place: Place, way: int, other: int, number: int) -> float | None:
    """P(a way and the way back are one door | what was read of both); None where nothing says it, or walks do."""
    if h.scheme.inverse is None:
        return None
    mine, its = place.ways[way], h.places[other].ways[h.scheme.inverse[way]]
    if not mine.net or not its.net or (mine.walks and its.walks) or (its.walks and its.to != number):
        return None
    chances, key = h.chances, (mine.net, its.net)
    found = chances.pairs.get(key)
    if found is None:
        same, apart = both_sides(chances, *key, open_=chances.open)
        found = chances.pairs[key] = same / (same + apart)
    return found


def both_sides(chances: Chances, mine: float, its: float, *, open_: float) -> tuple[float, float]:
    """P(readings of two sides), if they are one door and if not, but for what is the same for open and blocked ones.

    ρ [π l m + (1 - π) / (l m)]   and   (1 - ρ) [π l + (1 - π) / l] [π m + (1 - π) / m],   l = exp(net · unit / 2)
    """
    p, half = open_, 0.5 * chances.unit
    one, other = strength(mine * half), strength(its * half)
    same = chances.undone * (p * one * other + (1.0 - p) / (one * other))
    return same, (1.0 - chances.undone) * (p * one + (1.0 - p) / one) * (p * other + (1.0 - p) / other)


def strength(evidence: float) -> float:
    """How much more likely something makes evidence of so many nats, within what can be multiplied."""
    return exp(max(min(evidence, 50.0), -50.0))


def probability(odds: float) -> float:
    """1 / (1 + exp(-odds))."""
    return 1.0 / (1.0 + exp(-odds))


def reading_probability(chances: Chances, p_open: float, reading: float) -> float:
    """P(reading of a way | P(open)); a reading between 0 and 1 is a likelihood of being open."""
    as_open = p_open * (1.0 - chances.wrong) + (1.0 - p_open) * chances.wrong
    if reading == 1.0:
        return as_open
    return reading * as_open + (1.0 - reading) * (1.0 - as_open)


def readings_probability(chances: Chances, readings: Sequence[tuple[float, float]]) -> float:
    """P(readings of several ways | P(open) of each): in a world of doubtful doors all of them are doubtful."""
    total = 0.0
    for weight, wrong in chances.wrongs:
        for p_open, reading in readings:
            as_open = wrong + p_open * (1.0 - 2.0 * wrong)
            weight *= as_open if reading == 1.0 else reading * as_open + (1.0 - reading) * (1.0 - as_open)
        total += weight
    return total


def _expected_open(h: Hypothesis, key: Key | None, way: int, back: int | None, source: int) -> float:
    """P(open) of a way of a place never seen: the door of a neighbour, the way back, or what ways are like here."""
    chances = h.chances
    if way == back:
        return chances.undone + (1.0 - chances.undone) * h.open(way)
    other = None if key is None else _known_beyond(h, key, way)
    if other is not None and h.scheme.inverse is not None:
        return probability(chances.beside + other_side(h, other, h.scheme.inverse[way], NOWHERE))
    if source == NOWHERE:
        return h.open(way)
    return chances.alike * _as_before(h, source, way) + (1.0 - chances.alike) * h.open(way)


def _known_beyond(h: Hypothesis, key: Key, way: int) -> int | None:
    """The known place beyond a way of a place never seen; None where none is known."""
    if h.scheme.displacements is None or h.scheme.inverse is None:
        return None
    position = tuple(x + d for x, d in zip(key[1], h.scheme.displacements[way], strict=True))
    return h.at.get(h.canonical(key[0], position))


def _as_before(h: Hypothesis, source: int, way: int) -> float:
    """P(open) of the same way of the place that one comes from: corridors and walls go on."""
    return probability(way_odds(h, source, h.places[source], way))


def before_reading(
    h: Hypothesis, number: int, place: Place, way: int, view: Callable[[int], Place], find: Callable[[int], int]
) -> float:
    """P(open) of a way of a known place before anything was read of it: what `log_predictive` gave it.

    Args:
        h: the hypothesis.
        number, place: the place.
        way: the way.
        view: the record of a place.
        find: the place that another one is taken for.
    """
    source = max((one for source, _ in place.into if (one := find(source)) < number), default=NOWHERE)
    if source == NOWHERE:
        return h.open(way)
    chances = h.chances
    there = probability(
        chances.odds + max(min(view(source).ways[way].net * chances.unit, chances.limit), -chances.limit)
    )
    return chances.alike * there + (1.0 - chances.alike) * h.open(way)


def count_alike(h: Hypothesis, sensed: Sensed, key: Key | None, back: int | None, source: int) -> None:
    """What the ways of a place never seen say of how often they are as those of the place it was entered from."""
    chances, counts = h.chances, h.counts
    for way in h.awake:
        reading = sensed.ways[way]
        if reading is None or way == back or (key is not None and _known_beyond(h, key, way) is not None):
            continue
        before = chances.alike * reading_probability(chances, _as_before(h, source, way), reading)
        any_ = (1.0 - chances.alike) * reading_probability(chances, h.open(way), reading)
        share = before / (before + any_)
        counts.yes[ALIKE] += share
        counts.no[ALIKE] += 1.0 - share
