"""A tracker as a header for JSON and arrays of numbers, and back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import exp, isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...model import CogmapError
from .hypothesis import Hypothesis
from .layered import Layered
from .options import Change
from .rates import RATE_PRIORS, RateCounts
from .records import NOWHERE, Place
from .replaying import History
from .scheme import WayScheme
from .streams import DAMAGED, Reader, Writer

Arrays = dict[str, NDArray[Any]]
Tried = tuple[int, int, bool, int, int]
Kept = tuple[int, float, tuple[int, ...], Sequence[int], int]

VERSION = 1

Found = tuple[list[Hypothesis], History, dict[Tried, int], Change, Kept]


def stored(
    scheme: WayScheme,
    hypotheses: Sequence[Hypothesis],
    history: History,
    tried: Mapping[Tried, int],
    change: Change,
    kept: Kept,
) -> tuple[dict[str, Any], Arrays]:
    """The header and the arrays of a tracker; the layer that its hypotheses share is written once."""
    out = Writer()
    if hypotheses:
        _write_maps(out, hypotheses[0], 0)
    for h in hypotheses:
        _write_maps(out, h, 1)
        out.whole += [h.here, h.size, h.links, *h.kinds]
        out.real += [h.weight, *h.counts.yes, *h.counts.no]
        for (one, other), counts in h.undo.items():
            out.whole += [one, other]
            out.real += counts
    out.many(history, out.sensed)
    out.many(tried.items(), lambda item: out.whole.extend([*map(int, item[0]), item[1]]))
    out.many(kept[3], out.whole.append)
    time, evidence, labels, _, doubted = kept
    header = {
        "version": VERSION,
        "scheme": _described(scheme),
        "hypotheses": [
            {
                "periods": [[frame, [list(row) for row in rows]] for frame, rows in h.periods.items()],
                "undo": len(h.undo),
            }
            for h in hypotheses
        ],
        "time": time,
        "evidence": evidence,
        "labels": list(labels),
        "doubted": doubted,
        "change": [change.kind, list(change.places)],
        "length": history.length,
    }
    return header, {"whole": np.array(out.whole, np.int64), "real": np.array(out.real, np.float64)}


def restored(scheme: WayScheme, state: Any) -> Found:
    """The parts of a tracker of these ways.

    Raises:
        CogmapError: the state is none, is damaged, or is of other ways or sensors.
    """
    try:
        header, arrays = state
        version, described, arrays = header["version"], header["scheme"], dict(arrays)
    except (TypeError, ValueError, KeyError) as error:
        raise CogmapError("tracker: this is no state; give (header, arrays) as state() returned them") from error
    if version != VERSION:
        raise CogmapError(f"tracker: the state is of version {version}; this one reads version {VERSION}")
    if described != _described(scheme):
        raise CogmapError("tracker: the state is of other ways or sensors; give the scheme that it was made with")
    try:
        return _read(scheme, header, Reader(arrays["whole"], arrays["real"]))
    except (TypeError, ValueError, KeyError, IndexError, OverflowError) as error:
        raise CogmapError(DAMAGED.format(error)) from error


def _described(scheme: WayScheme) -> dict[str, Any]:
    inverse, displacements = scheme.inverse, scheme.displacements
    return {
        "count": scheme.count,
        "inverse": None if inverse is None else list(inverse),
        "displacements": None if displacements is None else [list(d) for d in displacements],
        "sensors": scheme.sensors,
    }


def _write_maps(out: Writer, h: Hypothesis, layer: int) -> None:
    """One layer of the three mappings; None stands for what was taken away."""
    out.many(h.places.layers[layer].items(), lambda item: _entry(out, item[0], item[1]))
    out.many(h.at.layers[layer].items(), lambda item: out.whole.extend([item[0][0], *item[0][1], _number(item[1])]))
    out.many(h.shown.layers[layer].items(), lambda item: _shown(out, *item))


def _entry(out: Writer, number: int, place: Place | None) -> None:
    out.whole += [number, place is not None]
    if place is not None:
        out.place(place)


def _shown(out: Writer, key: tuple[int, int], numbers: tuple[int, ...] | None) -> None:
    out.whole += key
    out.many(numbers or (), out.whole.append)


def _number(number: int | None) -> int:
    return NOWHERE if number is None else number


def _read(scheme: WayScheme, header: Mapping[str, Any], source: Reader) -> Found:
    entries = header["hypotheses"]
    shared = _read_maps(scheme, source) if entries else ({}, {}, {})
    hypotheses = [_read_hypothesis(scheme, entry, shared, source) for entry in entries]
    history = History(int(header["length"]))
    for time, sensed in source.many(lambda: source.sensed(scheme)):
        sensed.check(scheme)
        history.add(sensed, time)
    tried: dict[Tried, int] = {}
    for one, other, period, size, links, again in source.many(lambda: source.numbers(6)):
        tried[one, other, bool(period), size, links] = again
    doubts = source.row()
    source.end()
    time, evidence, labels = int(header["time"]), float(header["evidence"]), tuple(int(n) for n in header["labels"])
    kind, places = header["change"]
    if kind not in ("extended", "revised") or len(labels) != scheme.sensors * bool(entries):
        raise ValueError("its header contradicts itself")
    total = sum(exp(h.weight) for h in hypotheses)
    if (entries and abs(total - 1.0) > 1e-6) or not isfinite(evidence) or not 0 <= header["doubted"] <= len(doubts):
        raise ValueError("its weights do not add up to one")
    kept = time, evidence, labels, doubts, int(header["doubted"])
    return hypotheses, history, tried, Change(kind, tuple(places)), kept


Maps = tuple[dict[int, Any], dict[tuple[int, tuple[int, ...]], Any], dict[tuple[int, int], Any]]


def _read_maps(scheme: WayScheme, source: Reader) -> Maps:
    """One layer of the three mappings."""
    places: dict[int, Place | None] = {}
    for _ in range(source.numbers(1)[0]):
        number, there = source.numbers(2)
        places[number] = source.place(scheme) if there else None
    at: dict[tuple[int, tuple[int, ...]], int | None] = {}
    for frame, *position, number in source.many(lambda: source.numbers(2 + len(scheme.origin))):
        at[frame, tuple(position)] = None if number == NOWHERE else number
    shown: dict[tuple[int, int], tuple[int, ...]] = {}
    for _ in range(source.numbers(1)[0]):
        sensor, label = source.numbers(2)
        shown[sensor, label] = tuple(source.row())
    return places, at, shown


def _read_hypothesis(scheme: WayScheme, entry: Mapping[str, Any], shared: Maps, source: Reader) -> Hypothesis:
    h = Hypothesis(scheme)
    places, at, shown = _read_maps(scheme, source)
    h.places, h.at, h.shown = Layered(shared[0], places), Layered(shared[1], at), Layered(shared[2], shown)
    h.here, h.size, h.links, *h.kinds = source.numbers(3 + scheme.sensors)
    rates = len(RATE_PRIORS)
    h.weight, *counts = source.reals(1 + 2 * rates)
    h.counts = RateCounts(counts[:rates], counts[rates:])
    h.periods = {int(frame): tuple(tuple(int(x) for x in row) for row in rows) for frame, rows in entry["periods"]}
    for _ in range(entry["undo"]):
        one, other = source.numbers(2)
        yes, no = source.reals(2)
        h.undo[one, other] = (yes, no)
    _check(h)
    return h


def _check(h: Hypothesis) -> None:
    """Refuse a map with ways to places that there are not, or numbers that are none."""
    numbers = set(h.places)
    if h.here not in numbers or len(numbers) != h.size:
        raise ValueError("its agent is in no place of its map")
    for number in numbers:
        place = h.places[number]
        ends = [*(way.to for way in place.ways if way.to != NOWHERE), *(source for source, _ in place.into)]
        values = [*place.share, *(x for way in place.ways for x in way[:3]), *h.counts.yes, *h.counts.no]
        if not numbers.issuperset(ends) or not all(map(isfinite, values)):
            raise ValueError(f"place {number} leads to no place of its map, or counts what is no number")
    listed = [*(h.at.get(key) for key in h.at), *(k for key in h.shown for k in h.shown.get(key) or ())]
    if not numbers.issuperset(listed):
        raise ValueError("its index names places that it has not")
