"""A tracker as a header for JSON and arrays of numbers, and back."""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import exp, isfinite
from typing import Any

from numpy.typing import NDArray

from ...model import CogmapError
from .attempts import Attempt, Tried
from .hypothesis import Hypothesis, digest
from .layered import Layered, Shared
from .lookback import Past
from .options import Change
from .rates import ROWS, RateCounts
from .records import NOWHERE, Place, Share, Way
from .replaying import History
from .scheme import WayScheme
from .streams import DAMAGED, Reader, Writer

Arrays = dict[str, NDArray[Any]]

VERSION = 1

FIRST_RATES, FIRST_SHARE, FIRST_WAY = 13, 8, 5
"""Rates, and numbers of what a place shares, and of a way, of a state that does not say how many it has."""


@dataclass(slots=True)
class Parts:
    """What a tracker consists of."""

    hypotheses: list[Hypothesis]
    history: History
    tried: dict[Attempt, Tried]
    past: tuple[Past, ...]
    change: Change
    doubts: Sequence[int]
    labels: tuple[int, ...]
    evidence: float
    numbers: tuple[int, int, bool, int]
    """Time, place in `doubts`, whether all is clear, steps without doubt."""


def stored(scheme: WayScheme, parts: Parts) -> tuple[dict[str, Any], Arrays]:
    """The header and the arrays of a tracker; the layer that its hypotheses share is written once."""
    out = Writer()
    past = [(step, h) for step in parts.past if (h := step.parent.as_of(step.marks)) is not None]
    hypotheses = [*parts.hypotheses, *(h for _, h in past)]
    if hypotheses:
        _write_maps(out, hypotheses[0], 0)
    for h in hypotheses:
        _write_maps(out, h, 1)
        out.whole += [h.here, h.size, h.links, h.apart, *h.kinds]
        out.real += [h.weight, *h.counts.yes, *h.counts.no, *(count for looks in h.looks for count in looks)]
        out.many((h.crowd or {}).items(), out.count)
        for (one, other), counts in h.undo.items():
            out.whole += [one, other]
            out.real += counts
    for step, _ in past:
        out.whole += [step.time, *step.labels]
        out.real.append(step.norm)
    out.many(parts.history, out.sensed)
    out.many(parts.tried.items(), lambda item: out.whole.extend(map(int, (*item[0], *item[1]))))
    out.many(parts.doubts, out.whole.append)
    header = {
        "version": VERSION,
        "scheme": _described(scheme),
        "hypotheses": [
            {
                "periods": [[frame, [list(row) for row in rows]] for frame, rows in h.periods.items()],
                "undo": len(h.undo),
                "clan": h.clan,
            }
            for h in hypotheses
        ],
        "past": len(past),
        "evidence": parts.evidence,
        "labels": list(parts.labels),
        "numbers": list(parts.numbers),
        "change": [parts.change.kind, list(parts.change.places)],
        "length": parts.history.length,
        "rates": ROWS,
        "share": len(Share()),
        "way": len(Way()),
    }
    arrays = out.rows()
    return {**header, "check": _checksum(header, arrays)}, arrays


def _checksum(header: Mapping[str, Any], arrays: Mapping[str, Any]) -> int:
    """Of all that is written, so that what was changed or cut is found before anything is believed of it."""
    text = json.dumps({key: value for key, value in header.items() if key != "check"}, sort_keys=True)
    return zlib.crc32(arrays["real"].tobytes(), zlib.crc32(arrays["whole"].tobytes(), zlib.crc32(text.encode())))


def restored(scheme: WayScheme, state: Any) -> Parts:
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
        share = int(header.get("share", FIRST_SHARE))
        if not FIRST_SHARE <= share <= len(Share()):
            raise ValueError("its places share what none does")
        way = int(header.get("way", FIRST_WAY))
        if not FIRST_WAY <= way <= len(Way()):
            raise ValueError("its ways have more parts than any")
        source = Reader(arrays["whole"], arrays["real"], share=share, way=way)
        if _checksum(header, arrays) != header["check"]:
            raise ValueError("its numbers are not those that were written")
        return _read(scheme, header, source)
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
        out.record(place)


def _shown(out: Writer, key: tuple[int, int], numbers: tuple[int, ...] | None) -> None:
    out.whole += key
    out.many(numbers or (), out.whole.append)


def _number(number: int | None) -> int:
    return NOWHERE if number is None else number


def _read(scheme: WayScheme, header: Mapping[str, Any], source: Reader) -> Parts:
    entries, rates = header["hypotheses"], int(header.get("rates", FIRST_RATES))
    if not FIRST_RATES <= rates <= ROWS:
        raise ValueError("its rates are none of these")
    source.records(scheme)
    shared = _shared(_read_maps(scheme, source)) if entries else (Shared(), Shared(), Shared())
    hypotheses = [_read_hypothesis(scheme, entry, shared, source, rates=rates) for entry in entries]
    alive = len(hypotheses) - int(header["past"])
    _finish(hypotheses, alive)
    past: list[Past] = []
    for h in hypotheses[alive:]:
        time, *labels = source.numbers(1 + scheme.sensors)
        past.append(Past(time, h, h.marks, tuple(labels), source.reals(1)[0]))
    history = History(int(header["length"]))
    for time, sensed in source.many(lambda: source.sensed(scheme)):
        sensed.check(scheme)
        history.add(sensed, time)
    tried: dict[Attempt, Tried] = {}
    for one, other, period, apart, *rest in source.many(lambda: source.numbers(9)):
        tried[one, other, bool(period), apart] = Tried(*rest)
    doubts = source.row()
    source.end()
    kind, places = header["change"]
    time, doubted, clear, quiet = header["numbers"]
    evidence, labels = float(header["evidence"]), tuple(int(n) for n in header["labels"])
    parts = Parts(
        hypotheses[:alive], history, tried, tuple(past), Change(kind, tuple(places)), doubts, labels, evidence,
        (int(time), int(doubted), bool(clear), int(quiet)),
    )  # fmt: skip
    _check_parts(scheme, parts)
    return parts


def _check_parts(scheme: WayScheme, parts: Parts) -> None:
    """Refuse parts that contradict each other."""
    time, doubted, _, _ = parts.numbers
    alive = bool(parts.hypotheses)
    if abs(sum(exp(h.weight) for h in parts.hypotheses) - alive) > 1e-6 or not isfinite(parts.evidence):
        raise ValueError("its weights do not add up to one")
    if len(parts.labels) != scheme.sensors * alive or not 0 <= doubted <= len(parts.doubts):
        raise ValueError("its numbers contradict each other")
    times = [time for time, _ in parts.history]
    if times != list(range(time - len(times), time)) or parts.change.kind not in ("extended", "revised"):
        raise ValueError("its steps do not follow each other")
    if [step.time for step in parts.past] != times[len(times) - len(parts.past) :]:
        raise ValueError("its steps do not follow each other")


Maps = tuple[dict[int, Any], dict[tuple[int, tuple[int, ...]], Any], dict[tuple[int, int], Any]]
Bases = tuple[Shared[int, Any], Shared[tuple[int, tuple[int, ...]], Any], Shared[tuple[int, int], Any]]


def _read_maps(scheme: WayScheme, source: Reader) -> Maps:
    """One layer of the three mappings."""
    places: dict[int, Place | None] = {}
    for _ in range(source.numbers(1)[0]):
        number, there = source.numbers(2)
        places[number] = source.record() if there else None
    at: dict[tuple[int, tuple[int, ...]], int | None] = {}
    for frame, *position, number in source.many(lambda: source.numbers(2 + len(scheme.origin))):
        at[frame, tuple(position)] = None if number == NOWHERE else number
    shown: dict[tuple[int, int], tuple[int, ...]] = {}
    for _ in range(source.numbers(1)[0]):
        sensor, label = source.numbers(2)
        shown[sensor, label] = tuple(source.row())
    return places, at, shown


def _shared(maps: Maps) -> Bases:
    bases: Bases = (Shared(), Shared(), Shared())
    for base, entries in zip(bases, maps, strict=True):
        if None in entries.values():
            raise ValueError("what its hypotheses share is not there")
        base.update(entries)  # type: ignore[arg-type]
    return bases


def _read_hypothesis(
    scheme: WayScheme, entry: Mapping[str, Any], shared: Bases, source: Reader, *, rates: int
) -> Hypothesis:
    h = Hypothesis(scheme)
    places, at, shown = _read_maps(scheme, source)
    h.places, h.at, h.shown = Layered(shared[0], places), Layered(shared[1], at), Layered(shared[2], shown)
    h.here, h.size, h.links, apart, *h.kinds = source.numbers(4 + scheme.sensors)
    h.apart, h.clan = bool(apart), int(entry.get("clan", 0))
    h.weight, *counts = source.reals(1 + 2 * rates)
    looks = source.reals(2 * scheme.count)
    h.looks = list(zip(looks[::2], looks[1::2], strict=True))
    h.crowd = source.counts() or None
    more = [0.0] * (ROWS - rates)
    h.counts = RateCounts(counts[:rates] + more, counts[rates:] + more)
    h.periods = {int(frame): tuple(tuple(int(x) for x in row) for row in rows) for frame, rows in entry["periods"]}
    for _ in range(entry["undo"]):
        one, other = source.numbers(2)
        yes, no = source.reals(2)
        h.undo[one, other] = (yes, no)
    return h


def _finish(hypotheses: Sequence[Hypothesis], alive: int) -> None:
    """Check hypotheses that share a layer, and work their digests out; each place that they share once."""
    if not hypotheses:
        return
    base = hypotheses[0].places.layers[0]
    shared = {number: digest(place) for number, place in base.items()}
    total = sum(shared.values())
    for k, h in enumerate(hypotheses):
        own = h.places.layers[1]
        _check(h, own if k else [*base, *own])
        if k < alive:
            _check_index(h)
        h.digest = total + sum(
            (0 if place is None else digest(place)) - shared.get(number, 0) for number, place in own.items()
        )


def _check(h: Hypothesis, changed: Iterable[int]) -> None:
    """Refuse a map with ways to places that there are not, or numbers that are none.

    Args:
        h: the hypothesis.
        changed: its places that are looked at; the others were found right in another one.
    """
    looks = (count for both in h.looks for count in both)
    if h.places.get(h.here) is None or not all(map(isfinite, (h.weight, *h.counts.yes, *h.counts.no, *looks))):
        raise ValueError("its agent is in no place of its map, or counts what is no number")
    for number in changed:
        place = h.places.get(number)
        if place is None:
            continue
        ends = [*(way.to for way in place.ways if way.to != NOWHERE), *(source for source, _ in place.into)]
        values = [*place.share, *(x for way in place.ways for x in (*way[:3], way.stays))]
        known = all(h.places.get(end) is not None for end in ends)
        if not (known and all(0 <= way < h.scheme.count for _, way in place.into) and all(map(isfinite, values))):
            raise ValueError(f"place {number} leads to no place of its map, or counts what is no number")
        if not place.recent or not all(label >= 0 and isfinite(n) for c in place.sights for label, n in c.items()):
            raise ValueError(f"place {number} was never visited, or shows what is no label")


def _check_index(h: Hypothesis) -> None:
    """Refuse an index that names places that the map has not."""
    listed = [*(h.at.get(key) for key in h.at), *(k for key in h.shown for k in h.shown.get(key) or ())]
    if not all(number is None or h.places.get(number) is not None for number in listed):
        raise ValueError("its index names places that it has not")
    if sum(1 for _ in h.places) != h.size:
        raise ValueError("its map has not as many places as it says")
    shown = {(sensor, label, k) for sensor, label in h.shown for k in h.shown.get((sensor, label)) or ()}
    labels = {(s, label, k) for k in h.places for s in range(h.scheme.sensors) if (label := h.places[k].label(s)) >= 0}
    if shown != labels:
        raise ValueError("its index of sights is not that of its places")
