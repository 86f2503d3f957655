from __future__ import annotations

import pytest
from cogmap.agent import Agent
from cogmap.experiments import BELIEVED, Truth, explore
from cogmap.worlds import GRID, MAZES, Maze, MazeEnv, Motions, parse_maze
from hypothesis import given, settings
from hypothesis import strategies as st


class Ring:
    """The chart of three places in a ring."""

    name, places, sights, positions = "ring", (0, 1, 2), {0: "a", 1: "b", 2: "c"}, None
    motions = Motions(("on", "back", "stay"), ((1,), (-1,), (0,)))

    def successors(self, place: int) -> dict[str, int]:
        return {"on": (place + 1) % 3, "back": (place - 1) % 3, "stay": place}


def least_by_hand(maze: Maze, start: tuple[int, int], agent: Agent) -> float:
    def place(room: tuple[int, int]) -> int | None:
        return agent.map.place_at((room[0] - start[0], room[1] - start[1]))

    worst = 1.0
    for row, column in maze.rooms:
        for action, (down, right) in enumerate(GRID.displacements):
            ahead = (row + down, column + right)
            here, there = place((row, column)), place(ahead if ahead in maze.sights else (row, column))
            if here is None or there is None:
                return 0.0
            worst = min(worst, agent.map.transition(there, here, action))
    return worst


@settings(max_examples=8, deadline=None)
@given(st.sampled_from(["3x3", "3x3_alias", "t_maze"]), st.integers(0, 50), st.integers(1, 12))
def test_least_is_the_least_of_all_true_transitions(name: str, seed: int, steps: int) -> None:
    maze = MAZES[name]
    world = MazeEnv(maze)
    observation, info = world.reset(seed=seed)
    start = info["position"]
    agent, truth, path = Agent(GRID, seed=seed), Truth(maze, start), [start]
    for _ in range(steps):
        action = agent.step(observation)
        assert truth.least(agent.map) == pytest.approx(least_by_hand(maze, start, agent))
        assert truth.learned(agent.map) == (least_by_hand(maze, start, agent) >= BELIEVED)
        assert truth.visited(agent.map) == (set(path) == set(maze.rooms))
        observation, _, _, _, info = world.step(action)
        path.append(info["position"])


def test_a_map_that_knows_all_but_one_wall_is_not_complete() -> None:
    maze = parse_maze("0 1", name="two")
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 0, "open": [False, False, False, True, True]})
    truth = Truth(maze, (0, 0))
    assert 0.4 < truth.least(agent.map) < BELIEVED
    assert not truth.visited(agent.map)
    assert not truth.learned(agent.map)


def test_the_origin_matters() -> None:
    maze = parse_maze("0 1", name="two")
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 0, "open": [False, False, False, True, True]})
    assert Truth(maze, (0, 1)).least(agent.map) == 0.0


def test_one_truth_can_score_several_maps() -> None:
    maze, truth = MAZES["3x3"], Truth(MAZES["3x3"], (0, 0))
    world = MazeEnv(maze)
    for steps in (30, 1):
        observation, _ = world.reset(options={"start": (0, 0)})
        agent = Agent(GRID, seed=0)
        for _ in range(steps):
            observation, *_ = world.step(agent.step(observation))
        assert truth.least(agent.map) == pytest.approx(least_by_hand(maze, (0, 0), agent))


def test_edges_must_hold_every_transition() -> None:
    truth = Truth(parse_maze("0 1", name="two"), (0, 0))
    left, right = (0, 0), (0, 1)
    edges = {(room, action): room for room in (left, right) for action in range(5)}
    edges[left, 3], edges[right, 2] = right, left
    assert truth.known(edges)
    assert not truth.known({**edges, (right, 2): right})
    del edges[right, 4]
    assert not truth.known(edges)


def test_a_world_that_is_no_lattice_is_never_known() -> None:
    truth = Truth(Ring(), 0)
    agent = Agent({"on": (1,), "back": (-1,), "stay": (0,)}, seed=0)
    assert not truth.learned(agent.map)
    assert not truth.visited(agent.map)
    assert not truth.known({})
    assert truth.place(agent.map, 0) is None


def test_a_frontier_run_learns_what_it_visits() -> None:
    run = explore(MAZES["4x4"], agent="frontier", seed=3)
    assert run.steps_to_learn == run.steps_to_visit_all == run.steps_to_complete
