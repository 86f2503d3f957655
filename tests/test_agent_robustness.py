"""Whatever is seen, an agent neither crashes nor believes nonsense: invariants after every step."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.inference import FilterOptions
from cogmap.worlds import MazeEnv, load_world
from cogmap.worlds.generate import random_maze
from hypothesis import example, given
from hypothesis import settings as budget
from hypothesis import strategies as st
from parts import agent_with
from walks import GRID, STAY, assert_agent_is_sound, walk

from cogmap import UNSEEN

options = st.fixed_dictionaries(
    {
        "look_ahead": st.integers(1, 3),
        "growth": st.sampled_from(["predicted", "predicted", "observed", "static"]),
        "policies": st.sampled_from(["map_guided", "map_guided", "self_avoiding", "l_shaped", "exhaustive"]),
        "choice": st.sampled_from(["outward", "best", "sampled"]),
        "window": st.sampled_from([1, 2, 5, 10]),
        "certainty": st.sampled_from([0.0, 0.5, 0.7, 0.95, 1.0]),
        "forgetting": st.sampled_from([0.0, 0.0, 0.05, 1.0]),
        "engine": st.sampled_from(["numpy", "numpy", "gtsam"]),
    }
)


def meddle(world: MazeEnv, rng: np.random.Generator) -> None:
    """Open or close a room or a door, or move the agent, now and then."""
    rooms = world.maze.rooms
    room = rooms[int(rng.integers(len(rooms)))]
    beside = [other for other in rooms if abs(other[0] - room[0]) + abs(other[1] - room[1]) == 1]
    other = beside[int(rng.integers(len(beside)))] if beside else None
    what = rng.random()
    if what < 0.15 and room != world.position:
        world.close_room(room)
    elif what < 0.3:
        world.open_room(room)
    elif what < 0.4 and other:
        world.close_door(room, other)
    elif what < 0.5 and other:
        world.open_door(room, other)
    elif what < 0.75 and room not in world.closed_rooms:
        world.displace(room)


@given(
    seed=st.integers(0, 10**6),
    rooms=st.integers(1, 14),
    sights=st.sampled_from([None, 1, 2, 4]),
    given_options=options,
    steer=st.booleans(),
)
@example(
    seed=72821,
    rooms=6,
    sights=2,
    steer=True,
    given_options={
        "look_ahead": 1,
        "growth": "static",
        "policies": "map_guided",
        "choice": "outward",
        "window": 1,
        "certainty": 0.0,
        "forgetting": 0.0,
        "engine": "numpy",
    },
)  # the map is built anew without the place it began with
@budget(max_examples=12, deadline=None)
def test_walks_through_random_mazes_that_change(
    seed: int, rooms: int, sights: int | None, given_options: dict[str, Any], steer: bool
) -> None:
    rng = np.random.default_rng(seed)
    world = MazeEnv(random_maze(rooms, sights=sights, rng=rng))
    agent = agent_with(world.motions, places=100, **given_options, seed=seed)
    observation, _ = world.reset(seed=seed)
    action = STAY  # which is not heard before the first step
    for step in range(25):
        action = agent.step({**observation, "taken": action})
        if steer:
            action = int(rng.integers(5))
        assert_agent_is_sound(agent)
        assert agent.steps == len(agent.trace) == step + 1
        assert len(agent.graph.factors) > 0
        world.step(action)
        if rng.random() < 0.3:
            meddle(world, rng)
        observation = world.observe()


Spoil = Callable[[int, dict[str, Any], np.random.Generator], dict[str, Any]]


def new_sight_each_step(step: int, seen: dict[str, Any], rng: np.random.Generator) -> dict[str, Any]:
    return {**seen, "sight": ("new", step)}


def nothing_to_see(step: int, seen: dict[str, Any], rng: np.random.Generator) -> dict[str, Any]:
    return {**seen, "sight": UNSEEN}


def ten_wrong_sights(step: int, seen: dict[str, Any], rng: np.random.Generator) -> dict[str, Any]:
    return {**seen, "sight": int(rng.integers(9)) if 10 <= step < 20 else seen["sight"]}


def flickering_doors(step: int, seen: dict[str, Any], rng: np.random.Generator) -> dict[str, Any]:
    return {**seen, "open": [*(rng.random(4) < 0.5).tolist(), True]}


def doors_open_everywhere(step: int, seen: dict[str, Any], rng: np.random.Generator) -> dict[str, Any]:
    return {**seen, "open": [True] * 5}


def shut_in(step: int, seen: dict[str, Any], rng: np.random.Generator) -> dict[str, Any]:
    return {**seen, "open": [False] * 5}


def nothing_right(step: int, seen: dict[str, Any], rng: np.random.Generator) -> dict[str, Any]:
    return {"sight": int(rng.integers(4)), "open": [*(rng.random(4) < 0.5).tolist(), True]}


SPOILS: list[Spoil] = [
    new_sight_each_step,
    nothing_to_see,
    ten_wrong_sights,
    flickering_doors,
    doors_open_everywhere,
    shut_in,
    nothing_right,
]


@pytest.mark.parametrize("growth", ["predicted", "observed"])
@pytest.mark.parametrize("spoil", SPOILS, ids=lambda spoil: spoil.__name__)
def test_senses_that_lie(spoil: Spoil, growth: str) -> None:
    rng, step = np.random.default_rng(1), iter(range(1000))
    world = load_world("3x3_alias")
    agent = agent_with(world.motions, look_ahead=2, growth=growth, seed=1)

    def observe(seen: dict[str, Any]) -> dict[str, Any]:
        return spoil(next(step), seen, rng)

    for _ in walk(world, agent, 28, seed=1, steer=growth == "observed", observe=observe):
        assert_agent_is_sound(agent)


@pytest.mark.parametrize("name", ["4x4", "3x3_alias", "donut", "tolman"])
def test_silent_moves_every_three_steps(name: str) -> None:
    world = load_world(name)
    agent = Agent(world.motions, settings=Settings(look_ahead=2), seed=0)
    for _ in walk(world, agent, 45, displace_every=3):
        assert_agent_is_sound(agent)


@pytest.mark.parametrize("displacement", [0.0, 1e-12, 0.5, 1.0])
@pytest.mark.parametrize("slip", [0.0, 0.5])
def test_extreme_filters(displacement: float, slip: float) -> None:
    world = load_world("3x3_alias")
    options = FilterOptions(displacement=displacement, slip=slip, support=0.0)
    agent = Agent(world.motions, settings=Settings(look_ahead=1, filter=options), seed=2)
    for _ in walk(world, agent, 15, displace_every=4):
        assert_agent_is_sound(agent)


def test_other_motions() -> None:
    """A ring of five rooms that an agent in Z^1 takes for a line, and a corridor in Z^3."""
    for motions, dimension in (({"left": (-1,), "right": (1,), "stay": (0,)}, 1), ({"in": (0, 0, 1)}, 3)):
        if dimension == 3:
            motions = {"in": (0, 0, 1), "out": (0, 0, -1), "stay": (0, 0, 0)}
        agent = Agent(motions, settings=Settings(look_ahead=2), seed=0)
        room = 0
        for _ in range(20):
            action = agent.step({"sight": room, "open": [True] * 3})
            assert_agent_is_sound(agent)
            room = (room + (-1, 1, 0)[action]) % 5
        assert all(len(agent.map.position(place) or ()) == dimension for place in agent.map.places)


def test_a_cell_without_doors() -> None:
    agent = Agent(GRID, settings=Settings(look_ahead=3), seed=0)
    for _ in range(10):
        assert agent.step({"sight": "cell", "open": [False] * 5}) in range(5)
        assert_agent_is_sound(agent)
    assert len(agent.map.places) == 1
    assert agent.map.transition(0, 0, 0) > 0.9
    assert agent.belief.places == {0: 1.0}
    assert agent.map.transition(0, 0, STAY) == 1.0
