from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import networkx as nx
import numpy as np
import pytest
from cogmap.baselines import FrontierAgent
from cogmap.worlds import (
    GRID,
    MAZES,
    Chart,
    GraphWorld,
    Layout,
    Maze,
    MazeEnv,
    Position,
    WorldError,
    comb,
    covering_steps,
    covering_walk,
    frontier_walk,
    hall,
    random_maze,
    read_graph,
    rings,
    shortest_path,
    spiral,
    tour,
    walk_length,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from shared import shared

fast = settings(max_examples=40, deadline=None)

MEANS = {
    "3x3": 8.44,
    "3x3_alias": 8.44,
    "4x4": 15.00,
    "4x4_alias": 15.00,
    "t_maze": 9.88,
    "t_maze_alias": 9.88,
    "donut": 13.00,
    "tolman": 24.09,
}


def street(size: int, seed: int) -> nx.DiGraph:
    rng = np.random.default_rng(seed)
    graph = nx.DiGraph([(place, (place + 1) % size) for place in range(size)])
    graph.add_edges_from((a, b) for a, b in rng.integers(size, size=(size, 2)).tolist() if a != b)
    nx.set_node_attributes(graph, 0, "sight")
    nx.set_node_attributes(graph, {place: rng.uniform(0, 9, size=2).tolist() for place in graph}, "position")
    return graph


def one_way(size: int, seed: int) -> Layout:
    """Places in a ring of one-way ways, with some across."""
    return GraphWorld.from_networkx(street(size, seed)).layout


def is_walk_over_all(chart: Chart, walk: Sequence[Any]) -> bool:
    return set(walk) == set(chart.places) and all(b in chart.successors(a).values() for a, b in pairwise(walk))


def shortest_cover(chart: Chart, start: Any) -> int:
    """Brute force, as below."""
    level, steps = {(start, frozenset({start}))}, 0
    seen = set(level)
    while not any(len(visited) == len(chart.places) for _, visited in level):
        level = {(b, visited | {b}) for a, visited in level for b in chart.successors(a).values()} - seen
        seen |= level
        steps += 1
    return steps


def steps_of_frontier_agent(maze: Maze, start: Position, seed: int) -> int:
    world, agent = MazeEnv(maze), FrontierAgent(GRID, seed=seed)
    observation, info = world.reset(options={"start": start})
    left, steps = set(maze.rooms) - {start}, 0
    while left:
        observation, _, _, _, info = world.step(agent.step(observation))
        left.discard(info["position"])
        steps += 1
    return steps


def breadth_first_cover(maze: Maze, start: Position) -> int:
    """Brute force: breadth first over (room, visited rooms), one step at a time."""
    level, seen, steps = {(start, frozenset({start}))}, set(), 0
    while True:
        if any(len(visited) == len(maze.rooms) for _, visited in level):
            return steps
        seen |= level
        level = {(b, visited | {b}) for a, visited in level for b in maze.neighbours(a)} - seen
        steps += 1


def is_covering(maze: Maze, walk: tuple[Position, ...]) -> bool:
    return set(walk) == set(maze.rooms) and all(b in maze.neighbours(a) for a, b in pairwise(walk))


@pytest.mark.parametrize("name", MEANS)
def test_mean_over_all_starts_is_the_known_one(name: str) -> None:
    steps = [covering_steps(MAZES[name], room) for room in MAZES[name].rooms]
    assert f"{np.mean([s for s in steps if s is not None]):.2f}" == f"{MEANS[name]:.2f}"
    assert None not in steps


@fast
@given(st.integers(1, 10), st.integers(0, 9999))
def test_covering_walks_are_as_short_as_brute_force_finds(size: int, seed: int) -> None:
    maze = random_maze(size, rng=np.random.default_rng(seed))
    start = maze.rooms[seed % size]
    walk = covering_walk(maze, start)
    assert walk is not None
    assert walk[0] == start
    assert is_covering(maze, walk)
    assert len(walk) - 1 == breadth_first_cover(maze, start)


@pytest.mark.parametrize("maze", [MAZES["t_maze"], comb(3, 2), spiral(5), Maze("cell", {(0, 0): 0})])
def test_trees_have_the_closed_form(maze: Maze) -> None:
    for start in maze.rooms:
        walk = covering_walk(maze, start)
        farthest = max(len(shortest_path(maze, start, room)) - 1 for room in maze.rooms)
        assert walk is not None
        assert is_covering(maze, walk)
        assert len(walk) - 1 == 2 * (len(maze.rooms) - 1) - farthest


def test_tree_form_agrees_with_brute_force() -> None:
    maze = comb(3, 1)
    assert [covering_steps(maze, room) for room in maze.rooms] == [
        breadth_first_cover(maze, room) for room in maze.rooms
    ]


def test_larger_mazes_are_in_reach() -> None:
    assert covering_steps(hall(5, 6, sights=None), (0, 0)) == 29
    assert covering_steps(rings(1, 6), (0, 0)) == 19
    walk = covering_walk(rings(3), (0, 0))
    assert walk is not None
    assert is_covering(rings(3), walk)
    assert covering_steps(spiral(60), (0, 0)) == len(spiral(60).rooms) - 1


@fast
@given(st.integers(2, 8), st.integers(0, 9999))
def test_covering_walks_take_one_way_ways_as_they_are(size: int, seed: int) -> None:
    chart = one_way(size, seed)
    for start in chart.places:
        walk = covering_walk(chart, start)
        assert walk is not None
        assert walk[0] == start
        assert is_walk_over_all(chart, walk)
        assert len(walk) - 1 == shortest_cover(chart, start)


@fast
@given(st.integers(2, 9), st.integers(0, 9999), st.sampled_from(["steps", "length"]))
def test_tours_are_walks_over_all_places_and_never_shorter_than_the_shortest(size: int, seed: int, by: str) -> None:
    chart = one_way(size, seed)
    walk = tour(chart, 0, by=by, rounds=20)
    assert walk is not None
    assert walk[0] == 0
    assert is_walk_over_all(chart, walk)
    assert walk == tour(chart, 0, by=by, rounds=20)
    if by == "steps":
        assert len(walk) - 1 >= (covering_steps(chart, 0) or 0)


def test_tours_of_small_worlds_are_the_shortest() -> None:
    for seed in range(12):
        chart = one_way(8, seed)
        walk = tour(chart, 0, rounds=40)
        assert walk is not None
        assert len(walk) - 1 == covering_steps(chart, 0)
    for name in ("4x4", "donut", "tolman"):
        for start in MAZES[name].rooms[::8]:
            walk = tour(MAZES[name], start, rounds=200)
            assert walk is not None
            assert len(walk) - 1 == covering_steps(MAZES[name], start)


def test_a_tour_by_length_goes_round_a_long_way() -> None:
    graph = nx.DiGraph()
    graph.add_nodes_from("abc", sight=0)
    for a, b, length in (("a", "b", 9.0), ("a", "c", 1.0), ("c", "b", 2.0), ("b", "a", 1.0), ("b", "c", 1.0)):
        graph.add_edge(a, b, length=length)
    chart = GraphWorld.from_networkx(graph).layout
    assert tour(chart, "a", by="length") == ("a", "c", "b")
    assert walk_length(chart, ("a", "c", "b")) == 3.0
    assert shortest_path(chart, "a", "b") == ["a", "b"]
    assert shortest_path(chart, "a", "b", by="length") == ["a", "c", "b"]
    assert walk_length(chart, "aabc") == 10.0
    assert [frontier_walk(chart, "a", by="length", rng=np.random.default_rng(0))] == [("a", "c", "b")]


def test_nearest_frontier_takes_as_many_steps_as_the_agent_that_searches_so() -> None:
    rng = np.random.default_rng(0)
    for name in ("4x4", "tolman", "donut"):
        maze, start = MAZES[name], MAZES[name].rooms[0]
        walks = [frontier_walk(maze, start, rng=rng) for _ in range(200)]
        assert all(walk is not None and is_covering(maze, walk) for walk in walks)
        agents = [steps_of_frontier_agent(maze, start, seed) for seed in range(100)]
        spread = np.std(agents) / 10 + np.std([len(walk or ()) for walk in walks]) / 14
        assert np.mean([len(walk or ()) - 1 for walk in walks]) == pytest.approx(np.mean(agents), abs=4 * spread + 1e-9)


def test_beyond_their_bounds_oracles_answer_none(monkeypatch: pytest.MonkeyPatch) -> None:
    maze, rng = hall(5, 5, sights=None), np.random.default_rng(0)
    monkeypatch.setattr("cogmap.worlds.oracle.MOST_EXACT", 24)
    monkeypatch.setattr("cogmap.worlds.oracle.MOST_TOUR", 24)
    assert covering_steps(maze, (0, 0)) is None
    assert tour(maze, (0, 0)) is None
    assert frontier_walk(maze, (0, 0), rng=rng) is not None
    assert covering_steps(spiral(9), (0, 0)) == 48
    monkeypatch.setattr("cogmap.worlds.oracle.MOST_WALKED", 24)
    assert frontier_walk(maze, (0, 0), rng=rng) is None
    assert covering_steps(spiral(9), (0, 0)) is None


def test_a_million_rooms_are_out_of_reach_at_once() -> None:
    class Endless:  # looking at any place but the first would take for ever
        name, places = "endless", range(10**6)

        def find(self, place: int) -> int:
            return place

    chart: Any = Endless()
    assert covering_walk(chart, 0) is None
    assert tour(chart, 0) is None
    assert frontier_walk(chart, 0, rng=np.random.default_rng(0)) is None


def test_what_no_walk_can_cover_is_refused() -> None:
    graph = nx.DiGraph([(0, 1), (2, 1)])
    nx.set_node_attributes(graph, 0, "sight")
    chart = GraphWorld.from_networkx(graph, strong=False).layout
    with pytest.raises(WorldError, match="not every place can be reached from 0"):
        tour(chart, 0)
    with pytest.raises(WorldError, match="tells no lengths"):
        tour(chart, 0, by="length")
    with pytest.raises(WorldError, match="cannot be measured by 'hours'"):
        tour(chart, 0, by="hours")
    with pytest.raises(WorldError, match="no way leads from 0 to 2"):
        walk_length(GraphWorld.from_networkx(street(4, 0)).layout, (0, 2))
    assert covering_walk(chart, 0) is None


@pytest.mark.parametrize(
    ("name", "starts", "known"),
    [
        ("worlds/mouse_labyrinth.json", [127], 247),
        ("worlds/farm.json", range(3), 307),
        ("worlds/house_49.json", [0], 58),
    ],
)
def test_tours_of_shared_worlds_are_as_short_as_known_ones(name: str, starts: Sequence[int], known: int) -> None:
    chart = read_graph(shared(name), sights="distinct")
    for start in starts:
        walk = covering_walk(chart, start, limit=1) or tour(chart, start, rounds=100)
        assert walk is not None
        assert is_walk_over_all(chart, walk)
        assert len(walk) - 1 <= known * 1.02


def test_out_of_reach_is_none_and_never_a_guess() -> None:
    assert covering_walk(MAZES["tolman"], (6, 2), limit=3) is None
    assert covering_steps(MAZES["tolman"], (6, 2), limit=3) is None


def test_routes_of_tolmans_maze_are_6_10_and_12_moves_long() -> None:
    tolman, start, goal = MAZES["tolman"], (6, 2), (0, 2)
    lengths = [len(shortest_path(tolman, start, goal, closed=closed)) - 1 for closed in ([], [(4, 2)], [(2, 2)])]
    assert lengths == [6, 10, 12]


def test_shortest_path_goes_round_what_is_closed() -> None:
    donut = MAZES["donut"]
    assert len(shortest_path(donut, (0, 0), (2, 4))) - 1 == 6
    path = shortest_path(donut, (0, 0), (2, 4), closed={(0, 2)})
    assert path == [(0, 0), (1, 0), (2, 0), (3, 0), (3, 1), (3, 2), (3, 3), (3, 4), (2, 4)]
    assert shortest_path(donut, (0, 0), (0, 0)) == [(0, 0)]


@fast
@given(st.integers(2, 25), st.integers(0, 999))
def test_shortest_paths_are_as_short_as_networkx_finds(size: int, seed: int) -> None:
    maze = random_maze(size, rng=np.random.default_rng(seed))
    a, b = maze.rooms[0], maze.rooms[-1]
    path = shortest_path(maze, a, b)
    assert (path[0], path[-1]) == (a, b)
    assert len(path) - 1 == nx.shortest_path_length(maze.to_networkx(), a, b)


def test_oracles_refuse_what_is_no_room_no_way_or_no_limit() -> None:
    donut = MAZES["donut"]
    for a, b in (((1, 1), (0, 0)), ((0, 0), (1, 1))):
        with pytest.raises(WorldError, match="no room"):
            shortest_path(donut, a, b)
    with pytest.raises(WorldError, match="no way"):
        shortest_path(donut, (0, 0), (2, 4), closed=[(0, 2), (2, 0)])
    with pytest.raises(WorldError, match="no room"):
        covering_walk(donut, (1, 1))
    with pytest.raises(WorldError, match="limit"):
        covering_walk(donut, (0, 0), limit=0)
