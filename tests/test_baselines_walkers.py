from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from cogmap.baselines import FrontierAgent, RandomAgent
from cogmap.worlds import (
    GRID,
    MAZES,
    Maze,
    MazeEnv,
    Motions,
    WorldError,
    covering_steps,
    load_world,
    random_maze,
)
from hypothesis import given, settings
from hypothesis import strategies as st

UP, DOWN, LEFT, RIGHT, STAY = range(5)
fast = settings(max_examples=40, deadline=None)


def explore(world: MazeEnv, agent: Any, steps: int, *, seed: int = 0) -> list[tuple[int, int]]:
    """Let the agent live for `steps`; the true positions, relative to the start."""
    observation, info = world.reset(seed=seed)
    track = [info["position"]]
    for _ in range(steps):
        observation, _, _, _, info = world.step(agent.step(observation))
        track.append(info["position"])
    return [(row - track[0][0], column - track[0][1]) for row, column in track]


@fast
@given(st.integers(1, 25), st.integers(1, 3), st.integers(0, 9999))
def test_frontier_search_visits_all_then_stays_and_knows_every_transition(size: int, sights: int, seed: int) -> None:
    maze = random_maze(size, sights=sights, rng=np.random.default_rng(seed))
    world, agent = MazeEnv(maze), FrontierAgent(GRID, seed=seed)
    track = explore(world, agent, 2 * size * size, seed=seed)
    assert len(set(track)) == size
    assert agent.step(world.observe()) == STAY
    assert agent.position == track[-1]
    assert agent.visited == set(track)
    truth = {(place, STAY): place for place in agent.visited}
    for (row, column), (down, right) in ((p, d) for p in agent.visited for d in GRID.displacements):
        ahead = (row + down, column + right)
        action = GRID.displacements.index((down, right))
        truth[(row, column), action] = ahead if ahead in agent.visited else (row, column)
    assert agent.edges == truth


@pytest.mark.parametrize("name", MAZES)
def test_frontier_search_never_beats_the_oracle_and_stays_near_it(name: str) -> None:
    for seed in range(5):
        world = load_world(name)
        track = explore(world, FrontierAgent(GRID, seed=seed), 150, seed=seed)
        done = next(i for i in range(len(track)) if len(set(track[: i + 1])) == len(MAZES[name].rooms))
        world.reset(seed=seed)
        oracle = covering_steps(MAZES[name], world.position)
        assert oracle is not None
        assert oracle <= done <= 2.5 * oracle


def test_frontier_search_goes_to_the_nearest_place_by_a_shortest_way() -> None:
    world, agent = load_world("t_maze"), FrontierAgent(GRID, seed=0)
    observation, _ = world.reset(options={"start": (0, 0)})
    walked = []
    for _ in range(6):
        walked.append(agent.step(observation))
        observation = world.step(walked[-1])[0]
    assert walked[:2] == [RIGHT, RIGHT]
    assert walked[2:] in ([RIGHT, RIGHT, LEFT, LEFT], [DOWN, DOWN, DOWN, UP])


@pytest.mark.parametrize("kind", [FrontierAgent, RandomAgent])
def test_agents_repeat_with_their_seed_and_differ_without(kind: Any) -> None:
    walks = [tuple(explore(load_world("4x4"), kind(GRID, seed=seed), 30)) for seed in (1, 1, 2, 3, 4, 5)]
    assert walks[0] == walks[1]
    assert len(set(walks[1:])) > 1


@fast
@given(st.integers(1, 15), st.integers(0, 9999))
def test_the_random_walk_takes_open_ways_only_and_keeps_its_place(size: int, seed: int) -> None:
    world = MazeEnv(random_maze(size, sights=2, rng=np.random.default_rng(seed)))
    agent = RandomAgent(GRID, seed=seed)
    track = explore(world, agent, 40, seed=seed)
    assert all((a == b) == (size == 1) for a, b in pairwise(track))
    assert agent.visited == set(track[:-1])
    assert agent.position == track[-2]


def test_the_random_walk_is_uniform_over_open_ways() -> None:
    agent = RandomAgent(GRID, seed=0)
    counts = np.zeros(5)
    for _ in range(3000):
        counts[agent.step({"sight": 0, "open": [True] * 5})] += 1
    assert counts[STAY] == 0
    assert np.all(np.abs(counts[:4] - 750) < 120)


@pytest.mark.parametrize("kind", [FrontierAgent, RandomAgent])
def test_who_is_shut_in_stays(kind: Any) -> None:
    agent = kind(GRID, seed=0)
    shut = {"sight": 0, "open": np.array([False] * 4 + [True])}
    assert [agent.step(shut) for _ in range(3)] == [STAY] * 3
    assert agent.visited == {(0, 0)}


def test_a_door_shut_in_the_last_moment_leaves_the_position() -> None:
    world, agent = MazeEnv(Maze("corridor", {(0, c): c for c in range(3)})), FrontierAgent(GRID, seed=0)
    observation, _ = world.reset(options={"start": (0, 0)})
    assert agent.step(observation) == RIGHT
    world.close_door((0, 0), (0, 1))
    observation = world.step(RIGHT)[0]
    assert agent.step(observation) == STAY
    assert agent.position == (0, 0)
    assert agent.edges[(0, 0), RIGHT] == (0, 0)
    world.open_door((0, 0), (0, 1))
    assert agent.step(world.step(STAY)[0]) == RIGHT
    world.step(RIGHT)
    assert agent.step(world.observe()) == RIGHT
    assert agent.position == (0, 1)


def test_a_shut_door_to_a_place_once_seen_leaves_the_position() -> None:
    world, agent = load_world("3x3"), RandomAgent(GRID, seed=3)
    observation, info = world.reset(options={"start": (1, 1)})
    for _ in range(300):
        observation, _, _, _, info = world.step(agent.step(observation))
    row, column = info["position"]
    action = agent.step(observation)
    down, right = GRID.displacements[action]
    world.close_door((row, column), (row + down, column + right))
    agent.step(world.step(action)[0])
    assert world.position == (row, column)
    assert agent.position == (row - 1, column - 1)


def test_a_blocked_move_that_cannot_be_told_at_once_is_put_right_by_the_next_sight() -> None:
    """Blocked on the way to a new place while the way back is open."""
    world = MazeEnv(Maze("corridor", {(0, c): c for c in range(4)}))
    agent = next(agent for seed in range(20) if (agent := walked_right_twice(world, seed)))
    world.close_door((0, 1), (0, 2))
    assert agent.step(world.step(RIGHT)[0]) == LEFT
    agent.step(world.step(LEFT)[0])
    assert agent.position == (0, 0)
    assert agent.visited == {(0, 0), (0, 1)}


def walked_right_twice(world: MazeEnv, seed: int) -> RandomAgent | None:
    agent = RandomAgent(GRID, seed=seed)
    observation, _ = world.reset(options={"start": (0, 0)})
    agent.step(observation)
    return agent if agent.step(world.step(RIGHT)[0]) == RIGHT else None


def test_displacement_is_not_noticed_and_breaks_nothing() -> None:
    world, agent = load_world("4x4"), FrontierAgent(GRID, seed=1)
    observation, _ = world.reset(seed=1)
    for step in range(60):
        if step % 7 == 6:
            observation = world.displace(MAZES["4x4"].rooms[(step * 5) % 16])
        action = agent.step(observation)
        assert action in range(5)
        observation = world.step(action)[0]


@pytest.mark.parametrize("kind", [FrontierAgent, RandomAgent])
@pytest.mark.parametrize(
    "observation", [{}, {"sight": 0}, {"open": [True] * 5}, {"sight": 0, "open": [True] * 4}, None]
)
def test_bad_observations_are_refused(kind: Any, observation: Any) -> None:
    with pytest.raises(WorldError):
        kind(GRID, seed=0).step(observation)


def test_motions_need_a_stay_and_a_way_back() -> None:
    with pytest.raises(WorldError, match="stays"):
        FrontierAgent(Motions(("left", "right"), ((-1,), (1,))), seed=0)
    with pytest.raises(WorldError, match="way back"):
        RandomAgent(Motions(("right", "stay"), ((1,), (0,))), seed=0)


def test_other_motions_work_too() -> None:
    agent = FrontierAgent(Motions(("stay", "back", "on"), ((0,), (-1,), (1,))), seed=0)
    assert agent.step({"sight": "a", "open": [True, False, True]}) == 2
    assert agent.step({"sight": "b", "open": [True, True, False]}) == 0
    assert agent.visited == {(0,), (1,)}
