"""What is said or measured of a move is evidence: displacement, outcome, and what was really done."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.inference.hypotheses import Sensed, Tracker, WayScheme
from cogmap.model import CogmapError, Features, Motions, Sight, Ways
from cogmap.model.factors.pose.odometry import odometry
from cogmap.planning import TERMS, Cost, Planner
from cogmap.worlds import load_world
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import GRID

from cogmap import UNSEEN


def walls(*open_: str) -> list[bool]:
    return [name in (*open_, "stay") for name in GRID]


def driven(name: str, seed: int, *, by_hand: int, measured: float | None, slip: float = 0.0, steps: int = 60) -> Agent:
    """An agent in a maze: led for some steps, then for itself; what is measured has noise, in shares of a move."""
    rng, world = np.random.default_rng(seed), load_world(name)
    observation, info = world.reset(seed=seed)
    agent = Agent(world.motions, seed=seed)
    for step in range(steps):
        action = agent.step(observation)
        assert agent.belief.moved < 0.01 or slip
        if step < by_hand:
            action = int(rng.choice(np.flatnonzero(observation["open"][:4])))
        done = int(rng.integers(5)) if rng.random() < slip else action
        before = info["position"]
        observation, *_, info = world.step(done)
        moved = np.subtract(info["position"], before)
        said: dict[str, Any] = {"taken": done} if step < by_hand else {}
        if measured is not None:
            said["displacement"] = moved + measured * np.linalg.norm(moved) * rng.normal(size=2)
        observation = {**observation, **said}
    return agent


@pytest.mark.parametrize(("name", "rooms"), [("4x4", 16), ("tolman", 23)])
def test_an_agent_that_is_driven_by_hand_finds_every_room_once_and_thinks_of_no_silent_move(name: str, rooms: int):
    agent = driven(name, 0, by_hand=12, measured=None)
    assert len(agent.map.places) == rooms


@pytest.mark.parametrize("noise", [0.0, 0.2])
def test_what_odometry_measured_says_which_move_was_made(noise: float) -> None:
    for seed in (0, 2):  # without it these agents have 27 and 24 places
        agent = driven("4x4", seed, by_hand=0, measured=noise, slip=0.3)
        assert len(agent.map.places) == 16
        assert {rate.name: rate.mean for rate in agent.learned_rates}["astray"] > 0.2


@pytest.mark.parametrize(
    ("measured", "there"), [([0.0, 1.0], (0, 1)), ([0.0, 0.0], (0, 0)), ([0.1, 0.8], (0, 1)), ([-0.1, 0.2], (0, 0))]
)
def test_a_measured_displacement_says_whether_it_moved(measured: list[float], there: tuple[int, int]) -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": "hall", "open": walls("right", "left")})
    agent.step({"sight": UNSEEN, "open": UNSEEN, "taken": "right", "displacement": measured})
    assert agent.map.position(agent.belief.place) == there


def test_a_measured_displacement_is_a_student_t_about_each_move() -> None:
    motions = Motions.of(GRID)
    told = odometry(motions, (0.05, 0.9))
    assert told.argmax() == 3
    assert told.max() == 0.0
    far = [np.sum(np.square(np.subtract((0.05, 0.9), move))) for move in motions.displacements]
    np.testing.assert_allclose(told, -2.5 * np.log1p(np.array(far) / 0.03) + 2.5 * np.log1p(min(far) / 0.03))
    assert np.ptp(odometry(motions, (300.0, 400.0))) < 0.05  # far off everything: it says hardly anything
    assert np.isfinite(odometry(motions, (1e300, -1e300))).all()


def test_a_way_that_the_body_found_blocked_is_believed_shut_and_one_that_it_took_open() -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": "hall", "open": UNSEEN})
    for _ in range(2):
        agent.step({"sight": "hall", "open": UNSEEN, "taken": "right", "outcome": "blocked"})
    assert agent.map.position(agent.belief.place) == (0, 0)
    assert agent.map.blocked(np.array([agent.belief.place]))[0, 3] > 0.9
    agent.step({"sight": "room", "open": UNSEEN, "taken": "down", "outcome": "arrived"})
    assert agent.map.position(agent.belief.place) == (1, 0)
    assert agent.map.blocked(np.array([0]))[0, 1] < 0.1
    assert agent.map.blocked(np.array([0]))[0, 3] > 0.9


def test_a_body_that_fails_and_says_so_leaves_the_map_right() -> None:
    rng, world = np.random.default_rng(0), load_world("4x4_alias")
    observation, _ = world.reset(seed=0)
    agent = Agent(world.motions, seed=0)
    for _ in range(80):
        action = agent.step(observation)
        failed = action != world.motions.names.index("stay") and rng.random() < 0.3
        observation, *_ = world.step(world.motions.names.index("stay") if failed else action)
        observation = {**observation, "outcome": "blocked" if failed else "arrived"}
    assert (len(agent.map.places), agent.map.visited.all()) == (16, True)
    assert {rate.name: rate.mean for rate in agent.learned_rates}["fails"] > 0.1


def test_a_body_that_is_not_sure_leaves_it_open_until_something_is_seen() -> None:
    certainty: dict[str | None, float] = {}
    for outcome in ("arrived", "unsure", None):
        agent = Agent(GRID, seed=0)
        agent.step({"sight": "hall", "open": walls("right", "left")})
        said = {} if outcome is None else {"outcome": outcome}
        agent.step({"sight": UNSEEN, "open": UNSEEN, "taken": "right", **said})
        certainty[outcome] = agent.belief.certainty
        assert agent.map.position(agent.belief.place) == (0, 1)
    assert certainty["arrived"] > certainty[None] > certainty["unsure"] + 0.1


def test_what_was_said_of_moves_is_kept_in_files(tmp_path: Any) -> None:
    agent = driven("4x4_alias", 3, by_hand=0, measured=0.2, slip=0.3, steps=25)
    agent.save(tmp_path / "agent.npz")
    again = Agent.load(tmp_path / "agent.npz")
    rng = np.random.default_rng(0)
    for _ in range(10):
        seen = {"sight": int(rng.integers(3)), "open": walls("right", "left"), "displacement": rng.normal(size=2)}
        assert again.step(seen) == agent.step(seen)
        assert again.belief.places == agent.belief.places
        assert [h.probability for h in again.hypotheses] == [h.probability for h in agent.hypotheses]


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ({"went": (0.0,)}, r"went is \(0.0,\); give 3 finite numbers, the largest 0"),
        ({"went": (0.0, -1.0, float("nan"))}, "give 3 finite numbers"),
        ({"went": (-1.0, -2.0, -3.0)}, "the largest 0"),
        ({"fails": 1.5}, "fails is 1.5; give a number from 0 to 1"),
    ],
)
def test_what_cannot_have_been_said_of_a_move_is_refused(said: dict[str, Any], message: str) -> None:
    tracker = Tracker(WayScheme(2, (1, 0), ((1,), (-1,))))
    with pytest.raises(CogmapError, match=message):
        tracker.step(Sensed((0,), (1.0, 1.0), **said), [1])


# -- what cannot be so -----------------------------------------------------------------------------------------

NUMBERS = st.floats(allow_nan=True, allow_infinity=True) | st.integers(-(10**9), 10**9)
NO_NUMBERS = st.none() | st.text(max_size=3) | st.booleans() | st.just(np.ma.masked) | st.lists(NUMBERS, max_size=2)
UNHASHABLE = st.lists(st.integers(), max_size=3) | st.builds(np.zeros, st.integers(1, 3))
NO_LABELS = UNHASHABLE | st.none() | st.just(float("nan")) | st.just(np.ma.masked) | st.tuples(st.just([]))
NO_LIKELIHOODS = (
    st.dictionaries(st.text(max_size=2), st.just(0.0), max_size=3)
    | st.dictionaries(st.text(max_size=2), st.floats(max_value=-1e-9), min_size=1, max_size=3)
    | st.dictionaries(st.text(max_size=2), NO_NUMBERS | st.just(np.inf), min_size=1, max_size=3)
    | st.just({UNSEEN: 1.0})
)
NO_LOOK = st.floats(max_value=-1e-9) | st.floats(min_value=1.001) | st.text() | st.just(float("nan"))
NO_WAYS = (
    st.lists(st.booleans(), max_size=9).filter(lambda ways: len(ways) != 5)
    | st.tuples(st.lists(st.booleans(), min_size=4, max_size=4), NO_LOOK).map(lambda parts: [*parts[0], parts[1]])
    | st.dictionaries(st.text(max_size=3).filter(lambda name: name not in GRID), st.booleans(), min_size=1)
    | NO_NUMBERS.filter(lambda value: not isinstance(value, list))
    | NUMBERS
)
NO_VECTORS = (
    st.lists(st.floats(-9, 9), max_size=6).filter(lambda numbers: len(numbers) != 3)
    | st.lists(st.just(float("nan")) | st.just(np.inf) | st.just(1e200), min_size=3, max_size=3)
    | NO_NUMBERS.filter(lambda value: not isinstance(value, list))
    | NUMBERS
    | st.builds(np.zeros, st.just((3, 1)))
)
BAD: dict[str, st.SearchStrategy[Any]] = {
    "sight": NO_LABELS | NO_LIKELIHOODS,
    "smell": NO_LABELS | NO_LIKELIHOODS,
    "view": NO_VECTORS,
    "open": NO_WAYS,
    "taken": st.integers().filter(lambda action: not 0 <= action < 5)
    | st.floats()
    | NO_NUMBERS.filter(lambda value: not (isinstance(value, str) and value in GRID)),
    "outcome": NO_NUMBERS | NUMBERS,
    "displacement": NO_VECTORS.filter(lambda value: np.shape(value) != (2,))
    | st.sampled_from([(1e200, 0.0), ("1", "2"), (True, False), "ab", (0.0, float("nan"))]),
    "turn": NO_NUMBERS | st.just(np.inf),
    "moved": NO_NUMBERS.filter(lambda value: not isinstance(value, bool)) | NUMBERS,
    "cost": NO_NUMBERS | st.floats(max_value=-1e-9) | st.just(float("nan")),
    "colour": st.integers(),
}


def sensing() -> Agent:
    """An agent of every kind of sensor that has seen something already."""
    agent = Agent(GRID, sensors=[Sight(), Sight("smell"), Features("view", size=3), Ways()], seed=0)
    for action in (None, "right"):
        seen = {"sight": "hall", "smell": {"tea": 1, "smoke": 0.2}, "view": [1, 0, 2], "open": walls("right", "left")}
        agent.perceive(seen if action is None else {**seen, "taken": action, "cost": 2.0})
        agent.act()
    return agent


SENSING = sensing()


@given(bad=st.sampled_from(sorted(BAD)).flatmap(lambda key: st.tuples(st.just(key), BAD[key])))
@settings(max_examples=100, deadline=None)
def test_whatever_is_no_percept_is_refused_in_a_line_and_leaves_the_agent_as_it_was(bad: tuple[str, Any]) -> None:
    key, value = bad
    before, arrays = SENSING.state()
    good = {"sight": "new", "smell": UNSEEN, "view": [9.0, 9, 9], "open": walls("up")}
    with pytest.raises(CogmapError) as raised:
        SENSING.step({**good, key: value})
    assert str(raised.value).startswith("observation: ")
    assert "\n" not in str(raised.value)
    after, again = SENSING.state()
    assert after == before
    assert arrays.keys() == again.keys()
    assert all(np.array_equal(arrays[name], again[name]) for name in arrays)


def test_of_ways_alike_the_cheapest_from_here_is_taken(tmp_path: Any) -> None:
    names, seen = [*GRID], {"sight": "hall", "open": [True] * len(GRID)}
    for cheap in ("left", "down", "up"):
        costs = {name: 2.0 if name == cheap else 6.0 for name in names if name != "stay"}
        for told in (costs, [costs.get(name) for name in names]):
            agent = Agent(GRID, seed=1)
            agent.perceive({**seen, "costs": told})
            agent.save(tmp_path / "agent.npz")
            assert names[Agent.load(tmp_path / "agent.npz").act()] == cheap
            assert names[agent.act()] == cheap
    for bad in ([1.0], {"up": -1.0}, [np.nan] * 5, [True] * 5, "dear", "12345"):
        with pytest.raises(CogmapError, match=r"'costs' is .*; give each action a finite number of 0 or more, or None"):
            agent.step({**seen, "costs": bad})
    with pytest.raises(CogmapError, match="'costs' has 'upp'; give costs of actions by name: up"):
        agent.step({**seen, "costs": {"upp": 1.0}})


def test_what_moves_cost_is_counted_and_kept(tmp_path: Any) -> None:
    agent = Agent(GRID, planner=Planner(terms=[*TERMS, Cost(price=0.5)]), seed=0)
    seen = {"sight": "hall", "open": walls("right", "left")}
    agent.step(seen)
    assert (agent.cost, agent.trace[-1].cost, agent.plan.model.costs) == (0.0, None, None)
    for cost in (3.0, 5.0):
        agent.step({**seen, "taken": "right", "cost": cost})
    assert (agent.cost, agent.trace[-1].cost) == (8.0, 5.0)
    np.testing.assert_allclose(agent.plan.model.costs, [4.0, 4.0, 4.0, 4.0, 0.0])  # to stay costs nothing
    agent.save(tmp_path / "agent.npz")
    again = Agent.load(tmp_path / "agent.npz")
    assert (again.cost, again.planner.terms) == (8.0, agent.planner.terms)
    assert again.step({**seen, "cost": 1.0}) == agent.step({**seen, "cost": 1.0})
    assert again.trace[-1].G == agent.trace[-1].G
