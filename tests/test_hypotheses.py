"""Hypotheses about the map: mathematics against closed forms and sums, behaviour in small worlds."""

from __future__ import annotations

from itertools import product
from math import exp, log

import numpy as np
import pytest
from cogmap.inference.hypotheses import NOWHERE, Hypothesis, Sensed, Tracker, TrackerOptions, WayScheme
from cogmap.inference.hypotheses.branches import branches, leads
from cogmap.inference.hypotheses.chances import Chances
from cogmap.inference.hypotheses.evidence import (
    before_reading,
    both_sides,
    probability,
    reading_probability,
    readings_probability,
    same_door,
    way_odds,
)
from cogmap.inference.hypotheses.layered import Layered
from cogmap.inference.hypotheses.pruning import alike
from cogmap.inference.hypotheses.rates import (
    ASTRAY,
    BLAMED,
    ELSEWHERE,
    FAILS,
    MOVED,
    RATE_PRIORS,
    SQUARE,
    STAYED,
    WAY_MISREAD,
    RateCounts,
    crp_evidence,
    crp_predictive,
)
from cogmap.inference.hypotheses.recharting import recharted
from cogmap.inference.hypotheses.squares import across, tally
from cogmap.inference.hypotheses.straightening import straightened
from cogmap.model import CogmapError, reduced, with_period
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.stats import beta

STEPS = ((-1, 0), (1, 0), (0, -1), (0, 1))
LATTICE = WayScheme(4, (1, 0, 3, 2), STEPS)
UNPLACED = WayScheme(4, (1, 0, 3, 2))


THREE_LABELS = "UUUUUUUUUURRRRRRRRRDDDDULLLLLURUURURRULLURRLLDDDDD"
"""A walk on a torus."""


class Grid:
    """A grid of sights, perhaps closed on itself, and where the agent is."""

    def __init__(self, sights: list[list[int]], *, wrap: bool = False, at: tuple[int, int] = (0, 0)) -> None:
        self.sights, self.wrap, self.at = sights, wrap, at

    def beyond(self, way: int) -> tuple[int, int]:
        r, c = (x + d for x, d in zip(self.at, STEPS[way], strict=True))
        rows, columns = len(self.sights), len(self.sights[0])
        if self.wrap:
            return r % rows, c % columns
        return (r, c) if 0 <= r < rows and 0 <= c < columns else self.at

    def percept(self, action: int | None = None) -> Sensed:
        if action is not None:
            self.at = self.beyond(action)
        open_ = tuple(float(self.beyond(way) != self.at) for way in range(4))
        return Sensed((self.sights[self.at[0]][self.at[1]],), open_, action)


def walk(tracker: Tracker, world: Grid, actions: str) -> None:
    for action in ([None] if not tracker.hypotheses else []) + ["UDLR".index(a) for a in actions]:
        percept = world.percept(action)
        tracker.step(percept, [1 + max(max(row) for row in world.sights)])


@given(st.lists(st.tuples(st.integers(-6, 6), st.integers(-6, 6)), min_size=1, max_size=3), st.data())
@settings(max_examples=60)
def test_positions_are_one_exactly_where_periods_lie_between_them(vectors, data):
    periods = ()
    for vector in vectors:
        if any(vector):
            periods = with_period(periods, vector)
    position = data.draw(st.tuples(st.integers(-9, 9), st.integers(-9, 9)))
    times = data.draw(st.tuples(*(st.integers(-3, 3) for _ in vectors)))
    moved = tuple(x + sum(t * v[axis] for t, v in zip(times, vectors, strict=True)) for axis, x in enumerate(position))
    assert reduced(moved, periods) == reduced(position, periods)
    apart = tuple(a - b for a, b in zip(position, reduced(position, periods), strict=True))
    if len(periods) == 2:
        coefficients = np.linalg.solve(np.array(periods, dtype=float).T, np.array(apart, dtype=float))
        assert np.allclose(coefficients, np.round(coefficients))


@pytest.mark.parametrize("prior", RATE_PRIORS, ids=lambda prior: prior.name)
@pytest.mark.parametrize(("yes", "no"), [(0.0, 0.0), (1.0, 7.0), (6.5, 30.0)])
def test_what_is_expected_of_a_rate_is_the_integral_over_its_prior(prior, yes, no):
    def density(x: float) -> float:
        return sum(w * beta.pdf(x, a, b) for w, a, b in prior.parts)

    def integral(more: float) -> float:
        f = lambda x: density(x) * x ** (yes + more) * (1 - x) ** no  # noqa: E731
        return sum(
            quad(f, a, b, limit=200)[0] for a, b in [(0, 1e-4), (1e-4, 1e-2), (1e-2, 0.2), (0.2, 0.99), (0.99, 1)]
        )

    assert prior.log_evidence(yes, no) == pytest.approx(log(integral(0.0)), abs=1e-5)
    assert prior.mean(yes, no) == pytest.approx(integral(1.0) / integral(0.0), rel=1e-4)


@pytest.mark.parametrize(
    ("seen", "failed"), [(0.0, (0.24, 0.28)), (30.0, (0.0, 0.01))], ids=["never elsewhere", "elsewhere as often"]
)
def test_what_did_not_lead_on_is_blamed_on_the_rate_that_explains_all_of_it(seen, failed):
    """100 of 400 moves did not lead on, in corridors: of other actions three in four would not have either."""
    counts = RateCounts()
    counts.yes[STAYED], counts.no[STAYED] = 100.0, 75.0
    counts.no[FAILS], counts.yes[ASTRAY], counts.no[ASTRAY] = 300.0, seen, 300.0 - seen
    counts.yes[BLAMED] = 1.0 if seen else 0.0  # whatever was thought of first
    counts.blame()
    assert failed[0] <= counts.mean(FAILS) <= failed[1]
    assert counts.mean(ASTRAY) == pytest.approx((seen + 100.0) / 400.0 if seen else 0.0, abs=0.02)
    assert sum(counts.of(ASTRAY)) == pytest.approx(400.0)


@given(st.lists(st.integers(0, 4), min_size=1, max_size=12))
def test_a_seating_is_as_probable_as_its_guests_one_after_the_other(labels):
    from math import lgamma

    total, tables = 0.0, {}
    for places, label in enumerate(labels):
        total += log(crp_predictive(tables.get(label, 0), len(tables), places))
        tables[label] = tables.get(label, 0) + 1
    closed = crp_evidence(len(tables), len(labels)) + sum(lgamma(n) for n in tables.values())
    assert total == pytest.approx(closed, abs=1e-9)


@given(st.floats(-4, 4), st.floats(-4, 4))
def test_the_evidence_of_a_door_is_the_sum_over_its_states(mine, its):
    chances = Chances(RateCounts(), [3])
    p, same = chances.open, chances.undone
    like = {True: lambda net: exp(net * chances.unit / 2), False: lambda net: exp(-net * chances.unit / 2)}
    total = 0.0
    for here, there in product((True, False), repeat=2):
        prior = (p if here else 1 - p) * (same * (here == there) + (1 - same) * (p if there else 1 - p))
        total += prior * like[here](mine) * like[there](its)
    assert sum(both_sides(chances, mine, its, open_=chances.open)) == pytest.approx(total, rel=1e-9)


@pytest.mark.parametrize("scheme", [LATTICE, UNPLACED])
def test_what_may_be_sensed_adds_up_to_one(scheme):
    tracker = Tracker(scheme)
    world = Grid([[0, 1], [2, 0]])
    walk(tracker, world, "RDL")
    h = tracker.best
    total = 0.0
    for label, flags in product(range(4), product((0.0, 1.0), repeat=4)):  # 3 is a label never met
        h.chances = Chances(h.counts, [4], size=h.size)
        found = branches(h, Sensed((label,), flags, 0), drop=200.0)
        total += sum(exp(branch.weight - h.weight) for branch in found)
    place = h.places[h.here]
    left = 0.0  # ways that lead to known places off the chart, or without one, are left to folding
    for way in range(4):
        lead = leads(h, h.here, place, way)
        given = 1.0 - h.chances.astray if way == 0 else h.chances.astray / 4
        left += given * probability(way_odds(h, h.here, place, way)) * (1.0 - lead.sure - lead.new - lead.off)
    assert total + left == pytest.approx(1.0, abs=2e-3)


def test_a_fork_changes_apart_from_its_origin_and_settles():
    one: Layered[str, int] = Layered()
    one["a"], one["b"] = 1, 2
    one.settle()
    mark = one.mark
    other = one.fork()
    other["a"], other["c"] = 3, 4
    del other["b"]
    assert (one["a"], one.get("b"), one.get("c")) == (1, 2, None)
    assert sorted(other) == ["a", "c"]
    other.settle()
    assert (other["a"], other.get("b"), other["c"]) == (3, None, 4)
    past = other.as_of(mark)
    assert past is not None
    assert ({key: past[key] for key in past}, past.get("c")) == ({"a": 1, "b": 2}, None)
    for value in range(5000):
        other["a"] = value
        other.settle()
    assert other.as_of(mark) is None


def test_what_forks_have_in_common_is_shared():
    one: Layered[str, object] = Layered()
    one["a"], one["b"], one["c"] = object(), object(), object()
    other = one.fork()
    other["b"] = "another"
    del other["c"]
    before = [{key: h.get(key) for key in "abcd"} for h in (one, other)]
    Layered.settle_alike([one, other])
    assert [{key: h.get(key) for key in "abcd"} for h in (one, other)] == before
    assert "a" not in one.layers[1]
    assert "a" not in other.layers[1]


def test_a_torus_is_found_to_close_on_itself():
    tracker = Tracker(LATTICE)
    world = Grid([[0, 1, 2], [3, 4, 5], [6, 7, 8]], wrap=True)
    walk(tracker, world, "RRRDRRDRRDLU")
    assert tracker.best.size == 9
    assert tracker.best.periods
    assert tracker.certainty() > 0.95


def test_a_map_of_what_was_taken_for_one_too_early_is_begun_anew():
    """On a torus of three labels four places explain the first steps, and they are wrong ever after."""
    tracker = Tracker(LATTICE, TrackerOptions(most=10))
    world = Grid([[(r + c) % 3 for c in range(4)] for r in range(4)], wrap=True, at=(0, 3))
    walk(tracker, world, THREE_LABELS[:40])
    assert tracker.best.size != 16
    walk(tracker, world, THREE_LABELS[40:])
    assert tracker.best.size == 16
    assert tracker.best.periods == {0: ((4, 0), (0, 4))}
    assert min(tracker.best.places) > 0, "places are called by the time of their first visit"


def test_ways_of_a_known_place_were_expected_as_those_of_a_new_one():
    tracker = Tracker(LATTICE)
    walk(tracker, Grid([[0, 1, 2, 3, 4, 5, 6]]), "RRRRRR")
    h = tracker.best
    up, first, last = 0, min(h.places), max(h.places)
    expected = {k: before_reading(h, k, h.places[k], up, h.places.__getitem__, int) for k in (first, last)}
    assert expected[first] == h.open(up)
    assert expected[last] < 0.8 * h.open(up)


def test_places_are_recognised_without_poses():
    tracker = Tracker(UNPLACED)
    world = Grid([[0, 0, 1], [2, 0, 4], [3, 3, 3]])
    walk(tracker, world, "RRDLLDRRLURULLDR")
    assert tracker.best.size == 9
    assert tracker.certainty() > 0.95


def test_what_stays_open_for_hundreds_of_steps_is_told_by_the_walk_back():
    tracker, world = Tracker(LATTICE), Grid([[*range(20), *range(19, 269)]])
    walk(tracker, world, "R" * 269)  # two rooms look the same: they may be one, and a move have failed
    weights = [exp(h.weight) for h in tracker.hypotheses]
    assert {h.size for h in tracker.hypotheses} == {269, 270}
    assert 0.02 < sum(p for h, p in zip(tracker.hypotheses, weights, strict=True) if h.size == 270) < 0.5
    walk(tracker, world, "L" * 269)
    assert tracker.best.size == 270


def test_a_silent_move_joins_what_was_mapped_before_and_after():
    tracker = Tracker(LATTICE)
    world = Grid([[0, 1, 2, 3], [4, 5, 6, 7], [8, 9, 10, 11]])
    walk(tracker, world, "RDL")
    world.at = (2, 3)
    walk(tracker, world, "ULLL")
    best = tracker.best
    assert len({best.places[k].frame for k in best.places}) == 1
    assert best.size == 6  # 0 1 5 4 7 6, of which 5 and 4 were seen before and after


def test_misread_sights_and_doors_invent_no_places():
    rng, tracker = np.random.default_rng(3), Tracker(LATTICE)
    world = Grid([[0, 1, 2], [3, 4, 5], [6, 7, 8]])
    for step in range(150):
        percept = world.percept(
            None if step == 0 else int(rng.choice([w for w in range(4) if world.beyond(w) != world.at]))
        )
        sight = percept.sights[0] if rng.random() > 0.1 else int(rng.integers(9))
        ways = tuple(abs(way - float(rng.random() < 0.1)) for way in percept.ways)  # type: ignore[operator]
        tracker.step(Sensed((sight,), ways, percept.action), [9])
    assert tracker.best.size == 9
    assert tracker.best.counts.mean(2) == pytest.approx(0.1, abs=0.04)


def test_a_way_that_was_never_looked_at_and_leads_nowhere_is_a_wall():
    """Bumping into a wall, and into twins of the room for ever, look the same; a circle of one twin is the wall."""
    tracker = Tracker(WayScheme(2, (1, 0)))
    for action in (None, 0, 0, 0, 1, 0, 1):
        tracker.step(Sensed((0,), (None, None), action), [1])
    assert (tracker.best.size, tracker.best.counts.of(FAILS)[0]) == (1, pytest.approx(0.0, abs=0.1))
    for h in tracker.hypotheses:
        assert not any(way.to == number for number in h.places for way in h.places[number].ways)


def test_hypotheses_that_say_the_same_are_found_alike():
    tracker = Tracker(LATTICE)
    walk(tracker, Grid([[0, 1], [2, 3]]), "RDLU")
    fork = tracker.best.fork()
    assert alike(fork, tracker.best)
    place = fork.places[fork.here]
    fork.put(
        fork.here,
        place._replace(ways=(place.ways[0]._replace(to=NOWHERE), *place.ways[1:3], place.ways[3]._replace(to=NOWHERE))),
    )
    assert not alike(fork, tracker.best)


def test_weights_add_up_to_one_at_every_step():
    tracker = Tracker(LATTICE)
    world = Grid([[0, 0, 1], [2, 0, 4], [3, 3, 3]])
    walk(tracker, world, "")
    for action in "RRDLDRULLURD":
        walk(tracker, world, action)
        assert sum(exp(h.weight) for h in tracker.hypotheses) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("sensed", "message"),
    [
        (Sensed((0,), (1.0,)), "1 sights and 1 ways; give 1 and 4"),
        (Sensed((), (1.0,) * 4), "0 sights and 4 ways"),
        (Sensed((0,), (float("nan"), 1.0, 1.0, 1.0)), r"P\(open\) is nan"),
        (Sensed((0,), (1.5, 1.0, 1.0, 1.0)), r"P\(open\) is 1.5"),
        (Sensed((0,), (1.0,) * 4, action=4), "action is 4; give 0 to 3"),
        (Sensed(({0: -1.0},), (1.0,) * 4), "are no likelihoods"),
        (Sensed(({0: 0.0},), (1.0,) * 4), "are no likelihoods"),
        (Sensed(("red",), (1.0,) * 4), "sight is 'red'; give the number of a label"),  # type: ignore[arg-type]
    ],
)
def test_what_cannot_have_been_sensed_is_refused(sensed, message):
    tracker = Tracker(LATTICE)
    with pytest.raises(CogmapError, match=message):
        tracker.step(sensed, [1])
    assert not tracker.hypotheses


def test_trackers_that_cannot_work_are_refused():
    with pytest.raises(CogmapError, match="it has sensed nothing yet"):
        _ = Tracker(LATTICE).best
    with pytest.raises(CogmapError, match="give how many each of 1 sensors has"):
        Tracker(LATTICE).step(Sensed((0,), (1.0,) * 4), [])
    with pytest.raises(CogmapError, match="most >= 1"):
        TrackerOptions(most=0)
    with pytest.raises(CogmapError, match="fragments >= 1"):
        TrackerOptions(fragments=0)
    with pytest.raises(CogmapError, match="name each of the 4 ways once"):
        WayScheme(4, (1, 0))
    with pytest.raises(CogmapError, match="one vector for each"):
        WayScheme(4, (1, 0, 3, 2), ((1, 0),))
    with pytest.raises(CogmapError, match="0 ways"):
        WayScheme(0)


def test_a_link_off_the_chart_that_the_other_side_denies_was_a_silent_move():
    tracker = Tracker(LATTICE)
    walk(tracker, Grid([[0, 1, 2], [3, 4, 5], [6, 7, 8]]), "RRLLDRRLLDRRUULL")
    h = tracker.best.fork()
    h.chances = Chances(h.counts, [10], size=h.size)
    here = next(k for k in h.places if h.places[k].position == (0, 1))
    way = h.places[here].ways[3]
    far = next(k for k in h.places if h.places[k].position == (2, 0))
    assert h.beside(h.places[here], 3) == way.to
    crooked = (*h.places[here].ways[:3], way._replace(walks=1, to=far))
    h.put(here, h.places[here]._replace(ways=crooked))
    h.put(far, h.places[far]._replace(into=h.places[far].into | {(here, 3)}))
    straight = straightened(h, here, floor=-1e9)
    assert straight is not None
    assert (straight.places[here].ways[3].to, straight.places[here].ways[3].walks) == (way.to, 0)
    assert (here, 3) not in straight.places[far].into
    assert straight.counts.yes[MOVED] == h.counts.yes[MOVED] + 1.0
    assert straightened(h, here, floor=h.weight + 100.0) is None
    assert all(straightened(tracker.best, number, floor=-1e9) is None for number in tracker.best.places)


def test_a_loop_that_does_not_close_on_the_chart_may_have_been_a_silent_move():
    """Moved from the lower right corner into the upper one: the chart has the rooms from there on too low."""
    world, tracker = Grid([[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11]]), Tracker(LATTICE)
    walk(tracker, world, "DDDRR")
    world.at = (1, 2)
    walk(tracker, world, "ULL")  # up to (0, 2), which the chart has above the corner
    h = next(h for h in tracker.hypotheses if h.places[h.here].label() == 0 and h.counts.yes[ELSEWHERE])
    assert h.places[h.here].position == (0, 0)
    odd = next(source for source, way in h.places[h.here].into if way == 2)
    maps = list(recharted(h, odd, floor=-1e9))
    assert maps
    right = [other for other in maps if {k: other.places[k].position for k in (6, 7)} == {6: (0, 2), 7: (0, 1)}]
    cut = [other for other in right if other.counts.yes[MOVED] == h.counts.yes[MOVED] + 1.0]
    assert any(other.places[5].ways[0].to == NOWHERE and other.counts.yes[ELSEWHERE] == 0.0 for other in cut)
    assert not list(recharted(h, odd, floor=h.weight + 100.0))
    assert all(other.weight > h.weight - 12.0 for other in cut)


def test_three_sides_of_a_square_say_where_its_fourth_leads_as_often_as_they_did():
    tracker = Tracker(UNPLACED)
    walk(tracker, Grid([[0, 1, 2], [3, 4, 5], [6, 7, 8]]), "RDLU")
    h = tracker.best
    assert h.size == 4
    assert (h.counts.yes[SQUARE], h.counts.no[SQUARE]) == (1.0, 0.0)
    assert tally(h, list(h.places)) == (1.0, 0.0)
    walk(tracker, Grid([[0, 1, 2], [3, 4, 5], [6, 7, 8]], at=(0, 0)), "RRD")
    h = tracker.best
    place, middle = h.places[h.here], next(k for k in h.places if h.places[k].label() == 4)
    assert place.ways[2].to == NOWHERE
    assert across(h, place, 2) == h.neighbour(place, 2) == middle
    lead = leads(h, h.here, place, 2)
    assert (lead.to, lead.sure) == (middle, h.chances.square)
    walk(tracker, Grid([[0, 1, 2], [3, 4, 5], [6, 7, 8]], at=(1, 2)), "D")
    h = tracker.best
    assert across(h, h.places[h.here], 2) == NOWHERE  # two sides only


def test_squares_that_do_not_close_are_counted_and_not_expected():
    tracker, at, rng = Tracker(WayScheme(2)), 0, np.random.default_rng(3)
    tracker.step(Sensed((0,), (1.0, 1.0)), [8])
    for _ in range(60):
        action = int(rng.integers(2))
        at = (5 * at + 2) % 8 if action else (at + 1) % 8  # 5k + 3 in one order, 5k + 7 in the other
        tracker.step(Sensed((at,), (1.0, 1.0), action), [8])
    h = tracker.best
    assert h.size == 8
    assert (h.counts.yes[SQUARE], h.counts.no[SQUARE]) == tally(h, list(h.places)) == (0.0, 8.0)
    assert h.chances.square < 0.1


@pytest.mark.parametrize("sights", [[[0, 0, 1], [2, 0, 4], [3, 3, 3]], [[0, 1, 0], [1, 2, 1], [0, 1, 0]]])
def test_squares_spare_an_agent_without_poses_the_walk_along_every_way(sights):
    tracker = Tracker(UNPLACED)
    walk(tracker, Grid(sights), "RDLURRDDLLUR")
    h, inferred = tracker.best, 0
    at = {h.here: (1, 1)}
    for number in (queue := [h.here]):
        for way, (down, right) in enumerate(STEPS):
            r, c = at[number][0] + down, at[number][1] + right
            to = h.neighbour(h.places[number], way)
            if 0 <= r < 3 and 0 <= c < 3 and to != NOWHERE:
                assert at.setdefault(to, (r, c)) == (r, c)
                inferred += h.places[number].ways[way].to == NOWHERE
                queue += [to] if to not in queue else []
    assert h.size == len(at) == 9
    assert inferred >= 2


@given(st.floats(-3, 3), st.floats(-3, 3))
def test_whether_two_sides_are_one_door_is_what_was_read_of_both(mine, its):
    tracker = Tracker(LATTICE)
    walk(tracker, Grid([[0, 1]]), "R")
    h = tracker.best.fork()
    one, other = h.places[0], h.places[1]
    sides = (
        (*one.ways[:3], one.ways[3]._replace(net=mine)),
        (*other.ways[:2], other.ways[2]._replace(net=its), other.ways[3]),
    )
    h.put(1, other._replace(ways=sides[1]))
    chances, total = h.chances, {True: 0.0, False: 0.0}
    for here, there, same in product((True, False), repeat=3):
        p = (chances.open if here else 1 - chances.open) * (chances.undone if same else 1 - chances.undone)
        p *= float(here == there) if same else chances.open if there else 1 - chances.open
        total[same] += p * exp(
            (mine if here else -mine) * chances.unit / 2 + (its if there else -its) * chances.unit / 2
        )
    found = same_door(h, one._replace(ways=sides[0]), 3, 1, 0)
    if mine == 0.0 or its == 0.0:
        assert found is None
    else:
        assert found == pytest.approx(total[True] / (total[True] + total[False]), abs=1e-9)


def test_a_room_of_which_several_doors_are_shut_at_once_is_the_same_room():
    tracker, grid = Tracker(LATTICE), Grid([[0, 0, 1], [2, 0, 4], [3, 3, 3]])
    walk(tracker, grid, "RRDDLLUURDURDLRDULDRUULDLURRDDUU")
    assert (tracker.best.size, len(tracker.hypotheses), grid.at) == (9, 1, (0, 2))

    def seen(action: int) -> Sensed:
        percept = grid.percept(action)
        middle = (0.0, 0.0, 1.0, 0.0)
        return Sensed(percept.sights, middle if grid.at == (1, 1) else percept.ways, action)

    for action in (2, 2, 1, 3, 2, 0, 1, 3, 2, 0):  # into the middle from the left, three times
        tracker.step(seen(action), [5])
    assert tracker.best.size == 9
    middle = next(k for k in tracker.best.places if tracker.best.places[k].position == (1, 1))
    opened = [probability(way_odds(tracker.best, middle, tracker.best.places[middle], way)) for way in range(4)]
    assert [p > 0.5 for p in opened] == [False, False, True, False]
    assert exp(tracker.best.weight) > 0.9


def test_a_bump_and_what_is_then_read_of_the_door_are_one_event() -> None:
    tracker, wall = Tracker(LATTICE), (0.0, 0.0)
    for label in range(8):  # along a corridor of rooms that all differ, to a last door that was misread
        tracker.step(Sensed((label,), (float(label > 0), 1.0, *wall), None if label == 0 else 1), [label + 1])
    tracker.step(Sensed((7,), (1.0, 0.0, *wall), 1), [8])
    best = tracker.best
    assert (best.size, best.here) == (8, 7)
    assert exp(best.weight) > 0.5  # the door was misread once; not twice, and the move failed as well


def test_of_several_readings_some_are_wrong_together() -> None:
    counts = RateCounts()
    counts.yes[WAY_MISREAD], counts.no[WAY_MISREAD] = 2.0, 30.0
    chances = Chances(counts, [2])
    readings = [(0.99, 0.0), (0.98, 0.0), (0.01, 1.0), (0.5, 0.3)]
    expected = 0.0
    for weight, wrong in RATE_PRIORS[WAY_MISREAD].posterior(2.0, 30.0):
        as_open = [p * (1.0 - wrong) + (1.0 - p) * wrong for p, _ in readings]
        each = [r * p + (1.0 - r) * (1.0 - p) for (_, r), p in zip(readings, as_open, strict=True)]
        expected += weight * float(np.prod(each))
    together = readings_probability(chances, readings)
    assert together == pytest.approx(expected)
    assert together > float(np.prod([reading_probability(chances, *one) for one in readings]))


def test_a_slip_stays_no_oftener_than_evenly() -> None:
    h = Hypothesis(LATTICE)
    for taken, times in ((NOWHERE, 50), (1, 3), (2, 5), (3, 4)):
        h.slipped(0, taken, float(times))
    assert h.slip(0, NOWHERE) == pytest.approx(1.0 / 4)
    assert sum(h.slip(0, taken) for taken in (NOWHERE, 1, 2, 3)) == pytest.approx(1.0)
    assert h.slip(0, 2) > h.slip(0, 3) > h.slip(0, 1)  # the pattern of the others is as it was learned
