from __future__ import annotations

import pickle
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from cogmap.worlds import MAZES, Maze, MazeEnv, WorldError, label_colour, load_world, parse_maze, random_maze
from gymnasium.utils.env_checker import check_env
from hypothesis import given, settings
from hypothesis import strategies as st

UP, DOWN, LEFT, RIGHT, STAY = range(5)
WORDS = parse_maze("red green\nblau .", name="words")


def world_at(name: str, room: tuple[int, int]) -> MazeEnv:
    world = load_world(name)
    world.reset(options={"start": room})
    return world


def flags(world: MazeEnv) -> list[bool]:
    return world.observe()["open"].tolist()


@pytest.mark.parametrize("name", MAZES)
def test_registered_worlds_pass_gymnasiums_check(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gym.make(f"cogmap/{name}-v0").unwrapped)


def test_a_maze_of_words_passes_gymnasiums_check(tmp_path: Path) -> None:
    path = tmp_path / "words.txt"
    path.write_text("red green\nblau .\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gym.make("cogmap/3x3-v0", name_or_path=str(path)).unwrapped)


def test_random_actions_through_gymnasiums_wrappers() -> None:
    world = gym.make("cogmap/4x4_alias-v0")
    world.reset(seed=1)
    world.action_space.seed(1)
    for _ in range(50):
        observation, reward, terminated, truncated, _ = world.step(world.action_space.sample())
        assert observation in world.observation_space
        assert (reward, terminated, truncated) == (0.0, False, False)


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 12), st.integers(0, 999), st.lists(st.integers(0, 4), max_size=20))
def test_moves_follow_the_doors_and_what_is_open_is_where_they_lead(size: int, seed: int, actions: list[int]) -> None:
    maze = random_maze(size, rng=np.random.default_rng(seed))
    world = MazeEnv(maze)
    observation, info = world.reset(seed=seed)
    for action in actions:
        row, column = info["position"]
        down, right = world.motions.displacements[action]
        ahead = (row + down, column + right)
        assert observation["open"][action] == (ahead in maze.sights)
        observation, _, _, _, info = world.step(action)
        assert info == {"position": ahead if ahead in maze.sights else (row, column)}
        assert observation["sight"] == maze.sights[info["position"]]


def test_truth_is_in_the_info_alone() -> None:
    observation, info = load_world("3x3").reset(options={"start": (1, 2)})
    assert set(observation) == {"sight", "open"}
    assert observation["open"].dtype == np.bool_
    assert observation["open"].tolist() == [True, True, True, False, True]
    assert info == {"position": (1, 2)}


def test_random_starts_cover_every_room_and_repeat_with_the_seed() -> None:
    world = load_world("3x3")
    starts = [world.reset(seed=seed)[1]["position"] for seed in range(100)]
    assert set(starts) == set(MAZES["3x3"].rooms)
    assert starts == [world.reset(seed=seed)[1]["position"] for seed in range(100)]


def test_a_closed_room_shows_from_the_next_rooms_only_and_cannot_be_entered() -> None:
    world = world_at("donut", (0, 0))
    before = flags(world)
    world.close_room((0, 2))
    assert flags(world) == before
    world.step(RIGHT)
    assert flags(world) == [False, False, True, False, True]
    assert world.step(RIGHT)[4]["position"] == (0, 1)
    world.open_room((0, 2))
    assert flags(world) == [False, False, True, True, True]
    assert world.step(RIGHT)[4]["position"] == (0, 2)


def test_a_closed_door_is_shut_from_both_sides_and_nowhere_else() -> None:
    world = world_at("3x3", (0, 0))
    world.close_door((0, 1), (0, 0))
    assert flags(world) == [False, True, False, False, True]
    assert world.step(RIGHT)[4]["position"] == (0, 0)
    assert world.displace((0, 1))["open"].tolist() == [False, True, False, True, True]
    assert world.closed_doors == {((0, 0), (0, 1))}
    world.open_door((0, 0), (0, 1))
    assert flags(world) == [False, True, True, True, True]


def test_opening_a_room_leaves_its_closed_doors_closed() -> None:
    world = world_at("3x3", (0, 0))
    world.close_door((0, 0), (0, 1))
    world.close_room((0, 1))
    world.open_room((0, 1))
    assert not flags(world)[RIGHT]


def test_closing_and_opening_twice_is_the_same_as_once() -> None:
    world = world_at("3x3", (0, 0))
    for _ in range(2):
        world.close_room((0, 1))
        world.close_door((0, 0), (1, 0))
    assert flags(world) == [False, False, False, False, True]
    for _ in range(2):
        world.open_room((0, 1))
        world.open_door((0, 0), (1, 0))
    assert flags(world) == [False, True, False, True, True]


def test_reset_opens_everything_unless_told_to_keep_it() -> None:
    world = world_at("3x3", (0, 0))
    world.close_room((1, 1))
    world.close_door((0, 0), (0, 1))
    starts = {world.reset(seed=seed, options={"keep_closed": True})[1]["position"] for seed in range(60)}
    assert starts == set(MAZES["3x3"].rooms) - {(1, 1)}
    assert (world.closed_rooms, world.closed_doors) == ({(1, 1)}, {((0, 0), (0, 1))})
    world.reset()
    assert (world.closed_rooms, world.closed_doors) == (frozenset(), frozenset())


def test_displacing_moves_the_agent_and_changes_nothing_else() -> None:
    world = world_at("3x3", (0, 0))
    world.close_room((1, 1))
    observation = world.displace((2, 1))
    assert world.position == (2, 1)
    assert observation["sight"] == 7
    assert observation["open"].tolist() == [False, False, True, True, True]
    assert world.closed_rooms == {(1, 1)}


def test_observations_are_the_callers_own() -> None:
    world = world_at("3x3", (0, 0))
    world.observe()["open"][:] = True
    assert flags(world) == [False, True, False, True, True]


@pytest.mark.parametrize("options", [{"start": (1, 0)}, {"start": 3}, {"start": "ab"}, {"start": (0.5, 0)}])
def test_a_start_that_is_no_room_is_refused(options: dict[str, Any]) -> None:
    with pytest.raises(WorldError, match="no room"):
        load_world("t_maze").reset(options=options)


def test_a_refused_reset_changes_nothing() -> None:
    world = world_at("3x3", (0, 0))
    world.close_room((1, 1))
    with pytest.raises(WorldError, match="closed"):
        world.reset(options={"start": (1, 1), "keep_closed": True})
    with pytest.raises(WorldError, match="unknown reset option strat"):
        world.reset(options={"strat": (1, 1)})
    assert (world.position, world.closed_rooms) == ((0, 0), {(1, 1)})


def test_nobody_can_start_where_every_room_is_closed() -> None:
    world = MazeEnv(Maze("cell", {(0, 0): 0}))
    world.close_room((0, 0))
    with pytest.raises(WorldError, match="every room"):
        world.reset(options={"keep_closed": True})


@pytest.mark.parametrize("action", [5, -1, 1.0, "up", None])
def test_an_invalid_action_is_refused(action: Any) -> None:
    world = world_at("3x3", (0, 0))
    with pytest.raises(WorldError, match="no action"):
        world.step(action)
    assert world.position == (0, 0)


def test_closing_what_is_not_there_is_refused() -> None:
    world = world_at("t_maze", (0, 2))
    for call in (world.close_room, world.open_room, world.displace):
        with pytest.raises(WorldError, match="no room"):
            call((1, 0))
    for call in (world.close_door, world.open_door):
        with pytest.raises(WorldError, match="no room"):
            call((0, 0), (1, 0))
        with pytest.raises(WorldError, match="no door"):
            call((0, 0), (0, 2))
        with pytest.raises(WorldError, match="no door"):
            call((0, 0), (0, 0))
    with pytest.raises(WorldError, match="agent inside"):
        world.close_room((0, 2))
    world.close_room((0, 1))
    with pytest.raises(WorldError, match="closed"):
        world.displace((0, 1))


def test_a_world_must_be_reset_first() -> None:
    world = load_world("3x3")
    for call in (world.observe, lambda: world.step(0), lambda: world.displace((0, 0)), lambda: world.position):
        with pytest.raises(WorldError, match="reset"):
            call()


def test_worlds_load_by_name_or_file_and_say_what_is_unknown(tmp_path: Path) -> None:
    path = tmp_path / "mine.txt"
    path.write_text("a b\n")
    assert load_world(path).maze.name == "mine"
    with pytest.raises(WorldError, match=r"3x3, 3x3_alias, 4x4, .*tolman"):
        load_world("5x5")
    with pytest.raises(WorldError, match="directory"):
        load_world(tmp_path)
    with pytest.raises(WorldError, match="no world"):
        load_world(3)  # type: ignore[arg-type]
    with pytest.raises(WorldError, match="render mode"):
        load_world("3x3", render_mode="human")


def test_a_world_can_be_pickled_in_the_middle_of_a_walk() -> None:
    world = world_at("donut", (0, 0))
    world.close_room((0, 2))
    other = pickle.loads(pickle.dumps(world))
    assert (other.position, other.closed_rooms) == ((0, 0), {(0, 2)})


def test_pictures_show_agent_closures_and_colours() -> None:
    world = load_world("donut", render_mode="rgb_array")
    pictures = [world.render()]
    world.reset(options={"start": (0, 0)})
    pictures.append(world.render())
    world.close_room((0, 2))
    pictures.append(world.render())
    world.close_door((0, 0), (1, 0))
    pictures.append(world.render())
    world.displace((3, 4))
    pictures.append(world.render())
    assert all(p is not None and p.shape == (160, 200, 3) and p.dtype == np.uint8 for p in pictures)
    assert len({p.tobytes() for p in pictures if p is not None}) == len(pictures)
    assert load_world("donut").render() is None


def test_a_door_is_drawn_as_a_gap_in_the_wall_between_its_rooms() -> None:
    world = MazeEnv(parse_maze("0 1\n. 2", name="corner"), render_mode="rgb_array")
    picture = world.render()
    assert picture is not None
    across, down = picture[20, 36:44], picture[36:44, 60]
    assert across.tolist() == [list(label_colour(0))] * 4 + [list(label_colour(1))] * 4
    assert down.tolist() == [list(label_colour(1))] * 4 + [list(label_colour(2))] * 4
    assert len(np.unique(picture[0:4, 0:80].reshape(-1, 3), axis=0)) == 1


def test_colours_belong_to_the_label_and_tell_24_numbers_apart() -> None:
    assert len({label_colour(label) for label in range(24)}) == 24
    code = "from cogmap.worlds import label_colour; print(label_colour('red'), label_colour(17))"
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert printed.split() == f"{label_colour('red')} {label_colour(17)}".split()
