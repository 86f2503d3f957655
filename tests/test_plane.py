"""Worlds whose ways belong to the place, lived in by what is measured of each move."""

from __future__ import annotations

from typing import Any

import networkx as nx
import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.experiments import Parts, explore, walk
from cogmap.model import Bearings, CogmapError, Plane, Sight, Ways
from cogmap.planning import Options, Planner, Policies, evaluate_plain
from cogmap.worlds import GraphWorld, ListedWays, NoisyWorld, load_world
from shared import shared


def grid(rows: int, columns: int, **options: Any) -> GraphWorld:
    """A grid with a diagonal in every second cell, stretched by chance, and one way that leads one way only."""
    rng = np.random.default_rng(3)
    graph = nx.DiGraph(name="grid")
    for r, c in np.ndindex(rows, columns):
        graph.add_node(r * columns + c, position=(10.0 * c + rng.uniform(-2, 2), -10.0 * r + rng.uniform(-2, 2)))
    for r, c in np.ndindex(rows, columns):
        for other in ((r + 1, c), (r, c + 1), (r + 1, c + 1)):
            if other[0] < rows and other[1] < columns and (sum(other) != r + c + 2 or (r + c) % 2):
                graph.add_edge(r * columns + c, other[0] * columns + other[1])
                graph.add_edge(other[0] * columns + other[1], r * columns + c)
    graph.remove_edge(0, 1)
    return GraphWorld.from_networkx(graph, **options)


@pytest.mark.parametrize("sights", ["distinct", "ways", 3])
def test_a_world_of_ways_of_their_own_is_explored(sights: Any) -> None:
    """Every place is one place, and every way is known, though few of them were walked."""
    for seed in range(2):
        run = explore(grid(4, 5, sights=sights), seed)
        assert run.map_right
        assert run.steps_to_visit_all is not None
        assert run.steps_to_visit_all <= 30
        assert run.steps_to_complete is not None


@pytest.mark.parametrize("noise", [{"odometry": 0.02, "heading": 1.0}, {"odometry": 0.1, "heading": 5.0}])
def test_odometry_may_err(noise: dict[str, float]) -> None:
    """Each place is one place, and lies where it truly does but for what errors leave after loops have closed."""
    for seed in range(2):
        done = walk(NoisyWorld(grid(4, 5, sights=3), **noise), seed, max_steps=200)
        assert done.run.map_right
        agent, chart = done.walker, grid(4, 5, sights=3).chart
        order = list(dict.fromkeys(done.path))
        mine = np.array([agent.map.position(place)[:2] for place in agent.map.visited_places])
        true = np.array([chart.positions[place] for place in order]) - chart.positions[order[0]]
        assert np.median(np.linalg.norm(mine - true, axis=1)) < 10.0 * 5 * noise["odometry"]


def streets(blocks: int, houses: int) -> GraphWorld:
    """Square blocks with places along their sides, all sides straight, their places at uneven distances."""
    graph, size, rng = nx.Graph(name="streets"), blocks * houses + 1, np.random.default_rng(1)
    for r, c in np.ndindex(size, size):
        if r % houses == 0 or c % houses == 0:
            along, up = (shift * rng.uniform(-3.0, 3.0) for shift in (c % houses > 0, r % houses > 0))
            graph.add_node((r, c), position=(10.0 * c + along, 10.0 * r + up))
    for r, c in list(graph):
        graph.add_edges_from(
            ((r, c), other)
            for other, on in (((r + 1, c), c % houses == 0), ((r, c + 1), r % houses == 0))
            if on and other in graph
        )
    return GraphWorld.from_networkx(nx.convert_node_labels_to_integers(graph), sights="ways")


def test_bearings_alone_tell_places_apart() -> None:
    """Nobody tells how long ways are; every place is one place."""
    for seed in range(2):
        run = explore(grid(4, 5, sights="distinct", pose="bearing"), seed, max_steps=200)
        assert run.map_right


def agent_of(world: ListedWays, seed: int = 0) -> Agent:
    sensors = [Sight("sight"), Ways(learned=True), Bearings()]
    return Agent(world.motions, sensors=sensors, pose=Plane(), seed=seed)


def test_a_place_between_two_that_look_at_each_other_is_not_left_for_the_end() -> None:
    """What is as long as two ways, where ways go straight on, is not taken for one: that costs 16 steps of 110."""
    world = ListedWays(streets(3, 4))
    observation, info = world.reset(seed=0)
    agent, entered = agent_of(world), {info["place"]}
    for _ in range(114):
        observation, _, _, _, info = world.step(agent.step(observation))
        entered.add(info["place"])
    assert len(entered) == len(world.unwrapped.chart.places)


def test_an_agent_that_was_saved_and_loaded_goes_where_the_same_one_goes(tmp_path: Any) -> None:
    """What is doubted of its ways does not depend on what it remembers of earlier plans."""
    world = ListedWays(grid(3, 4, sights=2))
    agent = agent_of(world)
    observation, _ = world.reset(seed=0)
    for step in range(18):
        loaded = agent
        if step > 13:
            agent.save(tmp_path / "agent.npz")
            loaded = Agent.load(tmp_path / "agent.npz")
        action = agent.step(observation)
        assert loaded is agent or loaded.step(observation) == action
        assert loaded.plan.policy.tolist() == agent.plan.policy.tolist()
        observation = world.step(action)[0]


def test_positions_are_those_that_were_measured(tmp_path: Any) -> None:
    """Also after the agent was saved and loaded in between; it walks on as it would have."""
    world = ListedWays(grid(3, 3, sights=2))
    observation, info = world.reset(seed=1)
    agent, start = agent_of(world), np.array(world.unwrapped.chart.positions[info["place"]])
    other: Agent | None = None
    for step in range(14):
        action = agent.step(observation)
        if other is not None:
            assert other.step(observation) == action
        here = agent.map.position(agent.belief.place)
        true = np.array(world.unwrapped.chart.positions[info["place"]]) - start
        np.testing.assert_allclose(np.array(here)[:2], true, atol=1e-4)
        observation, _, _, _, info = world.step(action)
        if step == 5:
            agent.save(tmp_path / "map.npz")
            other = Agent.load(tmp_path / "map.npz")


def test_exploring_is_by_options_and_each_says_what_it_is_worth() -> None:
    world = ListedWays(grid(3, 4, sights=2))
    observation, _ = world.reset(seed=0)
    agent = agent_of(world)
    agent.step(observation)
    plan = agent.plan
    assert plan.generator.name == "options"
    assert plan.expected_free_energy.names == ("way_there", "way_back")
    G = plan.expected_free_energy
    np.testing.assert_allclose(G.G, G["way_there"] - G["way_back"])
    assert plan.chosen == G.G.argmin()
    assert (G["way_back"] > 0.0).all()


def test_exploring_may_go_by_metres() -> None:
    """Options say how far it is, in mean lengths of a way, and the nearest by steps is not always the nearest."""
    world = ListedWays(grid(4, 5, sights="distinct"))
    sensors = [Sight("sight"), Ways(learned=True), Bearings()]
    agent = Agent(world.motions, sensors=sensors, pose=Plane(), planner=Planner(explorer=Options(by="metres")), seed=0)
    observation, _ = world.reset(seed=0)
    whole = True
    for _ in range(25):
        observation, *_ = world.step(agent.step(observation))
        plan = agent.plan
        if plan.generator.name == "options":
            there = plan.expected_free_energy["way_there"]
            plain = evaluate_plain(plan.model, Policies(plan.policies), plan.generator.terms)
            np.testing.assert_allclose(there, plain["way_there"])
            whole &= bool(np.allclose(there, there.round()))
    assert not whole
    made = Parts(cost="metres").make(world, np.random.SeedSequence(0))
    assert made.planner.explorer.by == "metres"


def test_lengths_that_are_told_say_where_places_lie_that_nobody_entered() -> None:
    """Ways of several places that lead to one are known to do so, before anybody was there."""
    world = ListedWays(grid(4, 5, sights="distinct", pose="lengths"))
    observation, info = world.reset(seed=1)
    agent, chart = agent_of(world), world.unwrapped.chart
    start, entered = np.array(chart.positions[info["place"]]), [info["place"]]
    for _ in range(6):
        observation, _, _, _, info = world.step(agent.step(observation))
        entered.append(info["place"])
    agent.perceive(observation)
    ahead = {place for at in entered for place in chart.successors(at).values()} - {*entered}
    known = [place for place in agent.map.places if place not in agent.map.visited_places]
    mine = np.array([agent.map.position(place)[:2] for place in known])
    true = np.array([chart.positions[place] for place in ahead]) - start
    assert len(mine) == len(true)
    assert np.linalg.norm(mine[:, None] - true, axis=2).min(axis=1).max() < 0.2


@pytest.mark.parametrize("lengths", [1.0, [1.0], {"up": 1.0}, [0.0, -1.0, 0.0]])
def test_lengths_that_are_none_are_refused(lengths: Any) -> None:
    with pytest.raises(CogmapError, match="'lengths'"):
        Agent({"stay": (0,), "left": (-1,), "right": (1,)}).step({"sight": 0, "open": [True] * 3, "lengths": lengths})


def test_a_cost_that_is_none_is_refused() -> None:
    with pytest.raises(CogmapError, match="cannot be measured by 'miles'"):
        Options(by="miles")
    with pytest.raises(CogmapError, match="cost is 'miles'"):
        Parts(cost="miles")


@pytest.mark.parametrize("bearings", [None, "north", [0.0], [None, "east", None], [None, np.nan, None]])
def test_bearings_that_are_none_are_refused(bearings: Any) -> None:
    agent = Agent({"stay": (0,), "left": (-1,), "right": (1,)}, sensors=[Ways(), Bearings()])
    with pytest.raises(CogmapError, match="degrees for each of 3 actions"):
        agent.step({"open": [True] * 3, "bearings": bearings})


def test_a_displacement_of_one_number_is_refused() -> None:
    world = ListedWays(grid(2, 2, sights=2))
    observation, _ = world.reset(seed=0)
    with pytest.raises(CogmapError, match="give 2 or 3 finite numbers"):
        agent_of(world).step({**observation, "displacement": [1.0]})


@pytest.mark.parametrize("name", ["house_31", "house_49"])
def test_a_real_house_is_explored(name: str) -> None:
    run = explore(load_world(shared(f"worlds/{name}.json"), sights=6), 0)
    assert run.map_right
    assert run.steps_to_visit_all is not None
    assert run.frontier_steps is None or run.steps_to_visit_all <= 1.1 * run.frontier_steps
