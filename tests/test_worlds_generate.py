from __future__ import annotations

from collections.abc import Callable

import networkx as nx
import numpy as np
import pytest
from cogmap.worlds import Maze, WorldError, comb, hall, random_maze, rings, spiral
from hypothesis import given, settings
from hypothesis import strategies as st

fast = settings(max_examples=25, deadline=None)


@fast
@given(st.integers(1, 8), st.integers(0, 8))
def test_a_comb_is_a_tree_of_its_size(teeth: int, length: int) -> None:
    maze = comb(teeth, length)
    assert len(maze.rooms) == 2 * teeth - 1 + teeth * length
    assert nx.is_tree(maze.to_networkx())


@pytest.mark.parametrize("side", range(1, 16))
def test_a_spiral_is_one_corridor(side: int) -> None:
    maze = spiral(side)
    assert sorted(degree for _, degree in maze.to_networkx().degree) == sorted(
        [1, 1] + [2] * (len(maze.rooms) - 2) if side > 1 else [0]
    )
    assert len(maze.doors) == len(maze.rooms) - 1
    assert maze.shape == (side, side)


def test_a_spiral_winds_inwards() -> None:
    assert len(spiral(9).rooms) == 1 + 8 + 8 + 8 + 6 + 6 + 4 + 4 + 2 + 2


@fast
@given(st.integers(1, 5), st.integers(3, 7))
def test_rings_are_cycles_joined_by_bridges(count: int, side: int) -> None:
    graph = rings(count, side).to_networkx()
    assert len(nx.cycle_basis(graph)) == count
    assert all(len(cycle) == 4 * (side - 1) for cycle in nx.cycle_basis(graph))
    assert graph.number_of_nodes() == count * 4 * (side - 1) + count - 1


def test_a_hall_has_every_room_and_repeating_sights() -> None:
    maze = hall(5, 6, sights=3, rng=np.random.default_rng(1))
    assert len(maze.rooms) == 30
    assert len(maze.doors) == 5 * 5 + 4 * 6
    assert set(maze.sights.values()) == {0, 1, 2}


@fast
@given(st.integers(1, 60), st.integers(0, 99))
def test_random_mazes_have_their_size_and_depend_on_the_seed_alone(size: int, seed: int) -> None:
    one, same = (random_maze(size, sights=4, rng=np.random.default_rng(seed)) for _ in range(2))
    assert one == same
    assert len(one.rooms) == size
    assert min(row for row, _ in one.rooms) == min(column for _, column in one.rooms) == 0


def test_random_mazes_differ_between_seeds() -> None:
    assert len({random_maze(12, rng=np.random.default_rng(seed)) for seed in range(10)}) > 5


def test_sights_are_all_different_unless_told() -> None:
    for maze in (comb(3, 2), spiral(6), rings(2), hall(3, 3, sights=None)):
        assert len(set(maze.sights.values())) == len(maze.rooms)


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: comb(0, 2), "teeth is 0"),
        (lambda: comb(2, -1), "length is -1"),
        (lambda: spiral(0), "side is 0"),
        (lambda: rings(0), "count is 0"),
        (lambda: rings(2, 2), "side is 2"),
        (lambda: hall(0, 3, sights=None), "rows is 0"),
        (lambda: hall(3, 3), "give rng"),
        (lambda: comb(2, 2, sights=0), "0 sights are too few"),
        (lambda: random_maze(0, rng=np.random.default_rng(0)), "rooms is 0"),
    ],
)
def test_impossible_sizes_are_refused(build: Callable[[], Maze], message: str) -> None:
    with pytest.raises(WorldError, match=message):
        build()
