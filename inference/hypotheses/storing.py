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
from .hypothesis import Hypothesis, awake_ways, digest
from .layered import Layered, Shared
from .lookback import Past
from .options import Change
from .rates import BLAMED, ROWS, STAYED, TRACE, RateCounts
from .records import NOWHERE, Place, Share, Way
from .replaying import History
from .scheme import WayScheme
from .streams import DAMAGED, Reader, Writer

Arrays = dict[str, NDArray[Any]]

VERSION = 1

LONGEST = 10**6
"""Steps that may be kept."""

MUCH, NET, FAR = 1e12, 128.0, 10**12
"""What counts, evidence of a way in readings, and coordinates are below."""

LATER_NUMBERS = 0, False, 0, 0
"""Numbers of a tracker that some states do not have, as they were then."""

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
    numbers: tuple[int, int, bool, int, int, bool, int, int]
    """Time, place in `doubts`, whether all is clear, steps without doubt, how often it was begun anew, whether labels
    and ways are not all that was sensed, doubts in a row that came to nothing, and when the last of them was over."""
    awake: tuple[int, ...]


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
    out.many(parts.history.norms, out.count)
    header = {
        "version": VERSION,
        "scheme": _described(scheme),
        "hypotheses": [
            {
                "periods": [[frame, [list(row) for row in rows]] for frame, rows in h.periods.items()],
                "undo": len(h.undo),
                "clan": h.clan,
                "slips": [[*key, count] for key, count in h.slips.items()],
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
        "awake": list(parts.awake),
        "way": len(Way()),
        "norms": True,
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
    _finish(hypotheses, alive, int(header["numbers"][0]))
    past: list[Past] = []
    for h in hypotheses[alive:]:
        time, *labels = source.numbers(1 + scheme.sensors)
        if min(labels, default=1) < 1:
            raise ValueError("there were fewer labels than none")
        past.append(Past(time, h, h.marks, tuple(labels), source.reals(1)[0]))
    if not 1 <= int(header["length"]) <= LONGEST:
        raise ValueError("its steps are kept as long as none can be")
    history = History(int(header["length"]))
    for time, sensed in source.many(lambda: source.sensed(scheme)):
        sensed.check(scheme)
        history.add(sensed, time)
    tried: dict[Attempt, Tried] = {}
    for one, other, period, apart, *rest in source.many(lambda: source.numbers(9)):
        tried[one, other, bool(period), apart] = Tried(*rest)
    doubts = source.row()
    history.norms.extend(source.counts().items() if header.get("norms") else ((time, 0.0) for time, _ in history))
    source.end()
    kind, places = header["change"]
    numbers = header["numbers"]
    time, doubted, clear, quiet, tries, partly, in_a_row, cleared = (*numbers, *LATER_NUMBERS[len(numbers) - 4 :])
    awake = tuple(int(way) for way in header.get("awake", range(scheme.count)))
    if not {*awake_ways(scheme)} <= set(awake) <= set(range(scheme.count)) or sorted(set(awake)) != [*awake]:
        raise ValueError("it thinks of ways that there are not")
    evidence, labels = float(header["evidence"]), tuple(int(n) for n in header["labels"])
    parts = Parts(
        hypotheses[:alive], history, tried, tuple(past), Change(kind, tuple(places)), doubts, labels, evidence,
        (int(time), int(doubted), bool(clear), int(quiet), int(tries), bool(partly), int(in_a_row), int(cleared)),
        awake,
    )  # fmt: skip
    _check_parts(scheme, parts)
    return parts


def _check_parts(scheme: WayScheme, parts: Parts) -> None:
    """Refuse parts that contradict each other."""
    time, doubted, _, _, tries, _, in_a_row, cleared = parts.numbers
    alive = bool(parts.hypotheses)
    if abs(sum(exp(h.weight) for h in parts.hypotheses) - alive) > 1e-6 or not isfinite(parts.evidence):
        raise ValueError("its weights do not add up to one")
    if len(parts.labels) != scheme.sensors * alive or not 0 <= doubted <= len(parts.doubts):
        raise ValueError("its numbers contradict each other")
    times = [time for time, _ in parts.history]
    if [time for time, _ in parts.history.norms] != times or not all(isfinite(norm) for _, norm in parts.history.norms):
        raise ValueError("its steps are not all weighed")
    if not (0 <= tries <= time and 0 <= in_a_row <= time and 0 <= cleared <= time):
        raise ValueError("its numbers contradict each other")
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
    h.slips = {(int(given), int(taken)): float(count) for given, taken, count in entry.get("slips", ())}
    return h


def _finish(hypotheses: Sequence[Hypothesis], alive: int, time: int) -> None:
    """Check hypotheses that share a layer, and work their digests out; each place that they share once."""
    if not hypotheses:
        return
    base = hypotheses[0].places.layers[0]
    ways = range(hypotheses[0].scheme.count)
    shared = {number: digest(place, ways) for number, place in base.items()}
    total, both = sum(shared.values()), Hypothesis(hypotheses[0].scheme)
    for place in base.values():
        both.lay(place, 1)
    for k, h in enumerate(hypotheses):
        own = h.places.layers[1]
        _check(h)
        _check_places(h, own if k else [*base, *own], time)
        if k < alive:
            _check_index(h)
        h.digest = total + sum(
            (0 if place is None else digest(place, ways)) - shared.get(number, 0) for number, place in own.items()
        )
        h.laid = both.laid.copy()
        for number, place in own.items():
            h.lay(base.get(number), -1)
            h.lay(place, 1)


def _check(h: Hypothesis) -> None:
    """Refuse what is counted and thought of the whole map, where that can be of none."""
    counts = (*h.counts.yes, *h.counts.no, *(count for both in (*h.looks, *h.undo.values()) for count in both))
    if h.places.get(h.here) is None or not (isfinite(h.weight) and all(abs(count) < MUCH for count in counts)):
        raise ValueError("its agent is in no place of its map, or counts what is no number")
    yes, no = h.counts.yes, h.counts.no
    if not (0.0 <= yes[BLAMED] <= 1.0 and yes[STAYED] > -TRACE and (yes[STAYED] < TRACE or no[STAYED] > 0.0)):
        raise ValueError("its moves failed less often than never")
    if not all(count >= 0.0 for both in (*h.looks, *h.undo.values(), h.slips.values()) for count in both):
        raise ValueError("it was read as open or blocked less than never")
    if h.crowd is not None:
        known = all(h.places.get(number) is not None for number in h.crowd)
        if not known or h.here not in h.crowd or not all(-MUCH < weight < 1e-6 for weight in h.crowd.values()):
            raise ValueError("its agent may be in places of no map")
    for rows in h.periods.values():
        sized = all(len(row) == len(h.scheme.origin) and max(map(abs, row)) < FAR for row in rows)
        firsts = [next((at for at, x in enumerate(row) if x > 0), -1) for row in rows]
        if not sized or -1 in firsts or any(any(row[:at]) for row, at in zip(rows, firsts, strict=True)):
            raise ValueError("its map closes on itself by steps that are none")
        if sorted(set(firsts)) != firsts:
            raise ValueError("its map closes on itself by steps that are out of order")


def _check_places(h: Hypothesis, numbers: Iterable[int], time: int) -> None:
    """Refuse places with ways to places that there are not, or numbers that are none.

    Args:
        h: the hypothesis.
        numbers: of the places that are looked at; the others were found right in another one.
        time: of the next step.
    """
    ways, known = range(h.scheme.count), h.places.get
    for number in numbers:
        place = known(number)
        if place is None:
            continue
        ends = {way.to for way in place.ways if way.to != NOWHERE}.union(source for source, _ in place.into)
        if any(known(end) is None for end in ends) or any(way not in ways for _, way in place.into):
            raise ValueError(f"place {number} leads to no place of its map")
        counts = [*place.share, *(x for way in place.ways for x in (way.open, way.blocked, way.walks, way.stays))]
        nets = all(abs(way.net) < NET for way in place.ways)
        if not (nets and min(counts) > -1e-6 and max(counts) < MUCH and max(map(abs, place.position), default=0) < FAR):
            raise ValueError(f"place {number} counts what is no number")
        recent = place.recent
        if not recent or not recent[0] >= 0 or recent[-1] >= time or sorted(recent) != [*recent] or number >= time:
            raise ValueError(f"place {number} was never visited")
        if not all(label >= 0 and 0.0 <= n < MUCH for counts in place.sights for label, n in counts.items()):
            raise ValueError(f"place {number} shows what is no label")


def _check_index(h: Hypothesis) -> None:
    """Refuse an index that names places that the map has not."""
    listed = [*(h.at.get(key) for key in h.at), *(k for key in h.shown for k in h.shown.get(key) or ())]
    if not all(number is None or h.places.get(number) is not None for number in listed):
        raise ValueError("its index names places that it has not")
    if sum(1 for _ in h.places) != h.size or not 0 <= h.links < MUCH:
        raise ValueError("its map has not as many places or ways as it says")
    shown = {(sensor, label, k) for sensor, label in h.shown for k in h.shown.get((sensor, label)) or ()}
    labels = {(s, label, k) for k in h.places for s in range(h.scheme.sensors) if (label := h.places[k].label(s)) >= 0}
    if shown != labels:
        raise ValueError("its index of sights is not that of its places")
    if h.kinds != [len({label for s, label, _ in shown if s == sensor}) for sensor in range(h.scheme.sensors)]:
        raise ValueError("it has not as many sights as it says")
