from __future__ import annotations

from collections import Counter
from collections.abc import Callable

import networkx as nx
import numpy as np
import pytest
from cogmap.worlds import Maze, MazeEnv, WorldError, comb, hall, labyrinth, random_maze, rings, spiral
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


def drawn(rooms: int, loops: float, seed: int, sights: int | None = None) -> Maze:
    return labyrinth(rooms, loops=loops, sights=sights, rng=np.random.default_rng(seed))


def cycles(maze: Maze) -> int:
    return len(maze.doors) - len(maze.rooms) + 1


@fast
@given(st.integers(1, 120), st.floats(0.0, 1.0), st.integers(0, 99))
def test_labyrinths_have_their_size_and_depend_on_the_seed_alone(size: int, loops: float, seed: int) -> None:
    maze = drawn(size, loops, seed)
    assert maze == drawn(size, loops, seed)
    assert len(maze.rooms) == size
    assert nx.is_connected(maze.to_networkx())
    assert min(row for row, _ in maze.rooms) == min(column for _, column in maze.rooms) == 0


@pytest.mark.parametrize("size", [1, 2, 3, 4, 7, 50, 301, 1000])
def test_a_labyrinth_without_loops_is_a_tree(size: int) -> None:
    assert nx.is_tree(drawn(size, 0.0, 3).to_networkx())


@fast
@given(st.integers(15, 400), st.integers(0, 99))  # 14 rooms fill a square less evenly with every cell open
def test_more_loops_are_more_independent_cycles(size: int, seed: int) -> None:
    many = [cycles(drawn(size, loops, seed)) for loops in (0.0, 0.1, 0.25, 0.5, 0.75, 1.0)]
    assert many[0] == 0
    assert many == sorted(many)
    assert many[-1] > many[0]


def test_loops_run_from_a_tree_over_streets_to_an_open_hall() -> None:
    streets, open_ = drawn(3 * 100 - 2 * 10, 0.5, 1), drawn(19 * 19, 1.0, 1)
    assert streets.shape == open_.shape == (19, 19)
    assert all((row % 2, column % 2) != (1, 1) for row, column in streets.rooms)
    assert cycles(streets) == 9 * 9
    assert cycles(open_) == 18 * 18
    tenth = drawn(1000, 0.1, 1)
    assert cycles(tenth) == pytest.approx(2 * 0.1 * 1000 / 2.2, rel=0.15)


def test_labyrinths_are_about_square_and_differ_between_seeds() -> None:
    for loops in (0.0, 0.3, 1.0):
        rows, columns = drawn(5000, loops, 0).shape
        assert 0.9 < rows / columns < 1.1
    assert len({drawn(30, 0.2, seed) for seed in range(10)}) == 10


@fast
@given(st.integers(1, 60), st.integers(1, 60))
def test_a_labyrinth_has_as_many_sights_as_told_each_as_often(size: int, sights: int) -> None:
    if sights > size:
        with pytest.raises(WorldError, match=f"{sights} sights do not fit {size} rooms"):
            drawn(size, 0.0, 0, sights)
        return
    often = Counter(drawn(size, 0.0, 0, sights).sights.values())
    assert set(often) == set(range(sights))
    assert max(often.values()) - min(often.values()) <= 1


def test_a_labyrinth_of_a_hundred_thousand_rooms_can_be_lived_in() -> None:
    world = MazeEnv(drawn(100_000, 0.1, 0, 50))
    observation, _ = world.reset(seed=0)
    assert len(world.maze.rooms) == 100_000
    assert observation["sight"] in range(50)


def test_sights_are_all_different_unless_told() -> None:
    for maze in (comb(3, 2), spiral(6), rings(2), hall(3, 3, sights=None), drawn(40, 0.2, 0)):
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
        (lambda: drawn(0, 0.0, 0), "labyrinth: rooms is 0"),
        (lambda: drawn(9, -0.1, 0), "loops is -0.1"),
        (lambda: drawn(9, 1.1, 0), "loops is 1.1"),
        (lambda: drawn(9, float("nan"), 0), "loops is nan"),
        (lambda: drawn(9, 0.0, 0, 0), "0 sights do not fit 9 rooms"),
    ],
)
def test_impossible_sizes_are_refused(build: Callable[[], Maze], message: str) -> None:
    with pytest.raises(WorldError, match=message):
        build()
