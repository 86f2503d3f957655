"""The agent's loop: repeatable, traced, gated by certainty, drawn to what it prefers."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings, StepRecord
from cogmap.model import TEXT_RATES, CogmapError
from cogmap.planning import Outward, Plan
from cogmap.worlds import MazeEnv, load_world
from parts import agent_with
from walks import GRID, STAY, assert_same_belief, assert_same_map, walk, walked

PLAIN: dict[str, Any] = {"sight": 0, "open": [True] * 5}


# -- repeatable ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "settings"),
    [
        ("4x4_alias", {"look_ahead": 2}),
        ("4x4_alias", {"look_ahead": 2, "choice": "sampled"}),
        ("donut", {"look_ahead": 2, "policies": "l_shaped", "engine": "gtsam", "rates": TEXT_RATES}),
    ],
)
def test_the_same_seed_is_the_same_walk(name: str, settings: dict[str, Any]) -> None:
    runs = []
    for _ in range(2):
        world = load_world(name)
        agent = agent_with(world.motions, **settings, seed=7)
        runs.append((list(walk(world, agent, 25, seed=4, displace_every=6)), agent))
    (actions, one), (again, other) = runs
    assert actions == again
    assert one.trace == other.trace
    assert_same_map(one.map, other.map)
    assert_same_belief(one, other)


def test_seeds_break_ties_differently() -> None:
    first = {Agent(GRID, settings=Settings(look_ahead=2), seed=seed).step(PLAIN) for seed in range(12)}
    assert len(first) > 1


def test_settings_are_not_shared_and_observations_are_not_kept() -> None:
    one, other = Agent(GRID, seed=0), Agent(GRID, seed=0)
    doors = np.array([True] * 5)
    action = one.step({"sight": 0, "open": doors})
    doors[:] = False
    assert one.trace[0].open == (True,) * 5
    assert other.steps == 0
    assert len(other.map.places) == 1
    assert other.step(PLAIN) == action


# -- before the first step, and bad arguments ------------------------------------------------------------------


def test_nothing_is_believed_or_planned_before_the_first_step() -> None:
    agent = Agent(GRID, seed=0)
    with pytest.raises(CogmapError, match=r"agent: it has seen nothing yet; call step\(observation\) first"):
        _ = agent.belief
    with pytest.raises(CogmapError, match=r"agent: it has planned nothing yet; call step\(observation\) first"):
        _ = agent.plan
    with pytest.raises(CogmapError, match="seen nothing yet"):
        _ = agent.certain
    assert agent.graph.variables == ()
    assert (agent.steps, agent.trace) == (0, [])
    assert repr(agent) == "Agent(CognitiveMap(1 places, 0 visited, 1 positions, 0 sights), step 0)"
    agent.step(PLAIN)
    assert agent.certain
    assert isinstance(agent.plan, Plan)
    assert agent.belief.places == {0: 1.0}


@pytest.mark.parametrize("motions", [None, {}, {"stay": (0,), "left": (-1,)}, 3])
def test_motions_that_make_no_sense(motions: Any) -> None:
    with pytest.raises(CogmapError, match=r"^(motions|agent): "):
        Agent(motions)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_preferences_must_be_finite(value: float) -> None:
    agent = Agent(GRID, seed=0)
    with pytest.raises(
        CogmapError, match=r"agent: preference .* of 'hall' is not a finite number; give a log preference"
    ):
        agent.prefer({"kitchen": 1.0, "hall": value})
    agent.step(PLAIN)
    assert agent.trace[-1].G.get("utility", 0.0) == 0.0


# -- trace -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "goals"), [("4x4_alias", {}), ("3x3", {4: 2.0, "elsewhere": 1.0})])
def test_every_record_is_consistent(name: str, goals: dict[Any, float]) -> None:
    world = load_world(name)
    agent = Agent(world.motions, settings=Settings(look_ahead=3), seed=2)
    agent.prefer(goals)
    seen: list[dict[str, Any]] = []

    def observe(observation: dict[str, Any]) -> dict[str, Any]:
        seen.append(observation)
        return observation

    for step, action in enumerate(walk(world, agent, 30, seed=5, displace_every=7, observe=observe)):
        assert len(agent.trace) == agent.steps == step + 1
        assert_record(agent, agent.trace[-1], step, action, seen[-1])
    assert [record.step for record in agent.trace] == list(range(30))
    grown = [event for record in agent.trace for event in record.grown]
    assert grown == agent.map.growth[2:]  # the first two came before the first step
    assert_lessons_add_up(agent)


def assert_record(agent: Agent, record: StepRecord, step: int, action: int, seen: dict[str, Any]) -> None:
    belief, plan = agent.belief, agent.plan
    assert (record.step, record.sight, record.open) == (step, seen["sight"], tuple(seen["open"].tolist()))
    assert record.places == belief.places
    assert max(record.places.values()) == next(iter(record.places.values()))
    assert record.certainty == belief.certainty == max(record.places.values()) * (1.0 - record.doubt)
    assert record.certain == (record.certainty >= agent.settings.certainty) == agent.certain
    assert (record.evidence, record.complexity, record.accuracy) == (
        belief.evidence,
        belief.complexity,
        belief.accuracy,
    )
    assert (record.moved, record.dropped) == (belief.moved, belief.dropped)
    assert record.action == action == plan.action == record.policy[0]
    assert record.policy == tuple(plan.policy.tolist())
    assert record.probability == plan.probability[plan.chosen]
    assert record.policies == len(plan.policies)
    terms = {name: value for name, value in record.G.items() if name != "G"}
    signs = {term.name: term.sign for term in record.terms}
    signed = [signs[name] * value for name, value in terms.items()]
    assert record.G["G"] == pytest.approx(sum(signed), abs=1e-9)
    assert all(value >= -1e-9 for name, value in terms.items() if name != "utility")
    assert record.G["G"] <= plan.expected_free_energy.G.min() + Outward().slack  # one of the best was chosen


def assert_lessons_add_up(agent: Agent) -> None:
    """The lessons of the trace are all that the tables ever learned."""
    learned: Counter[tuple[str, int, int]] = Counter()
    for record in agent.trace:
        for lesson in record.learned:
            row = lesson.place if lesson.action is None else agent.map.row(lesson.place, lesson.action)
            learned[lesson.table, row, lesson.outcome] += lesson.amount  # type: ignore[assignment]
    for name in ("A_o", "A_p", "B_s"):
        state = getattr(agent.map, name).state()
        for row, slot in zip(*np.nonzero(state["evidence"]), strict=True):
            key = (name, int(row), int(state["keys"][row, slot]))
            assert learned.pop(key) == pytest.approx(state["evidence"][row, slot], abs=1e-9)
    assert all(abs(rest) < 1e-9 for rest in learned.values())


def test_records_know_their_free_energy() -> None:
    agent = walked(load_world("3x3"), 12)
    for record in agent.trace:
        assert record.free_energy == pytest.approx(record.complexity - record.accuracy)


# -- the gate --------------------------------------------------------------------------------------------------


def test_an_agent_that_was_moved_learns_nothing_wrong() -> None:
    """After silent moves within a map, every place still has the sight of the one room it stands for."""
    world, agent = explored("4x4", 40)
    start = agent.trace[0].sight
    origin = next(room for room, sight in world.maze.sights.items() if sight == start)
    for room in world.maze.rooms[::3]:
        world.displace(room)
        follow(world, agent, 3)
    for place in agent.map.visited_places.tolist():
        row, column = agent.map.position(place)  # type: ignore[misc]
        sight = world.maze.sights[origin[0] + row, origin[1] + column]
        assert agent.map.A()[agent.map.sights.index(sight), place] > 0.99


# -- preferences -----------------------------------------------------------------------------------------------


def explored(name: str = "3x3", steps: int = 25) -> tuple[MazeEnv, Agent]:
    world = load_world(name)
    agent = walked(world, steps, look_ahead=5)
    assert agent.map.visited.sum() == len(world.maze.rooms)
    return world, agent


def follow(world: MazeEnv, agent: Agent, steps: int) -> list[tuple[Any, int]]:
    """What is seen and done."""
    seen, observation = [], world.observe()
    for _ in range(steps):
        action = agent.step(observation)
        seen.append((observation["sight"], action))
        observation, *_ = world.step(action)
    return seen


@pytest.mark.parametrize("goal", [0, 4, 8])
def test_the_agent_walks_to_what_it_prefers_and_stays(goal: int) -> None:
    world, agent = explored()
    agent.prefer({goal: 4.0})
    here = world.position
    there = next(room for room, sight in world.maze.sights.items() if sight == goal)
    distance = abs(here[0] - there[0]) + abs(here[1] - there[1])
    seen = follow(world, agent, 12)
    assert [sight for sight, _ in seen].index(goal) == distance
    assert seen[distance:] == [(goal, STAY)] * (12 - distance)
    assert world.position == there


def test_preferences_can_change() -> None:
    world, agent = explored()
    for goal in (0, 8, 2):
        agent.prefer({goal: 4.0})
        assert follow(world, agent, 10)[-4:] == [(goal, STAY)] * 4


def test_a_sight_never_met_is_looked_for() -> None:
    world = load_world("4x4")
    world.reset(options={"start": (0, 0)})
    agent = Agent(world.motions, settings=Settings(look_ahead=5), seed=0)
    agent.prefer({15: 6.0})
    assert follow(world, agent, 60)[-3:] == [(15, STAY)] * 3


def test_what_is_disliked_is_left() -> None:
    world, agent = explored()
    here = world.observe()["sight"]
    agent.prefer({here: -6.0})
    assert here not in [sight for sight, _ in follow(world, agent, 10)][2:]


@pytest.mark.parametrize("name", ["3x3", "3x3_alias"])
def test_it_goes_to_a_preferred_place_and_stays(name: str, tmp_path: Path) -> None:
    world = load_world(name)
    agent = walked(world, 30, look_ahead=6)
    action = agent.step(world.observe())
    here, goal = world.position, agent.belief.place
    world.step(action)
    for _ in range(6):  # away from it
        world.step(agent.step(world.observe()))
    agent.prefer(places={goal: 3.0})
    agent.save(tmp_path / "agent.npz")
    agent = Agent.load(tmp_path / "agent.npz")
    for _ in range(6):
        action = agent.step(world.observe())
        world.step(action)
    assert world.position == here
    assert agent.map.motions.names[action] == "stay"


@pytest.mark.parametrize(
    ("wanted", "complaint"),
    [
        ({"places": {99: 1.0}}, "no place 99"),
        ({"places": {0: None}}, "preference None of 0"),
        ({"sights": {0: "much"}}, "preference 'much' of 0"),
        ({"sights": [1]}, "preferences are a list"),
    ],
)
def test_what_cannot_be_preferred_is_refused(wanted: dict[str, Any], complaint: str) -> None:
    agent = walked(load_world("3x3"), 3)
    with pytest.raises(CogmapError, match=complaint):
        agent.prefer(**wanted)
