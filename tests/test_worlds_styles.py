from __future__ import annotations

import copy
import pickle
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from cogmap.worlds import (
    MAZES,
    Maze,
    MazeEnv,
    WorldError,
    covering_steps,
    covering_walk,
    format_maze,
    parse_maze,
    random_maze,
    read_maze,
    shortest_path,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from shared import shared

HOUSE = """
    hall  hall | study
    ----   .     .
    attic den    den
"""
RIGHT = 3


def house() -> Maze:
    return parse_maze(HOUSE, name="house")


def tree_of(maze: Maze, rng: np.random.Generator) -> Maze:
    """The same rooms with a wall wherever a random spanning tree has no door."""
    reached, doors = {maze.rooms[0]}, set(maze.doors)
    kept: set[tuple[tuple[int, int], tuple[int, int]]] = set()
    while len(reached) < len(maze.rooms):
        ways = sorted(door for door in doors if len(reached & set(door)) == 1)
        kept.add(ways[int(rng.integers(len(ways)))])
        reached.update(*kept)
    return Maze(maze.name, maze.sights, frozenset(doors - kept))


def test_walls_in_the_text_stand_between_their_rooms() -> None:
    maze = house()
    assert maze.walls == {((0, 1), (0, 2)), ((0, 0), (1, 0))}
    assert set(maze.doors) == {
        ((0, 0), (0, 1)),
        ((0, 1), (1, 1)),
        ((0, 2), (1, 2)),
        ((1, 0), (1, 1)),
        ((1, 1), (1, 2)),
    }
    assert maze.neighbours((0, 2)) == ((1, 2),)
    assert maze.successors((0, 1))["right"] == (0, 1)


def test_an_agent_cannot_walk_through_a_wall_and_sees_it() -> None:
    world = MazeEnv(house(), render_mode="rgb_array")
    observation, _ = world.reset(options={"start": (0, 1)})
    assert observation["open"].tolist() == [False, True, True, False, True]
    assert world.step(RIGHT)[4]["position"] == (0, 1)
    with pytest.raises(WorldError, match="no door"):
        world.close_door((0, 1), (0, 2))
    open_hall = MazeEnv(Maze("house", house().sights), render_mode="rgb_array")
    open_hall.reset(options={"start": (0, 1)})
    assert (world.render() != open_hall.render()).any()


def test_walls_belong_to_the_maze_when_it_is_compared_copied_and_sent() -> None:
    maze = house()
    for other in (copy.deepcopy(maze), pickle.loads(pickle.dumps(maze))):
        assert (other, hash(other)) == (maze, hash(maze))
    assert maze != Maze("house", maze.sights)
    assert not maze.to_networkx().has_edge((0, 1), (0, 2))


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 25), st.integers(0, 999))
def test_mazes_of_thin_walls_survive_writing_and_reading(size: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    maze = tree_of(random_maze(size, rng=rng), rng)
    assert len(maze.doors) == size - 1
    assert parse_maze(format_maze(maze), name=maze.name) == maze


def test_oracles_go_round_walls() -> None:
    assert len(shortest_path(house(), (0, 1), (0, 2))) - 1 == 3
    walk = covering_walk(house(), (0, 0))
    assert walk is not None
    assert all(b in house().neighbours(a) for a, b in pairwise(walk))
    assert covering_steps(house(), (0, 0)) == 6


def test_walls_around_the_maze_may_be_drawn() -> None:
    framed = parse_maze("-- --\n| a b |\n-- --", name="m")
    assert framed == parse_maze("a b", name="m")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a | | b", "line 1: `| |` has no room in between"),
        ("a b\n-- .\n-- .\nc d", "line 3 has walls below a line of walls"),
        ("a b\n-- . .\nc d", "line 2 has 3 walls"),
        ("a | b\nc", "line 2 has 1 labels, the first row has 2"),
        ("a b\nc --", "line 2: -- marks walls"),
        ("a | b", r"line 1: room \(0, 1\) cannot be reached"),
        ("a b\n-- --\nc d", r"line 3: rooms \(1, 0\), \(1, 1\) cannot be reached"),
        ("###\n#.#", "line 1: ### looks like walls of an ASCII maze; read it with format='ascii'"),
        ("# a #", "line 1: # looks like walls"),
        ("a,b,c\na,b,d", "line 1: a,b,c has commas; read it with format='commas'"),
    ],
)
def test_bad_walls_and_other_styles_are_refused_by_name(text: str, message: str) -> None:
    with pytest.raises(WorldError, match=message):
        parse_maze(text, name="m")


@pytest.mark.parametrize("label", ["|", "--", "-----", "a,b", "#", "#.#"])
def test_labels_that_mark_something_are_not_written(label: str) -> None:
    with pytest.raises(WorldError, match="cannot be written"):
        format_maze(Maze("m", {(0, 0): label}))


@pytest.mark.parametrize("walls", [[((0, 0), (1, 1))], [((0, 0), (0, 0))], [((0, 0), (5, 0))], [((0, 0),)]])
def test_walls_that_are_none_are_refused(walls: list) -> None:
    with pytest.raises(WorldError, match="is no wall"):
        Maze("m", {(0, 0): 0, (0, 1): 1, (1, 0): 2, (1, 1): 3}, frozenset(walls))


def test_comma_files_have_a_room_a_cell(tmp_path: Path) -> None:
    path = tmp_path / "rooms.csv"
    path.write_text('\nhall, kitchen,"attic"\nhall,,shed\n')
    maze = read_maze(path, format="commas")
    assert dict(maze.sights) == {(0, 0): "hall", (0, 1): "kitchen", (0, 2): "attic", (1, 0): "hall", (1, 2): "shed"}
    path.write_text("1,2\n.,3\n-1,4\n")
    assert dict(read_maze(path, format="commas").sights) == {(0, 0): 1, (0, 1): 2, (1, 1): 3, (2, 1): 4}
    path.write_text('a,"b\n')
    with pytest.raises(WorldError, match="no comma file"):
        read_maze(path, format="commas")
    path.write_text("a,b\n,\nc,d\n")
    with pytest.raises(WorldError, match=r"line 3: rooms \(2, 0\), \(2, 1\) cannot be reached"):
        read_maze(path, format="commas")


def test_ascii_mazes_have_a_room_a_floor_cell(tmp_path: Path) -> None:
    path = tmp_path / "maze.txt"
    path.write_text("#####\n#.#.#\n#...#\n#####\n")
    maze = read_maze(path, format="ascii")
    assert maze.rooms == ((0, 0), (0, 2), (1, 0), (1, 1), (1, 2))
    assert sorted(maze.sights.values()) == [0, 1, 2, 3, 4]
    ways = read_maze(path, format="ascii", sights="ways")
    assert dict(ways.sights) == {(0, 0): 1, (0, 2): 1, (1, 0): 2, (1, 1): 2, (1, 2): 2}
    three = [read_maze(path, format="ascii", sights=3, seed=seed) for seed in (0, 0, 1)]
    assert three[0] == three[1] != three[2]
    path.write_text("#####\n#S# #\n#  G#\n")
    spaced = read_maze(path, format="ascii")
    assert spaced.sights[0, 0] == "S"
    assert spaced.sights[1, 2] == "G"
    assert len(set(spaced.sights.values())) == 5


def test_shared_files_of_other_styles_are_refused_and_read_when_asked_for() -> None:
    for name, format_, rooms in (("cases/ascii.txt", "ascii", 13), ("cases/commas.txt", "commas", 6)):
        path = shared(name)
        with pytest.raises(WorldError, match=f"format='{format_}'"):
            read_maze(path)
        assert len(read_maze(path, format=format_).rooms) == rooms


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        ({"format": "xml"}, "unknown format 'xml' of a maze; use one of text, commas, ascii"),
        ({"format": "ascii", "sights": "many"}, "sights 'many' cannot be given"),
        ({"format": "ascii", "sights": 0}, "sights 0 cannot be given"),
        ({"format": "ascii", "sights": 2, "seed": -1}, "seed is -1"),
    ],
)
def test_impossible_ways_to_read_are_refused(tmp_path: Path, kind: dict, message: str) -> None:
    path = tmp_path / "maze.txt"
    path.write_text("#.\n..\n")
    with pytest.raises(WorldError, match=message):
        read_maze(path, **kind)


def test_mazes_without_walls_are_written_as_before() -> None:
    assert format_maze(MAZES["t_maze"]).splitlines()[0] == "0 1 2 3 7"


def test_a_large_text_is_read() -> None:
    text = "\n".join(" ".join(str((row * column) % 50) for column in range(300)) for row in range(300))
    assert len(parse_maze(text, name="large").rooms) == 90_000
