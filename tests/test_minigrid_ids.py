"""Environments of MiniGrid by their ids: rooms to explore, and missions to fulfil."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.body import PixelView, RegisteredWorld, embodied, errand_of
from cogmap.experiments import ids_result, is_registered, run_id, run_ids
from cogmap.model import CogmapError
from cogmap.worlds import WorldError
from command_line import cogmap


def test_rooms_behind_doors_are_explored_and_the_goal_is_reached() -> None:
    explored = run_id("MiniGrid-MultiRoom-N4-S5-v1", 1, errand=False)
    assert (explored.rooms, explored.explored, explored.reached) == (4, True, False)
    reached = run_id("MiniGrid-MultiRoom-N4-S5-v1", 1, errand=True)
    assert reached.reached
    assert reached.low_level_steps <= 60


@pytest.mark.parametrize("name", ["MiniGrid-FourRooms-v0", "BabyAI-GoToObjMazeS4-v0", "BabyAI-PickupLoc-v0"])
def test_pixels_and_symbols_lead_to_the_same_steps(name: str) -> None:
    runs = [run_id(name, 2, errand=True, view=view) for view in ("symbolic", "rgb")]
    assert runs[0] == runs[1]
    assert runs[0].reached


@pytest.mark.parametrize(
    ("name", "most"),
    [
        ("MiniGrid-DoorKey-8x8-v0", 60),
        ("MiniGrid-UnlockPickup-v0", 60),
        ("MiniGrid-BlockedUnlockPickup-v0", 60),
        ("MiniGrid-LockedRoom-v0", 150),
        ("MiniGrid-KeyCorridorS3R3-v0", 100),
        ("MiniGrid-Unlock-v0", 40),
        ("MiniGrid-ObstructedMaze-1Dlhb-v0", 60),  # the key lies in a box, the door is blocked by a ball
        ("MiniGrid-LavaCrossingS9N2-v0", 40),
        ("MiniGrid-Fetch-8x8-N3-v0", 40),
    ],
)
def test_keys_open_what_stands_in_the_way(name: str, most: int) -> None:
    run = run_id(name, 2, errand=True)
    assert run.reached
    assert run.low_level_steps < most


@pytest.mark.parametrize(("name", "seed"), [("MiniGrid-DoorKey-6x6-v0", 48), ("MiniGrid-BlockedUnlockPickup-v0", 66)])
def test_what_hides_the_way_is_taken_up(name: str, seed: int) -> None:
    run = run_id(name, seed, errand=True)  # the key lies beside it, in a room one tile wide; a ball hides the door
    assert run.reached
    assert run.low_level_steps < 60


def test_the_agent_plans_with_keys_and_the_body_only_moves() -> None:
    world = RegisteredWorld("MiniGrid-DoorKey-8x8-v0", errand=True)
    agent, (seen, _) = Agent(world.motions, seed=2), world.reset(seed=2)
    for _ in range(3):
        seen, *_ = world.step(len(world.motions.names) - 1)
    assert (seen["carried"], world.body.held) == ("nothing", None)  # which knows of the key, and of the door
    assert seen["locks"]
    action = agent.step(seen)
    assert [world.motions.names[a] for a in agent.plan.policy][:2] == ["take yellow key", "door 0"]
    seen, *_ = world.step(action)
    assert (seen["carried"], seen["outcome"], world.body.held) == ("yellow key", "arrived", "a yellow key")
    assert agent.step(seen) == 0
    assert agent.contexts["yellow key"] > 0.99


def test_every_room_is_entered_the_locked_one_too() -> None:
    world = RegisteredWorld("MiniGrid-KeyCorridorS6R3-v0")
    inside, act = set[tuple[int, int]](), world.env.step

    def step(action: Any) -> Any:
        done = act(action)
        x, y = map(int, world.env.unwrapped.agent_pos)
        room = world.env.unwrapped.room_from_pos(x, y)
        inside.update([room.top] if room.pos_inside(x, y) else [])
        return done

    world.env.step = step
    agent, (seen, _) = Agent(world.motions, seed=14), world.reset(seed=14)
    for _ in range(20):
        seen, *_ = world.step(agent.step(seen))
    assert len(inside) == 9
    assert world.body.held is not None


def test_what_could_not_be_passed_is_told() -> None:
    world = RegisteredWorld("MiniGrid-LockedRoom-v0")
    seen, _ = world.reset(seed=2)
    grid, agent = world.env.unwrapped.grid, Agent(world.motions, seed=0)
    at = next(i for i, thing in enumerate(grid.grid) if thing is not None and thing.type == "key")
    grid.grid[at] = None
    for _ in range(14):
        seen, *_ = world.step(agent.step(seen))
    assert len(world.body.bars) == 1
    assert world.body.bars[0].endswith("door; its key was not seen")
    assert world.body.held is None


def test_several_doors_may_lie_in_one_wall() -> None:
    world = RegisteredWorld("MiniGrid-LockedRoom-v0")
    seen, _ = world.reset(seed=0)
    doors = [way for way, is_open in enumerate(seen["open"][:-1]) if is_open]
    assert len(doors) == 5  # three in each wall, one of them locked
    for door in doors:
        there, *_ = world.step(door)
        assert there["outcome"] == "arrived"
        assert there["open"][door]
        back, *_ = world.step(door)
        assert (back["sight"], back["open"]) == (seen["sight"], seen["open"])


def test_a_locked_door_without_its_key_is_shut() -> None:
    world, outcomes = embodied("3x3", locked=4), set[str]()
    for seed in range(6):
        world.reset(seed=seed)
        locked = {pair for passage in world.rooms.plan.passages if passage.locked for pair in (passage.rooms,)}
        way, room = next(
            (way, room) for way, room in world.maze.exits(world.place).items() if room != world.place and room
        )
        pair = (world.place, room) if world.place < room else (room, world.place)
        seen, *_, info = world.step(world.motions.names.index(way))
        assert (info["position"] == room) == (pair not in locked)
        assert seen["outcome"] == ("blocked" if pair in locked else "arrived")
        outcomes.add(seen["outcome"])
    assert outcomes == {"arrived", "blocked"}


def test_missions_are_read() -> None:
    assert errand_of("traverse the rooms to get to the goal") is not None
    found = errand_of("go to a red ball")
    assert found is not None
    assert (int(found.wanted.sum()), found.upon, found.action) == (1, False, None)
    box = errand_of("pick up the box")
    assert box is not None
    assert (int(box.wanted.sum()), box.action) == (6, "pickup")
    for mission in (
        "put the red ball next to the box",
        "go to the red ball then open the door",
        "dance",
        "avoid the goal",
    ):
        assert errand_of(mission) is None


def test_the_view_in_pixels_is_minigrids_own() -> None:
    from minigrid.wrappers import RGBImgPartialObsWrapper

    ours = PixelView(gym.make("BabyAI-GoToObjMazeS4-v0"))
    theirs = RGBImgPartialObsWrapper(gym.make("BabyAI-GoToObjMazeS4-v0"))
    seen = [env.reset(seed=3)[0]["image"] for env in (ours, theirs)]
    for action in (0, 2, 2, 1, 2, 5, 3):
        assert np.array_equal(*seen)
        assert seen[0] in ours.observation_space["image"]
        seen = [env.step(action)[0]["image"] for env in (ours, theirs)]


def test_sweeps_and_the_command(tmp_path: Path) -> None:
    runs = run_ids("MiniGrid-MultiRoom-N2-S4-v0", runs=2, errand=True)
    summary = ids_result("x", runs, errand=True)["summary"]
    assert summary["reached"] == 2
    assert summary["mean_low_level_steps"] == np.mean([run.low_level_steps for run in runs])
    file = tmp_path / "runs.json"
    name = "MiniGrid-MultiRoom-N2-S4-v0"
    assert cogmap("navigate", name, "--unexplored", "--runs", 2, "--json", file).exit_code == 0
    assert json.loads(file.read_text())["runs"] == [run.to_dict() for run in runs]
    assert "rooms visited" in cogmap("explore", name, "--view", "rgb").stdout
    assert is_registered(name)
    assert not is_registered("4x4_alias")
    assert not is_registered("cogmap/4x4-v0")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["explore", "MiniGrid-Nowhere-v0"], "is registered"),
        (["explore", "CartPole-v1"], "is no world of MiniGrid"),
        (["explore", "MiniGrid-FourRooms-v0", "--view", "lidar"], "symbolic or rgb"),
        (["explore", "MiniGrid-FourRooms-v0", "--noise", "sight=0.1"], "--noise is for worlds whose truth is known"),
        (["navigate", "MiniGrid-FourRooms-v0"], "without --unexplored"),
        (["navigate", "MiniGrid-FourRooms-v0", "--unexplored", "--goal", "3"], "--goal is for"),
        (["navigate", "BabyAI-PutNextLocal-v0", "--unexplored"], "none that a body understands"),
        (["navigate", "3x3"], "give --goal"),
    ],
)
def test_bad_input(arguments: list[str], said: str) -> None:
    result = cogmap(*arguments)
    assert result.exit_code == 2
    assert said in result.stderr
    assert result.stderr.count("\n") == 1


def test_bad_input_of_functions() -> None:
    with pytest.raises(CogmapError, match="seed is -1"):
        run_id("MiniGrid-FourRooms-v0", -1, errand=True)
    with pytest.raises(WorldError, match="is registered"):
        RegisteredWorld("NoSuch-v3")


def test_what_lies_in_a_doorway_is_taken_up() -> None:
    assert run_id("BabyAI-GoTo-v0", 36, errand=True).reached  # a key behind the door that leads on
