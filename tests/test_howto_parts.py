"""Parts of one's own, as the pages show them: one class outside of the package, and nothing else edited."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.inference import infer
from cogmap.model import CogmapError, NoPose, Sight, Ways
from cogmap.model.savepoint import go_back, savepoint
from cogmap.worlds import load_world
from walks import assert_agent_is_sound, assert_map_is_sound, walk

PAGES = Path(__file__).parents[1] / "docs" / "howto"


def written(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What the code of a page defines, run in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    code = "\n".join(re.findall(r"^```python\n(.*?)^```", (PAGES / f"{page}.md").read_text("utf-8"), re.M | re.S))
    names: dict[str, Any] = {"__name__": page}
    exec(compile(code, f"{page}.md", "exec"), names)
    return names


def test_a_sensor_outside_of_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = written("add_a_sensor", tmp_path, monkeypatch)
    thermometer, felt, world = page["Thermometer"], page["felt"], load_world("3x3_alias")
    right = 0
    for seed in range(4):
        rng = np.random.default_rng(seed)
        agent = Agent(world.motions, sensors=[Sight(), thermometer("warmth"), Ways()], seed=seed)
        _, info = world.reset(seed=seed)
        start = info["position"]
        for k in range(40):
            if k > 25 and k % 5 == 0:
                world.displace(world.maze.rooms[int(rng.integers(9))])
            action = agent.step(felt(world.observe(), world.position))
            assert_map_is_sound(agent.map)
            world.step(action)
        agent.step(felt(world.observe(), world.position))
        row, column = world.position
        right += agent.map.position(agent.belief.place) == (row - start[0], column - start[1])
        t = agent.steps - 1
        posterior = infer(agent.graph).marginal(f"s{t}")
        np.testing.assert_allclose(posterior.max(), agent.belief.message.certainty, atol=1e-9)
    assert right >= 3  # sights alone leave it guessing
    with pytest.raises(CogmapError, match="the file has a sensor 'Thermometer', which is not of this library"):
        Agent.load(tmp_path / "warm.npz")
    with pytest.raises(CogmapError, match="observation: warmth is 'cold'; give a finite number"):
        agent.step({**world.observe(), "warmth": "cold"})
    with pytest.raises(CogmapError, match=r"key 'warmth' is missing; give 'sight', 'warmth' and 'open'"):
        agent.step(world.observe())


def test_what_a_sensor_has_learned_is_taken_back_and_saved(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = written("add_a_sensor", tmp_path, monkeypatch)
    agent = page["again"]
    sensor, point = agent.map.sensors["warmth"], savepoint(agent.map)
    before = sensor.total.values.copy()
    assert before.any()
    sensor.learn(0, 21.5, 0.75)
    assert (sensor.total.values != before).any()
    go_back(agent.map, point)
    np.testing.assert_array_equal(sensor.total.values, before)


def test_a_growth_rule_outside_of_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = written("add_a_growth_rule", tmp_path, monkeypatch)
    rule, agent = page["FreeEnergyGrowth"], page["agent"]
    assert len(agent.map.places) == 16
    agent.save(tmp_path / "map.npz")
    again = Agent.load(tmp_path / "map.npz", growth=rule())
    assert again.parts["growth"] == {"kind": "FreeEnergyGrowth", "options": {"least": 0.75, "door": 1e-3}}
    with pytest.raises(CogmapError, match="the file has a growth 'FreeEnergyGrowth', which is not of this library"):
        Agent.load(tmp_path / "map.npz")


@pytest.mark.parametrize("name", ["3x3", "4x4_alias", "donut", "t_maze_alias"])
def test_an_agent_without_positions_walks_plans_and_is_saved(name: str, tmp_path: Path) -> None:
    world = load_world(name)
    agent = Agent(world.motions, pose=NoPose(), seed=1)
    for _ in walk(world, agent, 40, seed=1, displace_every=9):
        assert_agent_is_sound(agent)
        assert all(agent.map.position(place) is None for place in agent.map.places)
        assert not [variable for variable in agent.graph.variables if variable.name.startswith("p")]
        posterior = infer(agent.graph).marginal(f"s{agent.steps - 1}")
        np.testing.assert_allclose(posterior.max(), agent.belief.message.certainty, atol=1e-9)
    agent.save(tmp_path / "map.npz")
    again = Agent.load(tmp_path / "map.npz")
    seen = world.observe()
    assert again.step(seen) == agent.step(seen)
    assert again.belief.places == agent.belief.places


def test_an_agent_that_senses_no_ways_walks() -> None:
    world = load_world("3x3")
    agent = Agent(world.motions, sensors=[Sight()], seed=0)
    observation, _ = world.reset(seed=0)
    for _ in range(30):
        observation, *_ = world.step(agent.step({"sight": observation["sight"]}))
        assert_agent_is_sound(agent)
    assert agent.map.visited.sum() > 1


def test_an_agent_that_sees_nothing_but_ways_walks() -> None:
    world = load_world("4x4")
    agent = Agent(world.motions, sensors=[Ways()], seed=0)
    observation, _ = world.reset(seed=0)
    for _ in range(40):
        observation, *_ = world.step(agent.step({"open": observation["open"]}))
        assert_agent_is_sound(agent)
    assert agent.map.visited.sum() > 8


def test_a_term_outside_of_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = written("add_a_term", tmp_path, monkeypatch)
    agent, effort, np_ = page["agent"], page["Effort"], page["np"]
    row = agent.plan.expected_free_energy.row(agent.plan.chosen)
    assert list(row)[-2:] == ["effort", "G"]
    moves = sum(action != agent.map.motions.stay for action in agent.plan.policy.tolist())
    weights = agent.settings.discount ** np_.arange(len(agent.plan.policy))
    moving = agent.plan.policy != agent.map.motions.stay
    assert row["effort"] == pytest.approx(0.125 * float(weights @ moving))
    assert moves == moving.sum()
    np.testing.assert_allclose(page["fast"]["effort"], page["slow"]["effort"], atol=1e-12)
    np.testing.assert_allclose(page["fast"].G, page["slow"].G, atol=1e-9)
    lazy = Agent(load_world("3x3").motions, planner=page["Planner"](terms=(*page["TERMS"], effort(cost=1e3))), seed=0)
    assert lazy.step(load_world("3x3").reset(seed=0)[0]) == lazy.map.motions.stay


def test_a_policy_generator_outside_of_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = written("add_a_policy_generator", tmp_path, monkeypatch)
    straight, planner = page["Straight"], page["Planner"]
    assert len(page["agent"].plan.policies) == straight().count(page["agent"].map.motions, 4) == 17
    assert page["agent"].map.visited.all()
    world = load_world("3x3")
    strides = Agent(world.motions, planner=planner(policies=straight(stride=2)), seed=0)
    strides.step(world.reset(seed=0)[0])
    assert len(strides.plan.policies) == 13
    many = type("Many", (straight,), {"name": "many", "count": lambda *_: 3_000_000})
    with pytest.raises(CogmapError, match="many: more than 2,000,000 policies"):
        Agent(world.motions, planner=planner(policies=many()), seed=0)
