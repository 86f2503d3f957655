from __future__ import annotations

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import networkx as nx
import numpy as np
import pytest
from cogmap.worlds import (
    Chart,
    GraphWorld,
    MazeEnv,
    NoisyWorld,
    StateWorld,
    UnseenWays,
    WorldError,
    behaviour,
    distinguishable,
    frozen_lake,
    geometric,
    load_world,
    office,
    portal_hall,
    read_graph,
    ring,
    torus,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from shared import shared

fast = settings(max_examples=25, deadline=None)
RIGHT = 3


def ways(chart: Chart) -> set[tuple[Any, Any, Any]]:
    found = ((place, way, ahead) for place in chart.places for way, ahead in chart.exits(place).items())
    return {way for way in found if way[2] is not None and way[1] != "stay"}


@fast
@given(st.integers(1, 6), st.integers(1, 6))
def test_every_way_of_a_torus_is_open_and_n_of_them_come_round(rows: int, columns: int) -> None:
    chart = torus(rows, columns).chart
    assert len(ways(chart)) == 4 * rows * columns
    for place in chart.places:
        for way, times in (("up", rows), ("right", columns)):
            here = place
            for _ in range(times):
                here = chart.successors(here)[way]
            assert here == place


def test_toruses_are_those_of_the_shared_cases() -> None:
    for size in (3, 4, 5):
        ours, theirs = torus(size, size).chart, read_graph(shared(f"cases/torus_{size}x{size}.json"))
        named = {(f"{a[0]},{a[1]}", way, f"{b[0]},{b[1]}") for a, way, b in ways(ours)}
        assert named == ways(theirs)
        assert list(ours.sights.values()) == list(theirs.sights.values())


def test_labels_of_a_torus_are_distinct_drawn_or_diagonal() -> None:
    assert len(set(torus(4, 4).chart.sights.values())) == 16
    assert torus(4, 4, sights=6, seed=1).chart == torus(4, 4, sights=6, seed=1).chart
    assert set(torus(9, 9, sights=6, seed=1).chart.sights.values()) == set(range(6))
    assert torus(4, 5, diagonal=3).chart.sights[3, 2] == 2
    assert len(set(behaviour(torus(3, 3, diagonal=3).chart).values())) == 3
    assert distinguishable(torus(4, 4, diagonal=3).chart)


@fast
@given(st.integers(2, 5), st.integers(2, 5), st.integers(0, 3), st.integers(0, 99))
def test_portals_join_opposite_sides_both_ways(rows: int, columns: int, portals: int, seed: int) -> None:
    chart = portal_hall(rows, columns, portals=portals, seed=seed).chart
    inside = 2 * (2 * rows * columns - rows - columns)
    assert len(ways(chart)) == inside + 2 * portals
    opposite = {"up": "down", "down": "up", "left": "right", "right": "left"}
    assert all((b, opposite[way], a) in ways(chart) for a, way, b in ways(chart))


def test_a_ring_leads_on_and_perhaps_back() -> None:
    one_way = ring(6).chart
    assert one_way.successors((0, 5)) == {"up": (0, 5), "down": (0, 5), "left": (0, 5), "right": (0, 0), "stay": (0, 5)}
    assert len(ways(one_way)) == 6
    assert ring(6, one_way=False).chart.successors((0, 0))["left"] == (0, 5)
    with_ours = {(f"{a[0]},{a[1]}", way, f"{b[0]},{b[1]}") for a, way, b in ways(one_way)}
    assert with_ours == ways(read_graph(shared("cases/one_way_ring.json")))


@pytest.mark.parametrize("degree", [0.5, 4.0, 8.0])
def test_random_geometric_graphs_join_what_is_near_in_one_piece(degree: float) -> None:
    world = geometric(400, degree=degree, sights="ways", seed=3)
    chart = world.layout
    assert chart == geometric(400, degree=degree, sights="ways", seed=3).layout
    assert chart.coordinates is not None
    assert chart.lengths is not None
    graph = nx.Graph((a, b) for a, _, b in ways(chart))
    assert nx.is_connected(graph)
    assert graph.number_of_nodes() == 400
    near = np.sqrt(degree / np.pi)
    apart = np.linalg.norm(chart.coordinates[:, None] - chart.coordinates, axis=2)
    assert np.sum(chart.lengths <= near) == np.sum(apart <= near) - 400
    longer = nx.Graph((a, b) for a, way, b in ways(chart) if (chart.length(a, way) or 0.0) > near)
    assert nx.is_forest(longer) if longer else True
    if degree > 1:
        assert np.diff(chart.first).mean() == pytest.approx(degree, rel=0.2)


@fast
@given(st.integers(1, 4), st.integers(1, 7), st.integers(0, 99))
def test_an_office_has_a_door_from_every_room_to_its_corridor(corridors: int, length: int, seed: int) -> None:
    maze = office(corridors, length, seed=seed)
    assert len(maze.rooms) == 3 * corridors * (length + 1)
    for row, column in maze.rooms:
        if column > 0 and row % 3 != 1:
            corridor = (row + 1 if row % 3 == 0 else row - 1, column)
            assert corridor in maze.neighbours((row, column))
            assert (row, 0) not in maze.neighbours((row, column))
    assert len(office(corridors, length, doors=0.0).doors) <= len(maze.doors)
    rooms_alone = office(corridors, length, doors=0.0)
    assert all(len(rooms_alone.neighbours((3 * c, length))) == 1 for c in range(corridors))


def test_an_office_is_a_maze_to_live_in() -> None:
    world = MazeEnv(office(2, 5, sights=4))
    assert world.reset(seed=0)[0] in world.observation_space


def test_a_world_without_a_sensor_of_ways_tells_nothing_of_them() -> None:
    world = UnseenWays(load_world("3x3"))
    observation, _ = world.reset(seed=0, options={"start": (0, 0)})
    assert observation == {"sight": 0}
    assert observation in world.observation_space
    assert world.step(RIGHT)[0] == {"sight": 1}
    assert world.displace((2, 2)) == world.observe() == {"sight": 8}
    graph = nx.cycle_graph(3)
    nx.set_node_attributes(graph, 7, "sight")
    local = UnseenWays(GraphWorld.from_networkx(graph))
    assert local.reset(seed=0)[0] == {"sight": 7, "ways": {0: None, 1: None}}
    noisy = NoisyWorld(UnseenWays(load_world("3x3")), sight=0.5, slip=0.5)
    assert set(noisy.reset(seed=0)[0]) == {"sight"}
    with pytest.raises(WorldError, match="errs in 'open'"):
        NoisyWorld(UnseenWays(load_world("3x3")), door=0.5)


def test_the_frozen_lake_is_a_world() -> None:
    world = frozen_lake(4, 4)
    assert world.motions.names == ("left", "down", "right", "up", "stay")
    observation, info = world.reset(seed=0)
    assert (observation, info["place"]) == ({"sight": 0}, 0)
    moves = [2, 2, 4, 1, 3, 3, 0]
    assert [world.step(action)[0]["sight"] for action in moves] == [1, 2, 2, 6, 2, 2, 1]
    assert all(not world.step(1)[2] for _ in range(300))
    assert world.step(2)[0] in world.observation_space


def test_the_slippery_lake_slips_to_the_sides() -> None:
    world = frozen_lake(5, 5, slippery=True)
    seen = set()
    for seed in range(60):
        world.reset(seed=seed)
        for action in (2, 1):
            before = world.step(4)[0]["sight"]
            seen.add((action, world.step(action)[0]["sight"] - before))
    assert {(2, 1), (2, 5), (1, 5), (1, 1)} <= seen


def test_what_observes_by_more_than_a_number_needs_a_wrapper_of_its_own() -> None:
    with pytest.raises(WorldError, match="wrapper of your own"):
        StateWorld(gym.make("CartPole-v1"), {"left": (-1,), "right": (1,)})
    with pytest.raises(WorldError, match="3 motions were given"):
        StateWorld(gym.make("FrozenLake-v1"), {"left": (-1,), "right": (1,), "wait": (0,)})
    waiting = StateWorld(gym.make("FrozenLake-v1"), {"left": (-1,), "right": (1,), "wait": (0,), "up": (2,)})
    assert waiting.motions.names == ("left", "right", "wait", "up")


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: torus(0, 3), "rows is 0"),
        (lambda: torus(3, 3, diagonal=0), "diagonal is 0"),
        (lambda: torus(3, 3, sights="all"), "sights 'all' cannot be given"),
        (lambda: portal_hall(1, 1, portals=9), "9 portals do not fit 1 by 1 rooms"),
        (lambda: portal_hall(2, 2, portals=-1), "portals is -1"),
        (lambda: ring(1), "places is 1"),
        (lambda: geometric(2), "places is 2"),
        (lambda: geometric(9, degree=0.0), "degree is 0.0"),
        (lambda: geometric(9, degree=float("nan")), "degree is nan"),
        (lambda: office(0, 3), "corridors is 0"),
        (lambda: office(1, 3, doors=2.0), "doors is 2.0"),
        (lambda: frozen_lake(0, 1), "rows is 0"),
    ],
)
def test_impossible_sizes_are_refused(build: Callable[[], Any], message: str) -> None:
    with pytest.raises(WorldError, match=message):
        build()
