"""Whether a way that was walked has led to a place entered before: by where that lies, and by what is sensed."""

from typing import Any

import numpy as np

from ...percept import Percept
from ..base import Floats, Ints
from ..sight import Sight
from .base import Growing
from .metric import MetricPose
from .odometer import Move
from .relaxing import drift, path_length
from .ways_between import ROUGH

BLUR = 0.03  # standard deviation of a position that is known for sure, in mean lengths of a way
NEAR = 0.1  # mean lengths of a way within which a place lies where moves are measured exactly

WIDE, DRIFTS = 0.6, 0.05
"""The same on open ground, and how far one strays there over the length of a walk: the heading drifts."""

TAILS = 4.0  # degrees of the Student t that positions follow
MISREAD = 0.05  # probability that something sensed says nothing of the place
ONE_WAY = 3.0  # nats against a place that has no way back
FAR = 12.0  # standard deviations beyond which no place is looked for
FEW = 8  # places that are looked at where nothing but their position tells them apart


def recognised(
    pose: MetricPose, model: Growing, percept: Percept, left: int, at: Floats, move: Move, *, open_ground: bool = False
) -> int | None:
    """The place entered before that the agent is more probably in than in a new one; None where there is none.

    log odds = log P(where it lies | it is there) + log P(sensed | it) - log P(somewhere new) - log P(sensed | new)

    Args:
        pose: where places lie.
        model: what it is part of.
        percept: what is sensed now, and the action that led here.
        left: the place that was left.
        at: `[3]` where the move led to, as measured.
        move: what was measured.
        open_ground: whether places are wide, and entered now here, now there.
    """
    places = _candidates(pose, model, percept, left, at)
    if not len(places):
        return None
    exact = percept.displacement is not None and not pose.odometer.errs and not open_ground
    odds = _lies_there(pose, left, places, at, move, exact=exact, wide=open_ground)
    likely = odds > -np.inf
    places, odds = places[likely], odds[likely]
    odds += _looks_so(model, places, percept)
    best: tuple[float, int | None] = 0.0, None
    for i in np.argsort(-odds, kind="stable").tolist():
        if odds[i] <= best[0]:
            break
        place = int(places[i])
        best = max(best, (odds[i] - _leads_back(pose, model, place, left, percept.action or 0), place), key=_first)
    return best[1]


def _first(pair: tuple[float, int | None]) -> float:
    return pair[0]


def _candidates(pose: MetricPose, model: Growing, percept: Percept, left: int, at: Floats) -> Ints:
    """The places that have such ways; where no bearings are sensed the nearest."""
    reading = percept.readings.get("bearings")
    if isinstance(reading, int):
        seen = np.array(model.sensors["bearings"].label(reading), dtype=np.float64)
        found = model.sensors["bearings"].candidates(reading)[0]
        found = found[(pose.bearings.values[found] == seen).all(axis=1)]
    else:
        told = [model.sensors[name].candidates(reading) for name, reading in percept.readings.items()]
        found = min((places for places, _ in filter(None, told)), key=len, default=model.visits.order.values)
        apart = np.linalg.norm(pose.where.values[found] - at, axis=1)
        found = found[np.argsort(apart, kind="stable")[: FEW + 1]]
    return found[found != left]


def _lies_there(
    pose: MetricPose, left: int, places: Ints, at: Floats, move: Move, *, exact: bool, wide: bool
) -> Floats:
    """`[n]` log of the density of each at this position, over that of places in general."""
    off = (pose.where.values[places] - at) / pose.length
    axes, apart = 3 if off[:, 2].any() else 2, np.linalg.norm(off, axis=1)
    if exact and apart.min() > NEAR:
        return np.full(len(places), -np.inf)
    blur = WIDE if wide else BLUR
    most = blur if exact else np.hypot(blur, pose.odometer.most(move.along) / pose.length)
    if not wide and apart.min() > FAR * most:  # however the agent came here
        return np.full(len(places), -np.inf)
    spread = np.full(len(places), blur)
    if wide:
        along = DRIFTS * path_length(pose.walked(), left, places, len(pose.where)) / pose.length
        spread = np.hypot(blur, along)
    elif not exact and apart.min() > blur:
        along = drift(pose.walked(), left, places, len(pose.where)) / pose.length
        spread = np.sqrt(spread**2 + np.square(along) + np.square(move.along / pose.length))
    known = np.isfinite(spread)
    spread = np.where(known, spread, 1e6)
    far = np.square(off / spread[:, None]).sum(axis=1)
    log = -axes * np.log(spread * np.sqrt(2.0 * np.pi)) - (TAILS + axes) / 2.0 * np.log1p(far / TAILS)
    return np.where(known & (apart <= (NEAR if exact else FAR * spread)), log, -np.inf)


def _looks_so(model: Growing, places: Ints, percept: Percept) -> Floats:
    """`[n]` log P(sensed | place) less that of a place never entered, where nothing is told twice."""
    told = np.zeros(len(places))
    for name, reading in percept.readings.items():
        if name == "open" and "bearings" in percept.readings:
            continue
        new = _of_new(model, name, reading)
        here = model.sensors[name].log_likelihood(places, reading)
        told += np.logaddexp(here + np.log1p(-MISREAD), new + np.log(MISREAD)) - new
    return told


def _of_new(model: Growing, name: str, reading: Any) -> float:
    """Log P(reading) in a place never entered: what others show as often as places entered so far did."""
    sensor, entered = model.sensors[name], len(model.visits.order)
    if not isinstance(reading, int) or not isinstance(sensor, Sight):
        return float(sensor.log_predictive(reading))
    shown, kinds = len(sensor.candidates(reading)[0]), len(sensor.labels)
    again = (max(entered - kinds + (not shown), 0) + 0.5) / (entered + 1.0)
    return float(np.log(again * shown / max(entered, 1) if shown else 1.0 - again))


def _leads_back(pose: MetricPose, model: Growing, place: int, left: int, action: int) -> float:
    """Nats against a place whose way back is missing; infinite where it was walked, and led elsewhere."""
    bearing = float(pose.bearings.values[left, action])
    if bearing < 0.0:
        return 0.0
    theirs, ways = pose.bearings.values[place], model.transitions
    apart = np.where(theirs < 0.0, np.inf, np.abs((theirs - bearing) % 360.0 - 180.0))
    back = int(apart.argmin())
    if apart[back] > ROUGH:
        return ONE_WAY
    return np.inf if ways.walked.values[place, back] and ways.beyond(place, back) != left else 0.0
