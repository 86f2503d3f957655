"""Room mazes as MiniGrid environments: geometry, views, counting, oracles."""

from __future__ import annotations

import warnings
from collections import deque
from itertools import pairwise
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from cogmap.worlds import MAZES, Maze, WorldError, hall
from cogmap.worlds.minigrid import (
    AHEAD,
    COLOURS,
    SIGHTS,
    Geometry,
    RoomsEnv,
    Unsteady,
    codes,
    covering_low_steps,
    draw_floorplan,
    low_steps_between,
    paint,
    rooms_env,
)
from gymnasium.utils.env_checker import check_env
from minigrid.core.world_object import WorldObj
from minigrid.wrappers import RGBImgPartialObsWrapper

LEFT, RIGHT, FORWARD, TOGGLE = 0, 1, 2, 5


@pytest.mark.parametrize("view", ["symbolic", "rgb"])
def test_it_is_a_gymnasium_environment(view: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*alternative render modes.*")
        check_env(rooms_env("3x3", view=view, render_mode="rgb_array"))


def test_mazes_have_registered_ids() -> None:
    env: Any = gym.make("cogmap/MiniGrid-4x4_alias-v0", view="rgb")
    first, second = (env.reset(seed=5)[0]["image"] for _ in range(2))
    assert (first == second).all()
    assert env.unwrapped.maze is MAZES["4x4_alias"]
    assert any((env.reset(seed=seed)[0]["image"] != first).any() for seed in range(3))


def test_the_authors_geometry() -> None:
    plan = draw_floorplan(MAZES["3x3"], Geometry(), np.random.default_rng(0))
    assert plan.tiles().sum() == 9 * 36 + 12 * 9
    assert all(len(passage.tiles) == 5 and passage.door == passage.tiles[2] for passage in plan.passages)
    assert len({passage.tiles[0] for passage in plan.passages}) == 12


@pytest.mark.parametrize(
    "geometry", [Geometry(least=4, most=12), Geometry(least=2, most=9, passage=1, door="anywhere")]
)
def test_rooms_differ_and_passages_join_their_floors(geometry: Geometry) -> None:
    plan = draw_floorplan(MAZES["tolman"], geometry, np.random.default_rng(1))
    floors = [tile for room in plan.rooms for tile in plan.floor(room)]
    assert len({size for *_, width, height in plan.rooms.values() for size in (width, height)}) > 3
    assert len(floors) == len(set(floors)), "rooms overlap"
    for passage in plan.passages:
        ends = [{plan.room_at((x + dx, y + dy)) for dx, dy in AHEAD} for x, y in (passage.tiles[0], passage.tiles[-1])]
        assert passage.rooms[0] in ends[0]
        assert passage.rooms[1] in ends[1]
        assert passage.door in passage.tiles
        assert not set(passage.tiles) & set(floors)


def test_pixels_are_those_of_minigrid_and_tiles_can_be_told_apart() -> None:
    env = rooms_env("4x4", least=4, most=8, locked=2, white=(1, 1))
    theirs, rng = RGBImgPartialObsWrapper(env), np.random.default_rng(0)
    seen, _ = theirs.reset(seed=3)
    for _ in range(80):
        assert (seen["image"] == paint(env.symbols)).all()
        seen, *_ = theirs.step(int(rng.choice([LEFT, RIGHT, FORWARD, FORWARD, 3, TOGGLE])))
    assert len(set(codes())) == len(codes())
    looks = [paint(np.full((3, 3, 3), code))[:8, :8].ravel().astype(int) for code in codes()]
    apart = [np.abs(a - b).max() for i, a in enumerate(looks) for b in looks[:i]]
    assert min(apart) > 15
    for code in codes():
        WorldObj.decode(*code)  # MiniGrid's own wrappers do


def test_info_has_the_truth_and_counts_what_was_seen() -> None:
    env = rooms_env("3x3", white=(2, 2))
    _, info = env.reset(seed=0, options={"start": (0, 1), "heading": 2})
    assert (info["position"], info["heading"], info["white"]) == ((0, 1), 2, False)
    shares = [info["tiles_seen"]]
    for action in (LEFT, LEFT, LEFT, LEFT, FORWARD):
        *_, info = env.step(action)
        shares.append(info["tiles_seen"])
    assert shares == sorted(shares)
    assert shares[-1] > shares[0]
    env.displace((2, 2))
    assert env.position == (2, 2)
    assert set(env.tally.entered) == {(0, 1), (2, 2)}


def test_the_white_tile_is_rewarded() -> None:
    env = rooms_env("t_maze", white=(1, 2))
    env.reset(seed=1)
    (white,) = env.goal_tiles["white"]
    before = next(
        (white[0] - dx, white[1] - dy, h)
        for h, (dx, dy) in enumerate(AHEAD)
        if env.grid.get(white[0] - dx, white[1] - dy).type == "floor"
    )
    env.agent_pos, env.agent_dir = before[:2], before[2]
    _, reward, terminated, _, info = env.step(FORWARD)
    assert (reward, terminated, info["white"]) == (1.0, False, True)
    assert env.tally.white == [1]


def follow(env: RoomsEnv, pose: tuple[int, int, int], goals: set[tuple[int, int]]) -> int:
    """Steps of a search in the environment's own rules."""
    start = (pose, frozenset[tuple[int, int]]())
    queue, steps = deque([start]), {start: 0}
    while queue:
        state = queue.popleft()
        (x, y, h), opened = state
        if (x, y) in goals:
            return steps[state]
        ahead = (x + AHEAD[h][0], y + AHEAD[h][1])
        cell: Any = env.grid.get(*ahead)
        new = [((x, y, (h + 1) % 4), opened), ((x, y, (h - 1) % 4), opened)]
        if cell is None or cell.type == "floor" or ahead in opened:
            new.append(((*ahead, h), opened))
        elif cell.type == "door":
            new.append(((x, y, h), opened | {ahead}))
        for each in new:
            if each not in steps:
                steps[each] = steps[state] + 1
                queue.append(each)
    raise AssertionError


def test_the_shortest_way_by_brute_force() -> None:
    env = rooms_env(hall(1, 3, rng=np.random.default_rng(0)), least=3, most=5)
    for seed in range(5):
        _, info = env.reset(seed=seed, options={"start": (0, 0)})
        pose = (*info["tile"], info["heading"])
        goals = set(env.plan.floor((0, 2)))
        assert low_steps_between(env.plan, pose, goals) == follow(env, pose, goals)
        assert covering_low_steps(env.plan, pose) == follow(env, pose, goals)


def test_the_oracle_turns_back_where_it_must() -> None:
    env = rooms_env("t_maze")
    _, info = env.reset(seed=2, options={"start": (0, 2)})
    steps = covering_low_steps(env.plan, (*info["tile"], info["heading"]))
    legs = [
        low_steps_between(env.plan, (*info["tile"], info["heading"]), env.plan.floor(room)) for room in env.maze.rooms
    ]
    assert steps is not None
    assert steps > sum(sorted(legs)[-2:])
    assert covering_low_steps(env.plan, (*info["tile"], info["heading"]), limit=1) is None


def test_locked_doors_have_keys_and_bar_nobody() -> None:
    env = rooms_env("3x3", locked=4)
    env.reset(seed=0)
    kinds = [cell.type for cell in env.grid.grid if cell is not None]
    locked = [passage for passage in env.plan.passages if passage.locked]
    assert (len(locked), kinds.count("key")) == (4, 4)
    reached = {low_steps_between(env.plan, (*env.agent_pos, 0), env.plan.floor(room)) for room in env.maze.rooms}
    assert max(reached) < 200


def test_legs_slip_and_light_changes() -> None:
    env = Unsteady(rooms_env("3x3", view="rgb"), slips=0.5)
    env.reset(seed=0)
    headings = [env.step(LEFT)[-1]["heading"] for _ in range(60)]
    turned = sum((a - b) % 4 == 1 for a, b in pairwise(headings))
    assert 15 < turned < 45
    dim = Unsteady(rooms_env("3x3", view="rgb"), pixels=10.0, gain=0.1)
    first, second = (dim.reset(seed=1)[0]["image"] for _ in range(2))
    assert (first == second).all()
    assert abs(float(first.astype(float).std()) - float(env.reset(seed=1)[0]["image"].std())) > 0.01


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"least": 1}, "smaller rooms have no wall"),
        ({"most": 99}, "use 2 to 24"),
        ({"least": 6}, "at most"),
        ({"door": "left"}, "middle or anywhere"),
        ({"view": "lidar"}, "symbolic or rgb"),
        ({"white": (9, 9)}, "no room at"),
        ({"locked": 5}, "lock fewer"),
        ({"render_mode": "ascii"}, "render mode"),
        ({"side": 4}, "its fields are"),
    ],
)
def test_bad_input_is_refused_in_a_line(options: dict[str, Any], said: str) -> None:
    with pytest.raises(WorldError, match=said) as error:
        rooms_env("3x3", **options)
    assert "\n" not in str(error.value)


def test_other_bad_input() -> None:
    many = Maze("long", {(0, i): i for i in range(SIGHTS + 1)})
    with pytest.raises(WorldError, match=f"{len(COLOURS) - 1} colours"):
        RoomsEnv(many)
    with pytest.raises(WorldError, match="no maze is called 'x'"):
        rooms_env("x")
    with pytest.raises(WorldError, match="needs pixels"):
        Unsteady(rooms_env("3x3"), pixels=3.0)
    with pytest.raises(WorldError, match="'slips' is 2"):
        Unsteady(rooms_env("3x3"), slips=2.0)
    with pytest.raises(WorldError, match="unknown reset option"):
        rooms_env("3x3").reset(options={"keep": 1})
    with pytest.raises(WorldError, match="heading is 7"):
        rooms_env("3x3").reset(options={"heading": 7})
