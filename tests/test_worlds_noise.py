from __future__ import annotations

from collections import Counter
from typing import Any

import gymnasium as gym
import networkx as nx
import numpy as np
import pytest
from cogmap.worlds import (
    MAZES,
    CanDisplace,
    GraphWorld,
    HasChart,
    Maze,
    MazeEnv,
    Motions,
    NoisyWorld,
    WorldError,
    load_world,
    offered,
    place_of,
)
from gymnasium import spaces
from gymnasium.utils.env_checker import check_env

STAY = 4


def noisy(name: str = "4x4", *, seed: int = 0, **noise: float) -> NoisyWorld:
    world = NoisyWorld(load_world(name), **noise)
    world.reset(seed=seed, options={"start": (1, 1) if (1, 1) in MAZES[name].sights else None})
    return world


def square(**options: Any) -> GraphWorld:
    graph = nx.grid_2d_graph(3, 3)
    for node, attributes in graph.nodes(data=True):
        attributes.update(position=(4.0 * node[0], 3.0 * node[1]), colour=node[0], smell="abc"[node[1]])
    return GraphWorld.from_networkx(graph, sensors=["colour", "smell"], **options)


def about(rate: float, n: int) -> Any:
    """Within four standard errors."""
    return pytest.approx(rate, abs=4 * np.sqrt(rate * (1 - rate) / n))


def test_without_noise_a_world_is_as_it_was() -> None:
    plain, wrapped = load_world("donut"), NoisyWorld(load_world("donut"), sight=0.0)
    assert plain.reset(seed=5)[1] == wrapped.reset(seed=5)[1]
    for action in (3, 1, 0, 2, 4):
        one, other = plain.step(action), wrapped.step(action)
        assert one[0]["sight"] == other[0]["sight"]
        assert one[0]["open"].tolist() == other[0]["open"].tolist()
        assert other[4] == {**one[4], "taken": action, "failed": False, "moved": False}


def test_sights_are_drawn_evenly_from_the_other_labels() -> None:
    world = noisy("4x4_alias", sight=0.3)
    true, n = MAZES["4x4_alias"].sights[1, 1], 4000
    seen = Counter(world.step(STAY)[0]["sight"] for _ in range(n))
    assert set(seen) == set(MAZES["4x4_alias"].sights.values())
    assert seen[true] / n == about(0.7, n)
    assert all(seen[label] / n == about(0.06, n) for label in seen if label != true)


def test_every_reading_of_a_way_flips_by_itself_and_stay_never() -> None:
    world, n = noisy("t_maze", door=0.2), 3000
    world.displace((0, 2))
    flags = np.array([world.step(STAY)[0]["open"] for _ in range(n)])
    assert flags[:, STAY].all()
    for action, is_open in enumerate([False, True, True, True]):
        assert flags[:, action].mean() == about(0.8 if is_open else 0.2, n)
    both = (~flags[:, 1] & ~flags[:, 2]).mean()
    assert both == about(0.04, n)


def test_slips_carry_out_another_action_drawn_evenly() -> None:
    world, n = noisy(slip=0.4), 4000
    taken: Counter[int] = Counter()
    for _ in range(n):
        world.displace((1, 1))
        _, _, _, _, info = world.step(0)
        taken[info["taken"]] += 1
        assert info["position"] == list(MAZES["4x4"].successors((1, 1)).values())[info["taken"]]
    assert taken[0] / n == about(0.6, n)
    assert all(taken[action] / n == about(0.1, n) for action in range(1, 5))


def test_failed_moves_leave_the_agent_where_it_is() -> None:
    world, n = noisy(fail=0.25), 2000
    failed = 0
    for _ in range(n):
        world.displace((1, 1))
        _, _, _, _, info = world.step(1)
        assert info["position"] == ((1, 1) if info["failed"] else (2, 1))
        failed += info["failed"]
    assert failed / n == about(0.25, n)


def test_moved_puts_the_agent_anywhere_that_is_not_closed() -> None:
    world, n = noisy("3x3", moved=0.5), 4000
    offered(world, HasChart, "test").close_room((2, 2))  # type: ignore[attr-defined]
    landed: Counter[tuple[int, int]] = Counter()
    for _ in range(n):
        observation, _, _, _, info = world.step(STAY)
        assert observation["sight"] == MAZES["3x3"].sights[info["position"]]
        assert info["position"] == world.place
        if info["moved"]:
            landed[info["position"]] += 1
    assert sum(landed.values()) / n == about(0.5, n)
    assert set(landed) == set(MAZES["3x3"].rooms) - {(2, 2)}
    assert all(count / sum(landed.values()) == about(1 / 8, sum(landed.values())) for count in landed.values())


def test_the_seed_of_reset_settles_the_noise_each_kind_by_itself() -> None:
    def walk(seed: int, **noise: float) -> list[tuple[Any, ...]]:
        world = noisy(seed=seed, **noise)
        return [
            (observation["sight"], tuple(observation["open"].tolist()))
            for observation, *_ in (world.step(STAY) for _ in range(30))
        ]

    assert walk(1, sight=0.5) == walk(1, sight=0.5) != walk(2, sight=0.5)
    assert [sight for sight, _ in walk(1, sight=0.5, door=0.5)] == [sight for sight, _ in walk(1, sight=0.5)]


def test_several_sensors_err_each_by_itself() -> None:
    world = NoisyWorld(square(), sight=0.5)
    world.reset(seed=0, options={"start": (1, 1)})
    n = 3000
    seen = [world.step(0)[0] for _ in range(n)]
    assert {(o["colour"], o["smell"]) for o in seen} == {(i, letter) for i in range(3) for letter in "abc"}
    wrong = [(o["colour"] != 1, o["smell"] != "b") for o in seen]
    assert np.mean(wrong, axis=0) == pytest.approx([0.5, 0.5], abs=0.04)
    assert np.mean([a and b for a, b in wrong]) == about(0.25, n)


def test_ways_of_a_place_flip_and_slips_take_another_of_them() -> None:
    world = NoisyWorld(square(), door=0.1, slip=0.3)
    world.reset(seed=0, options={"start": (0, 0)})
    shut, n, taken = 0, 2000, Counter[int]()
    for _ in range(n):
        observation = world.displace((0, 0))
        assert set(observation["ways"]) == {0, 90}
        shut += sum(not is_open for is_open in observation["ways"].values())
        taken[world.step(1)[4]["taken"]] += 1
    assert shut / (2 * n) == about(0.1, 2 * n)
    assert set(taken) == {0, 1, 2}
    assert taken[2] / n == about(0.15, n)


def test_odometry_errs_by_a_share_of_the_length_and_by_degrees() -> None:
    world, n = NoisyWorld(square(), odometry=0.05), 2000
    world.reset(seed=0)
    errors = []
    for _ in range(n):
        world.displace((0, 0))
        observation = world.step(2)[0]
        assert observation in world.observation_space
        errors.append(observation["displacement"] - (4.0, 0.0))
    assert np.std(errors, axis=0) == pytest.approx([0.2, 0.2], rel=0.08)
    turning = NoisyWorld(square(), heading=3.0)
    turning.reset(seed=0)
    angles = []
    for _ in range(n):
        turning.displace((0, 0))
        across, up = turning.step(2)[0]["displacement"]
        assert np.hypot(across, up) == pytest.approx(4.0)
        angles.append(np.rad2deg(np.arctan2(up, across)))
    assert np.std(angles) == pytest.approx(3.0, rel=0.08)
    assert abs(np.mean(angles)) < 0.3


def test_a_look_measures_no_move_and_staying_measures_none_exactly() -> None:
    world = NoisyWorld(square(), odometry=0.5)
    assert world.reset(seed=0, options={"start": (0, 0)})[0]["displacement"].tolist() == [0.0, 0.0]
    measured = world.step(2)[0]["displacement"]
    assert world.observe()["displacement"].tolist() == measured.tolist()
    assert world.displace((2, 2))["displacement"].tolist() == measured.tolist()
    assert world.step(0)[0]["displacement"].tolist() == [0.0, 0.0]
    moved = NoisyWorld(square(), moved=1.0)
    moved.reset(seed=0, options={"start": (0, 0)})
    assert moved.step(2)[0]["displacement"].tolist() == [4.0, 0.0]


def test_other_environments_err_in_what_they_have() -> None:
    class Lamp(gym.Env[dict[str, Any], int]):
        motions = load_world("3x3").motions
        action_space, observation_space = spaces.Discrete(5), spaces.Dict({"sight": spaces.Discrete(3, start=4)})

        def reset(self, *, seed: int | None = None, options: Any = None) -> Any:
            super().reset(seed=seed)
            return {"sight": 5}, {"place": "here"}

        def step(self, action: int) -> Any:
            return {"sight": 5}, 0.0, False, False, {"place": "here"}

    world = NoisyWorld(Lamp(), sight=1.0, slip=0.5)
    world.reset(seed=0)
    assert {world.step(0)[0]["sight"] for _ in range(40)} == {4, 6}
    for kind, message in (("door", "errs in 'open'"), ("odometry", "errs in 'displacement'"), ("moved", "HasChart")):
        with pytest.raises(WorldError, match=message):
            NoisyWorld(Lamp(), **{kind: 0.1})


def test_labels_that_nobody_lists_cannot_be_drawn() -> None:
    class Thermometer(gym.Env[dict[str, Any], int]):
        motions = Motions(("left", "right"), ((-1,), (1,)))
        observation_space = spaces.Dict({"sight": spaces.Box(0.0, 1.0)})

    with pytest.raises(WorldError, match="draws from the labels of 'sight'"):
        NoisyWorld(Thermometer(), sight=0.1)
    with pytest.raises(WorldError, match="needs an action that stays"):
        NoisyWorld(Thermometer(), fail=0.1)


@pytest.mark.filterwarnings("ignore:.*different from the unwrapped:UserWarning")
def test_noise_goes_through_gymnasiums_check_and_around_its_wrappers() -> None:
    check_env(NoisyWorld(load_world("4x4"), sight=0.2, door=0.2, slip=0.2, moved=0.1), skip_render_check=True)
    world = NoisyWorld(gym.make("cogmap/3x3-v0"), sight=0.1)
    _, info = world.reset(seed=1)
    assert offered(world, CanDisplace, "this") is world
    assert world.unwrapped.maze is MAZES["3x3"]  # type: ignore[attr-defined]
    assert world.place == place_of(info)


def test_one_label_cannot_be_misread() -> None:
    world = NoisyWorld(MazeEnv(Maze("grey", {(0, 0): 3, (0, 1): 3})), sight=1.0)
    assert world.reset(seed=0)[0]["sight"] == 3


@pytest.mark.parametrize(
    ("noise", "message"),
    [
        ({"sight": 1.5}, "noise 'sight' is 1.5; use a number from 0 to 1"),
        ({"door": -0.1}, "noise 'door' is -0.1"),
        ({"slip": float("nan")}, "noise 'slip' is nan"),
        ({"fail": True}, "noise 'fail' is True"),
        ({"moved": "often"}, "noise 'moved' is 'often'"),
        ({"heading": 200}, "noise 'heading' is 200; use a number from 0 to 180"),
        ({"fog": 0.1}, "unknown noise 'fog'; use sight, door, slip"),
        ({"odometry": 0.1}, "errs in 'displacement', and this world does not tell it"),
    ],
)
def test_impossible_noise_is_refused(noise: dict[str, Any], message: str) -> None:
    with pytest.raises(WorldError, match=message):
        NoisyWorld(load_world("3x3"), **noise)


def test_noise_needs_motions() -> None:
    with pytest.raises(WorldError, match=r"noise needs a world that is a cogmap\.worlds\.World"):
        NoisyWorld(gym.make("CartPole-v1"), sight=0.1)
