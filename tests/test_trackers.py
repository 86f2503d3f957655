"""Trackers: calm steps, going back, files, further sensors, and what is said of each step."""

from __future__ import annotations

import json
from contextlib import suppress
from dataclasses import replace
from math import exp, log

import numpy as np
import pytest
from cogmap.inference.hypotheses import (
    Sensed,
    Tracker,
    TrackerOptions,
    WayScheme,
    label_probabilities,
    open_probability,
    rates_of,
    where_to,
    whereabouts,
)
from cogmap.model import CogmapError
from hypothesis import given, settings
from hypothesis import strategies as st

STEPS = ((-1, 0), (1, 0), (0, -1), (0, 1))
LATTICE = WayScheme(4, (1, 0, 3, 2), STEPS)
UNPLACED = WayScheme(4, (1, 0, 3, 2))
UNTOLD = WayScheme(4)
LABELS = 6


def percepts(seed: int, steps: int, *, size: int = 3, noise: float = 0.0, labels: int = LABELS) -> list[Sensed]:
    """A random walk in a grid of random sights, where sights and doors may be misread and moves may fail."""
    rng = np.random.default_rng(seed)
    sights = rng.integers(labels, size=(size, size)) if labels < size * size else np.arange(size * size)
    sights = sights.reshape(size, size)
    at, action, found = (0, 0), None, []
    for _ in range(steps):
        if action is not None and rng.random() >= noise:
            at = _beyond(at, action, size)
        sight = int(sights[at]) if rng.random() >= noise else int(rng.integers(labels))
        ways = tuple(float((_beyond(at, way, size) != at) != (rng.random() < noise / 2)) for way in range(4))
        found.append(Sensed((sight,), ways, action))
        action = int(rng.integers(4)) if rng.random() < 0.95 else None
    return found


def _beyond(at: tuple[int, int], way: int, size: int) -> tuple[int, int]:
    r, c = (x + d for x, d in zip(at, STEPS[way], strict=True))
    return (r, c) if 0 <= r < size and 0 <= c < size else at


def walked(tracker: Tracker, steps: list[Sensed], labels: int = LABELS) -> Tracker:
    for sensed in steps:
        tracker.step(sensed, [labels])
    return tracker


def summary(tracker: Tracker) -> list[object]:
    """All that is believed, place by place, of every hypothesis."""
    found: list[object] = [tracker.time, tracker.evidence, tracker.change]
    for h in tracker.hypotheses:
        found.append((h.weight, h.here, h.size, h.links, h.kinds, h.counts.yes, h.counts.no, h.periods, h.undo))
        found.append({number: h.places[number] for number in h.places})
    return found


def alike(one: Tracker, other: Tracker) -> None:
    """The same hypotheses, to 1e-9."""
    assert len(one.hypotheses) == len(other.hypotheses)
    assert one.evidence == pytest.approx(other.evidence, abs=1e-9)
    for a, b in zip(one.hypotheses, other.hypotheses, strict=True):
        assert a.weight == pytest.approx(b.weight, abs=1e-9)
        assert (a.here, a.size, a.links) == (b.here, b.size, b.links)
        assert [*a.counts.yes, *a.counts.no] == pytest.approx([*b.counts.yes, *b.counts.no], abs=1e-9)
        assert set(a.places) == set(b.places)
        for number in a.places:
            assert a.places[number].ways == b.places[number].ways
            assert a.places[number].sights == b.places[number].sights


@pytest.mark.parametrize("scheme", [LATTICE, UNPLACED, UNTOLD])
@pytest.mark.parametrize(("labels", "noise"), [(9, 0.0), (LABELS, 0.0), (9, 0.03)])
def test_calm_steps_are_the_long_ones(scheme, labels, noise):
    for seed in range(2):
        quick, plain = Tracker(scheme), Tracker(scheme, TrackerOptions(calm=False))
        for sensed in percepts(seed, 50, labels=labels, noise=noise):
            assert quick.step(sensed, [labels]) == pytest.approx(plain.step(sensed, [labels]), abs=1e-9)
        alike(quick, plain)


@given(seed=st.integers(0, 10_000), noise=st.sampled_from([0.0, 0.1]), cut=st.integers(0, 25))
@settings(max_examples=6, deadline=None)
def test_a_restored_tracker_walks_on_exactly(seed, noise, cut):
    steps = percepts(seed, 30, noise=noise)
    original = walked(Tracker(LATTICE), steps[:cut])
    header, arrays = original.state()
    other = Tracker.restored(LATTICE, None, (json.loads(json.dumps(header)), arrays))
    assert summary(other) == summary(original)
    for sensed in steps[cut:]:
        assert original.step(sensed, [LABELS]) == other.step(sensed, [LABELS])
        assert summary(other) == summary(original)
        assert list(other.best.places) == list(original.best.places)


@pytest.mark.parametrize("scheme", [UNPLACED, UNTOLD])
def test_without_poses_too_a_restored_tracker_walks_on(scheme):
    soft = [replace(s, sights=({s.sights[0]: 0.9, 0: 0.1},)) for s in percepts(2, 30)]
    original = walked(Tracker(scheme), soft[:20])
    other = Tracker.restored(scheme, None, original.state())
    assert summary(walked(other, soft[20:])) == summary(walked(original, soft[20:]))


def test_a_step_is_undone_whether_it_was_finished_or_broken_off():
    class Halt(BaseException):
        pass

    rng = np.random.default_rng(4)
    for noise in (0.0, 0.1):
        tracker, plain = Tracker(LATTICE), Tracker(LATTICE)
        for sensed in percepts(5, 40, noise=noise):
            before, checkpoint = summary(tracker), tracker.checkpoint()
            calls, last = [0], int(rng.integers(1, 6))

            def halt(number: int | None, calls: list[int] = calls, last: int = last) -> float:
                calls[0] += 1
                if calls[0] == last:
                    raise Halt
                return 0.0

            with suppress(Halt):
                tracker.step(replace(sensed, others=halt), [LABELS])
            tracker.rollback(checkpoint)
            assert summary(tracker) == before
            assert tracker.step(sensed, [LABELS]) == plain.step(sensed, [LABELS])
            tracker.rollback(checkpoint)
            assert summary(tracker) == before
            tracker.step(sensed, [LABELS])
            assert summary(tracker) == summary(plain)


def test_only_the_last_step_can_be_undone():
    tracker = walked(Tracker(LATTICE), percepts(0, 5))
    checkpoint = tracker.checkpoint()
    walked(tracker, percepts(0, 2))
    with pytest.raises(CogmapError, match="only the last step can be undone"):
        tracker.rollback(checkpoint)


@given(st.integers(0, 10_000), st.sampled_from([0.0, 0.05]))
@settings(max_examples=6, deadline=None)
def test_a_mirror_needs_to_take_in_only_what_a_step_has_changed(seed, noise):
    tracker, mirror = Tracker(LATTICE), {}
    kinds = set()
    for sensed in percepts(seed, 40, noise=noise):
        tracker.step(sensed, [LABELS])
        change, best = tracker.change, tracker.best
        kinds.add(change.kind)
        if change.kind == "revised":
            mirror = {number: best.places[number] for number in best.places}
        for number in change.places:
            mirror[number] = best.places[number]
        assert mirror == {number: best.places[number] for number in best.places}
    assert "extended" in kinds


def test_the_evidence_is_the_probability_of_what_was_sensed():
    steps = percepts(3, 8, labels=4)
    met = sorted({sensed.sights[0] for sensed in steps})
    tracker = walked(Tracker(LATTICE), steps, len(met))
    total = 0.0
    for label in (*met, 99):
        for doors in range(16):
            ways = tuple(float(doors >> way & 1) for way in range(4))
            checkpoint = tracker.checkpoint()
            total += exp(tracker.step(Sensed((label,), ways, 1), [len(met) + (label == 99)]))
            tracker.rollback(checkpoint)
    assert total == pytest.approx(1.0, abs=0.05)  # ways to known places off the chart are left to folding


def test_further_sensors_weigh_where_it_is():
    scheme = WayScheme(2, (1, 0), ((1,), (-1,)))
    room = {"ways": (1.0, 1.0)}
    tracker = Tracker(scheme)
    for action in (None, 0, 0, 1, 1):
        tracker.step(Sensed((0,), action=action, **room), [1])
    plain = tracker.checkpoint()
    evidence = tracker.step(Sensed((0,), action=0, **room), [1])
    expected = tracker.best.here
    tracker.rollback(plain)
    blamed = Sensed((0,), action=0, **room, others=lambda number: -40.0 if number == expected else 0.0)
    assert tracker.step(blamed, [1]) < evidence
    assert tracker.best.here != expected
    tracker.rollback(plain)
    evenly = Sensed((0,), action=0, **room, others=lambda number: -3.0)
    assert tracker.step(evenly, [1]) == pytest.approx(evidence - 3.0, abs=1e-9)
    assert tracker.best.here == expected
    assert tracker.history[tracker.time - 1].others is None


def test_a_hypothesis_is_read_by_names():
    tracker = walked(Tracker(LATTICE), percepts(1, 60, labels=9), 9)
    best = tracker.best
    assert all(
        open_probability(best, best.here, way) > 0.9 for way in range(4) if best.places[best.here].ways[way].net > 0
    )
    labels = label_probabilities(best, best.here)
    assert labels[best.places[best.here].label()] > 0.9
    assert sum(labels.values()) <= 1.0
    rates = {rate.name: rate for rate in rates_of(best)}
    assert rates["moved"].mean < 0.01
    assert rates["way_misread"].no > 100.0
    assert all(rate.meaning and 0.0 < rate.mean < 1.0 for rate in rates.values())
    way = next(k for k, w in enumerate(best.places[best.here].ways) if w.walks)
    assert where_to(best, best.here, way).to == best.places[best.here].ways[way].to


def test_what_it_is_told_of_a_move_is_believed():
    tracker = walked(Tracker(LATTICE), percepts(7, 80, labels=9), 9)
    best = tracker.best
    for number in list(best.places)[:3]:
        checkpoint = tracker.checkpoint()
        place = best.places[number]
        ways = tuple(float(w.net > 0) for w in place.ways)
        tracker.step(Sensed((place.label(),), ways, None, told=True), [9])
        assert tracker.best.here == number
        assert tracker.best.counts.yes == pytest.approx(tracker.best.counts.yes)
        assert tracker.evidence > log(0.5 / 9)
        tracker.rollback(checkpoint)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda header, arrays: None, "this is no state"),
        (lambda header, arrays: ({**header, "version": 99}, arrays), "version 99"),
        (lambda header, arrays: ({**header, "scheme": {}}, arrays), "other ways or sensors"),
        (lambda header, arrays: (header, {"whole": arrays["whole"]}), "damaged"),
        (lambda header, arrays: (header, {**arrays, "whole": arrays["whole"][:-1]}), "not those that were written"),
        (
            lambda header, arrays: (header, {**arrays, "real": np.append(arrays["real"], 1.0)}),
            "not those that were written",
        ),
        (lambda header, arrays: (header, {**arrays, "real": arrays["real"] * np.nan}), "damaged"),
        (lambda header, arrays: (header, {**arrays, "whole": arrays["whole"].astype(float)}), "no row of int64"),
        (lambda header, arrays: ({**header, "numbers": [20, 10_000, True, 0]}, arrays), "damaged"),
    ],
)
def test_states_that_are_none_are_refused(spoil, message):
    header, arrays = walked(Tracker(LATTICE), percepts(1, 20)).state()
    with pytest.raises(CogmapError, match=message):
        Tracker.restored(LATTICE, None, spoil(header, arrays))


def test_states_with_any_number_changed_are_refused():
    header, arrays = walked(Tracker(LATTICE), percepts(1, 25)).state()
    rng = np.random.default_rng(0)
    for name in ("whole", "real"):
        for _ in range(20):
            changed = arrays[name].copy()
            changed[rng.integers(len(changed))] += 1
            with pytest.raises(CogmapError, match="damaged"):
                Tracker.restored(LATTICE, None, (header, {**arrays, name: changed}))


def test_where_it_was_put_among_many_places_is_one_message_over_one_map():
    size, tracker = 5, Tracker(LATTICE)
    at, actions = (0, 0), [None]
    for row in range(size):
        actions += [3 if row % 2 == 0 else 2] * (size - 1) + [1] * (row < size - 1)
    at_of: dict[int, tuple[int, int]] = {}

    def sensed(action: int | None, *, seen: bool = True, told: bool = False) -> Sensed:
        ways = tuple(float(_beyond(at, way, size) != at) for way in range(4))
        return Sensed((at[0] * size + at[1] if seen else None,), ways, action, told=told)

    for action in actions:
        at = at if action is None else _beyond(at, action, size)
        tracker.step(sensed(action), [size * size])
        at_of[tracker.best.here] = at
    assert len(at_of) == size * size
    at = (2, 1)
    tracker.step(sensed(None, seen=False, told=True), [size * size])
    inner = [number for number, where in at_of.items() if min(where) > 0 and max(where) < size - 1]
    assert tracker.best.crowd is not None
    assert sum(whereabouts(tracker.best).values()) == pytest.approx(1.0, abs=1e-6)
    assert [whereabouts(tracker.best)[number] for number in inner] == pytest.approx([1 / 9] * 9, rel=0.1)
    assert tracker.certainty() < 0.2
    before, size_before = tracker.best.counts.yes, tracker.best.size
    other = Tracker.restored(LATTICE, None, tracker.state())
    for action in (0, 0, 2):
        at = _beyond(at, action, size)
        for one in (tracker, other):
            one.step(sensed(action, seen=False), [size * size])
    assert at_of[tracker.best.here] == at == (0, 0)
    assert tracker.certainty() > 0.95
    assert summary(tracker) == summary(other)
    assert tracker.best.size == size_before
    assert len(before) == len(tracker.best.counts.yes)
