from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.worlds import GRID, MAZES, Maze, MazeEnv, WorldError, format_maze, parse_maze, random_maze, read_maze
from hypothesis import given, settings
from hypothesis import strategies as st

fast = settings(max_examples=40, deadline=None)

words = st.text("aZ09.-_é☂²٣", min_size=1, max_size=3).filter(lambda word: word not in (".", "-1"))


def layout(size: int, seed: int) -> Maze:
    return random_maze(size, rng=np.random.default_rng(seed))


def test_grid_motions_are_the_papers_in_its_order() -> None:
    assert GRID.names == ("up", "down", "left", "right", "stay")
    assert GRID.displacements == ((-1, 0), (1, 0), (0, -1), (0, 1), (0, 0))


def test_the_eight_mazes_have_their_sizes_and_doors() -> None:
    sizes = {name: (len(maze.rooms), len(maze.doors), maze.shape) for name, maze in MAZES.items()}
    assert sizes == {
        "3x3": (9, 12, (3, 3)),
        "3x3_alias": (9, 12, (3, 3)),
        "4x4": (16, 24, (4, 4)),
        "4x4_alias": (16, 24, (4, 4)),
        "t_maze": (8, 7, (4, 5)),
        "t_maze_alias": (8, 7, (4, 5)),
        "donut": (14, 14, (4, 5)),
        "tolman": (23, 24, (7, 6)),
    }


def test_rooms_of_the_protocols_are_where_the_design_has_them() -> None:
    tolman, donut = MAZES["tolman"].sights, MAZES["donut"].sights
    assert (tolman[6, 2], tolman[0, 2], tolman[4, 2], tolman[2, 2]) == (9, 0, 10, 2)
    assert (donut[0, 0], donut[0, 2], donut[2, 4]) == (0, 2, 12)
    assert (1, 1) not in donut


def test_neighbours_come_in_action_order_and_only_for_rooms() -> None:
    assert MAZES["3x3"].neighbours((1, 1)) == ((0, 1), (2, 1), (1, 0), (1, 2))
    assert MAZES["t_maze"].neighbours((3, 2)) == ((2, 2),)
    with pytest.raises(WorldError, match=r"no room at \(1, 0\)"):
        MAZES["t_maze"].neighbours((1, 0))


def test_one_room_is_a_maze() -> None:
    maze = Maze("cell", {(0, 0): 5})
    assert (maze.rooms, maze.doors, maze.shape) == (((0, 0),), (), (1, 1))


def test_a_maze_cannot_be_changed_from_outside() -> None:
    sights = {(0, 0): 1}
    maze = Maze("cell", sights)
    sights[0, 1] = 2
    assert dict(maze.sights) == {(0, 0): 1}
    with pytest.raises(TypeError):
        maze.sights[0, 0] = 3  # type: ignore[index]


def test_copies_and_pickles_are_equal_and_hash_alike() -> None:
    maze = MAZES["donut"]
    for other in (copy.deepcopy(maze), pickle.loads(pickle.dumps(maze))):
        assert other == maze
        assert hash(other) == hash(maze)
    assert maze != MAZES["tolman"]


def test_networkx_graph_has_rooms_sights_and_doors() -> None:
    graph = MAZES["donut"].to_networkx()
    assert set(graph.nodes) == set(MAZES["donut"].rooms)
    assert set(map(frozenset, graph.edges)) == set(map(frozenset, MAZES["donut"].doors))
    assert graph.nodes[2, 4] == {"sight": 12, "position": (2, 4)}


def test_the_graph_of_a_maze_is_a_map_for_an_agent() -> None:
    maze = MAZES["tolman"]
    agent, world = Agent(GRID, map=maze.to_networkx(), seed=0), MazeEnv(maze)
    assert len(agent.map.places) == len(maze.rooms)
    observation, _ = world.reset(options={"start": maze.rooms[3]})
    at = world.position
    for _ in range(12):
        at = world.position
        action = agent.step(observation)
        observation, *_ = world.step(action)
    assert agent.certain
    assert maze.rooms[agent.belief.place] == at  # places are numbered as the nodes of the graph


@pytest.mark.parametrize(
    ("sights", "message"),
    [
        ({}, "no rooms"),
        ({(0, 0): 0, (0, 1): 1, (2, 2): 2}, r"room \(2, 2\) cannot be reached"),
        ({(0, 0): 0, (2, 1): 1, (2, 2): 2}, r"room \(0, 0\) cannot be reached"),
        ({(0, 0): 0, (0, 1): "A"}, "'A' of room"),
        ({(0, 0): -1}, "does not fit"),
        ({(0, 0): 2**31}, "does not fit"),
        ({(0, 0): True}, "does not fit"),
        ({(0, 0): 0.5}, "does not fit"),
        ({(0, 0): "two words"}, "no word"),
        ({(0, 0): ""}, "no word"),
        ({(-1, 0): 0}, "off the grid"),
        ({(0.5, 0): 0}, "no position"),
        ({(0, 0, 0): 0}, "no position"),
    ],
)
def test_impossible_mazes_are_refused(sights: dict, message: str) -> None:
    with pytest.raises(WorldError, match=message):
        Maze("bad", sights)


@fast
@given(st.integers(1, 20), st.integers(0, 999))
def test_mazes_of_numbers_survive_writing_and_reading(size: int, seed: int) -> None:
    maze = layout(size, seed)
    assert parse_maze(format_maze(maze), name=maze.name) == maze


@fast
@given(st.integers(0, 999), st.lists(words, min_size=6, max_size=6))
def test_mazes_of_words_survive_writing_and_reading_or_are_refused(seed: int, labels: list[str]) -> None:
    maze = Maze("words", dict(zip(layout(6, seed).rooms, labels, strict=True)))
    try:
        text = format_maze(maze)
    except WorldError:
        negative = any(label[0] == "-" and label[1:].isdecimal() for label in labels)
        dashes = any(len(label) > 1 and set(label) == {"-"} for label in labels)
        assert negative or dashes or all(label.isascii() and label.isdecimal() for label in labels)
    else:
        assert parse_maze(text, name="words") == maze


def test_both_marks_mean_no_room_and_outer_blank_lines_do_not_count() -> None:
    maze = parse_maze("\n\n 0 -1 . \n 1  2 03 \n\n", name="m")
    assert dict(maze.sights) == {(0, 0): 0, (1, 0): 1, (1, 1): 2, (1, 2): 3}


def test_one_word_makes_every_label_a_word() -> None:
    assert set(parse_maze("0 1 red", name="m").sights.values()) == {"0", "1", "red"}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "m is empty"),
        (" \n\n", "m is empty"),
        (". -1\n. .", "m has no rooms"),
        ("0 1\n2", "m, line 2 has 1 labels, the first row has 2"),
        ("\n0 1\n2 3 4", "m, line 3 has 3 labels"),
        ("0 1\n\n2 3", "m, line 2 is blank"),
        ("0 1\n2 -7", "m, line 2: label -7 is negative"),
        ("0 1\n. .\n. 5", r"m, line 3: room \(2, 1\) cannot be reached"),
        ("0 1\n2 99999999999", "m, line 2: label 99999999999 is over"),
        ("0 1\n2 " + "9" * 5000, "m, line 2: label 9+ is over"),
        ("0 \x01", "m, line 1: label"),
    ],
)
def test_bad_text_is_refused_with_its_line(text: str, message: str) -> None:
    with pytest.raises(WorldError, match=message):
        parse_maze(text, name="m")


def test_labels_that_would_read_back_as_something_else_are_not_written() -> None:
    for label in (".", "-1", "-3", "7"):
        with pytest.raises(WorldError):
            format_maze(Maze("m", {(0, 0): label}))


def test_files_are_named_by_their_stem_and_errors_by_their_path(tmp_path: Path) -> None:
    path = tmp_path / "corner.txt"
    path.write_bytes("\ufeff0 1\r\n. 2\r\n".encode())
    assert read_maze(path) == Maze("corner", {(0, 0): 0, (0, 1): 1, (1, 1): 2})
    path.write_text("0 1\n2\n")
    with pytest.raises(WorldError, match=r"corner\.txt, line 2"):
        read_maze(str(path))


def test_files_that_are_no_text_are_refused(tmp_path: Path) -> None:
    picture = tmp_path / "picture.png"
    picture.write_bytes(b"\x89PNG\r\n\x1a\n\xff\xfe")
    with pytest.raises(WorldError, match=r"picture\.png is not text"):
        read_maze(picture)
    with pytest.raises(WorldError, match="is a directory"):
        read_maze(tmp_path)
    with pytest.raises(WorldError, match=r"nowhere\.txt cannot be read"):
        read_maze(tmp_path / "nowhere.txt")
    with pytest.raises(WorldError, match="cannot be read"):
        read_maze("x" * 5000)
