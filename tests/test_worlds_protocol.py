from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest
from cogmap.worlds import (
    MAZES,
    CanClose,
    CanDisplace,
    Chart,
    ChartPart,
    HasChart,
    ListedWays,
    World,
    WorldError,
    geometric,
    load_world,
    offered,
    place_of,
    torus,
    world_of,
)


def test_a_maze_offers_everything_through_wrappers() -> None:
    world = gym.make("cogmap/3x3-v0")
    for kind in (HasChart, CanDisplace, CanClose):
        assert offered(world, kind, "this") is world.unwrapped
    assert isinstance(world.unwrapped, World)
    assert isinstance(MAZES["3x3"], Chart)
    assert offered(world, HasChart, "this").chart is MAZES["3x3"]


def test_what_a_world_does_not_offer_is_named() -> None:
    with pytest.raises(WorldError, match=r"kidnapping needs a world that is a cogmap\.worlds\.CanDisplace"):
        offered(gym.make("CartPole-v1"), CanDisplace, "kidnapping")


def test_a_chart_makes_a_world() -> None:
    assert world_of(MAZES["donut"]).maze is MAZES["donut"]
    layout = torus(2, 3).layout
    assert world_of(layout).chart is layout
    with pytest.raises(WorldError, match="no world can be made of a dict"):
        world_of({})  # type: ignore[arg-type]


def test_info_tells_the_place_or_an_error_says_how_to() -> None:
    world = load_world("3x3")
    _, info = world.reset(options={"start": (1, 2)})
    assert place_of(info) == world.place == (1, 2)
    assert place_of({"place": "hall"}) == "hall"
    with pytest.raises(WorldError, match="tells no place"):
        place_of({})


def test_successors_of_a_maze_are_its_true_transitions() -> None:
    for maze in MAZES.values():
        for room in maze.rooms:
            ahead = maze.successors(room)
            assert list(ahead) == ["up", "down", "left", "right", "stay"]
            assert {other for other in ahead.values() if other != room} == set(maze.neighbours(room))
            assert ahead["stay"] == room
    with pytest.raises(WorldError, match="no room"):
        MAZES["t_maze"].successors((1, 0))


@pytest.mark.parametrize("whole", [MAZES["3x3"], torus(3, 3).chart], ids=lambda chart: chart.name)
def test_a_part_of_a_chart_is_a_chart(whole: Chart) -> None:
    part = ChartPart.around(whole, whole.places[:1])
    assert isinstance(part, Chart)
    beside = {*whole.successors(whole.places[0]).values()}
    assert set(part.places) == beside
    assert part.exits(whole.places[0]) == whole.exits(whole.places[0])
    for place in part.places:
        assert set(part.successors(place).values()) <= beside
        assert part.sights[place] == whole.sights[place]
        assert part.find(place) == place
        assert part.length(place, "up") == whole.length(place, "up")
    assert (part.name, part.motions) == (whole.name, whole.motions)
    assert (part.positions is None) == (whole.positions is None)
    with pytest.raises(WorldError, match="outside this part"):
        part.find(next(place for place in whole.places if place not in beside))


def test_ways_of_a_place_as_actions_of_the_whole_world() -> None:
    world = ListedWays(geometric(12, degree=3, seed=1))
    chart = world.unwrapped.chart
    most = max(len(chart.exits(place)) for place in chart.places)
    assert len(world.motions.names) == world.action_space.n == most
    observation, info = world.reset(seed=0)
    assert observation.keys() == {"sight", "open", "bearings", "displacement"}
    assert world.observation_space["open"].contains(observation["open"].astype("int8"))
    for place in chart.places:
        seen = world.displace(place)
        exits = list(chart.exits(place).values())
        assert seen["open"].tolist() == [True] * len(exits) + [False] * (most - len(exits))
        assert np.array_equal(world.observe()["open"], seen["open"])
        for action in range(most):
            world.displace(place)
            _, _, _, _, info = world.step(action)
            assert info["place"] == (exits[action] if action < len(exits) else place)
    with pytest.raises(WorldError, match="actions of the whole world already"):
        ListedWays(torus(3, 3))
