from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from cogmap.worlds import (
    MAZES,
    Maze,
    Position,
    WorldError,
    comb,
    covering_steps,
    covering_walk,
    hall,
    random_maze,
    rings,
    shortest_path,
    spiral,
)
from hypothesis import given, settings
from hypothesis import strategies as st

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
    import networkx as nx

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
