"""Agents that begin with a map, go on with other settings, are told that they were moved, and hope for any sensor."""

from __future__ import annotations

import gzip
import json
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.model import CogmapError, NoPose, Sight, Ways
from cogmap.worlds import ListedWays, MazeEnv, labyrinth, load_world
from walks import GRID

from cogmap import UNSEEN


def rooms_of(name: str, *, positions: bool = True) -> Any:
    """A built-in maze as people would draw it."""
    maze, graph = load_world(name).unwrapped.maze, nx.Graph()
    for room in sorted(maze.rooms):
        graph.add_node(room, sight=maze.sights[room], **({"position": room} if positions else {}))
    for row, column in sorted(maze.rooms):
        for way, ahead in (("down", (row + 1, column)), ("right", (row, column + 1))):
            if ahead in maze.rooms:
                graph.add_edge((row, column), ahead, **({} if positions else {"way": way}))
    return graph


def directed(graph: Any) -> Any:
    """The same with a way label on each edge."""
    names = {displacement: name for name, displacement in GRID.items()}
    result = nx.DiGraph(motions={name: list(vector) for name, vector in GRID.items()})
    result.add_nodes_from((str(node), {"sight": facts["sight"]}) for node, facts in graph.nodes(data=True))
    for one, other in graph.to_directed().edges:
        result.add_edge(str(one), str(other), way=names[other[0] - one[0], other[1] - one[1]])
    return result


def assert_finds_itself(agent: Agent, name: str, *, start: tuple[int, int], steps: int = 4) -> None:
    """It knows within a few steps where it is, and its map is the world's."""
    world = load_world(name)
    world.reset(seed=0)
    observation = world.displace(start)
    rooms, at = sorted(world.unwrapped.maze.rooms), -1
    assert len(agent.map.visited_places) == len(rooms)
    for _ in range(steps):
        at = rooms.index(world.position)
        observation, *_ = world.step(agent.step(observation))
    assert agent.certain
    assert agent.belief.place == at
    assert len(agent.map.places) == len(rooms)


@pytest.mark.parametrize("name", ["4x4", "4x4_alias"])
@pytest.mark.parametrize("start", [(0, 0), (2, 1), (3, 3)])
def test_an_agent_with_a_map_finds_itself_in_it(name: str, start: tuple[int, int]) -> None:
    assert_finds_itself(Agent(GRID, map=rooms_of(name), seed=0), name, start=start)


def test_ways_say_where_places_lie() -> None:
    by_way = Agent(GRID, map=rooms_of("4x4_alias", positions=False), seed=0)
    by_position = Agent(GRID, map=rooms_of("4x4_alias"), seed=0)
    assert list(map(by_way.map.position, by_way.map.places)) == list(
        map(by_position.map.position, by_position.map.places)
    )
    assert_finds_itself(by_way, "4x4_alias", start=(1, 2))


@pytest.mark.parametrize("kind", ["json", "json.gz", "graphml", "old.json"])
def test_files_of_graphs_are_maps(kind: str, tmp_path: Path) -> None:
    graph, path = directed(rooms_of("4x4")), tmp_path / f"map.{kind}"
    if kind == "graphml":
        graph.graph.clear()
        nx.write_graphml(graph, path)
    else:
        text = json.dumps(nx.node_link_data(graph, edges="links" if kind.startswith("old") else "edges")).encode()
        path.write_bytes(gzip.compress(text) if kind.endswith("gz") else text)
    agent = Agent(GRID, map=path, seed=0) if kind == "graphml" else Agent(map=str(path), seed=0)
    assert agent.map.motions.names == tuple(GRID)
    assert_finds_itself(agent, "4x4", start=(2, 2))


ROBOT = """
- node:
    name: {0}
    pose: {{position: {{x: 0.0, y: 0.0, z: 0.0}}}}
    properties: {{sight: door}}
    edges: [{{node: hall, action: move_base}}]
- node:
    name: hall
    pose: {{position: {{x: 3.0, y: 0.5, z: 0.0}}}}
    edges: [{{node: porch}}, {{node: yard}}, {{node: shed}}]
- node: {{name: yard, pose: {{position: {{x: 3.0, y: 4.0, z: 0.0}}}}, edges: [{{node: hall}}, {{node: shed}}]}}
- node: {{name: shed, pose: {{position: {{x: 6.0, y: 4.0, z: 0.0}}}}, edges: [{{node: hall}}]}}
"""


@pytest.mark.parametrize("ending", ["yaml", "tmap2", "json"])
def test_files_that_worlds_are_made_of_are_maps_too(ending: str, tmp_path: Path) -> None:
    (path := tmp_path / "yard.yaml").write_text(ROBOT.format("porch"))
    world = ListedWays(load_world(path, sights="distinct", pose="none"))
    if ending == "json":
        graph: Any = nx.DiGraph()
        graph.add_nodes_from(
            (node, {"position": (x, y)}) for node, x, y in zip("phys", (0, 3, 3, 6), (0, 1, 4, 4), strict=True)
        )
        graph.add_edges_from(["ph", "hp", "hy", "hs", "yh", "ys", "sh"])
        (path := tmp_path / "yard.json").write_text(json.dumps(nx.node_link_data(graph, edges="edges")))
    elif ending == "tmap2":
        (path := tmp_path / "yard.tmap2").write_text("nodes:\n" + ROBOT.format("porch"))
    agent = Agent(world.motions if ending == "json" else None, map=path, seed=0)
    assert agent.map.motions.names == world.motions.names
    assert [[agent.map.beyond(place, way) for way in (1, 2, 3)] for place in range(4)] == [
        [1, None, None], [2, 3, 0], [3, 1, None], [1, None, None]
    ]  # fmt: skip
    seen, info = world.reset(seed=3)
    for _ in range(8):
        seen, *_, info = world.step(agent.step(seen))
    agent.step(seen)
    assert agent.certain
    assert ("porch", "hall", "yard", "shed")[agent.belief.place] == info["place"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: [", "is no graph in node-link JSON, GraphML or topological YAML"),
        ("- 3", "is no graph"),
        ("[]", "has no node"),
        ("- node: {name: A, edges: [{node: B}]}", "edge from 'A' leads to 'B', which is no node"),
        ("- node: {name: A, pose: {position: {x: a, y: 1}}, edges: [{node: A}]}", "where 'A' lies is no numbers"),
        ("- node: {name: A}", "it does not say 'motions'"),
    ],
)
def test_robots_maps_that_are_none(text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "map.yaml").write_text(text)
    with pytest.raises(CogmapError, match=message) as raised:
        Agent(map=tmp_path / "map.yaml")
    assert "\n" not in str(raised.value)


def test_what_one_agent_mapped_another_can_begin_with(tmp_path: Path) -> None:
    world, agent = load_world("3x3_alias"), Agent(GRID, seed=0)
    observation, _ = world.reset(seed=1)
    for _ in range(30):
        observation, *_ = world.step(agent.step(observation))
    assert len(agent.map.places) == 9
    (tmp_path / "map.json").write_text(agent.map.to_json())
    for known in (agent.map.to_networkx(), tmp_path / "map.json"):
        other = Agent(GRID, map=known, seed=0)
        assert list(map(other.map.position, other.map.places)) == list(map(agent.map.position, agent.map.places))
        seen = world.observe()
        for _ in range(5):
            seen, *_ = world.step(other.step(seen))
        assert other.certain
        assert len(other.map.places) == 9


def test_a_map_may_say_how_probably_a_place_shows_what(tmp_path: Path) -> None:
    row: Any = nx.Graph()
    for number, sight in enumerate([{"a": 0.7, "b": 0.3}, "c", {"a": 0.1, "b": 0.9}]):
        row.add_node(number, sight=sight, position=(0, number))
    nx.add_path(row, range(3))
    agent = Agent(GRID, map=row, seed=0)
    np.testing.assert_allclose(agent.map.A_o.dense(3)[:3], [[0.7, 0, 0.1], [0.3, 0, 0.9], [0, 1, 0]], atol=1e-3)
    (tmp_path / "map.json").write_text(agent.map.to_json())
    again = Agent(GRID, map=tmp_path / "map.json", seed=0)
    np.testing.assert_allclose(again.map.A_o.dense(3), agent.map.A_o.dense(3), atol=1e-3)
    agent.perceive({"sight": "b", "open": [False, False, False, True, True]})  # the ways say which
    assert agent.belief.place == 0
    again.perceive({"sight": "b", "open": [False, False, None, None, True]})
    assert again.belief.places == pytest.approx({0: 0.25, 2: 0.75}, abs=0.05)


def test_without_positions_places_may_hang_together_in_any_way() -> None:
    ring: Any = nx.DiGraph()
    for number in range(5):
        ring.add_node(number, sight="abcde"[number])
        ring.add_edge(number, (number + 1) % 5, way="right")
    agent = Agent(GRID, pose=NoPose(), map=ring, seed=0)
    right = list(GRID).index("right")
    assert [agent.map.beyond(place, right) for place in range(5)] == [1, 2, 3, 4, 0]
    agent.perceive({"sight": "d", "open": [False, False, False, True, True]})
    assert agent.belief.place == 3


def test_an_agent_with_a_map_is_saved_before_and_after_it_wakes_up(tmp_path: Path) -> None:
    agent = Agent(GRID, map=rooms_of("4x4_alias"), seed=0)
    world = load_world("4x4_alias")
    observation, _ = world.reset(seed=3)
    for _ in range(5):
        agent.save(tmp_path / "agent.npz")
        again = Agent.load(tmp_path / "agent.npz")
        action = agent.step(observation)
        assert again.step(observation) == action
        assert again.belief.places == pytest.approx(agent.belief.places)
        observation, *_ = world.step(action)


def one_more(**facts: Any) -> Any:
    graph = rooms_of("3x3")
    graph.add_node("attic", **facts)
    return graph


def linked(*ends: Any, **facts: Any) -> Any:
    graph = rooms_of("3x3")
    graph.add_edge(*ends, **facts)
    return graph


def placed(position: Any) -> Any:
    graph: Any = load_world("3x3").unwrapped.maze.to_networkx()
    graph.nodes[0, 0]["position"] = position
    return graph


BAD: dict[str, tuple[Any, str]] = {
    "a number": (3, "map: it is a int; give a networkx graph, or a file of one"),
    "no graph": (nx.Graph(), "map: it has no node"),
    "no file": ("nowhere.json", "map nowhere.json: it cannot be read"),
    "no graph in it": (__file__, "map .*: it is no graph in node-link JSON or GraphML|JSON"),
    "a far way": (linked((0, 0), (2, 2)), r"the way from .* is None, no action; label it 'way' with one of up, down"),
    "an unknown way": (linked((0, 0), (0, 1), way="jump"), "is 'jump', no action"),
    "two ways": (linked((0, 0), (2, 2), way="down"), "two ways of .* are '(down|up)'"),
    "two in one place": (one_more(sight=1, position=(1, 1)), r"two places lie at \(1, 1\)"),
    "nowhere at all": (nx.Graph([(0, 1, {"way": "up"}), (2, 3, {"way": "up"})]), "not all its places hang together"),
    "half a position": (one_more(sight=1, position=(0.5, 7)), r"position \(0.5, 7\) is not 2 whole numbers"),
    "a position in words": (placed("here"), r"\(0, 0\) lies at 'here' and .* give tuples of numbers"),
    "a position of one number": (placed(5), r"\(0, 0\) lies at 5 and .* give tuples of numbers"),
    "a short position": (one_more(sight=1, position=(7,)), "is not 2 whole numbers"),
    "a sight that is none": (one_more(sight={1: -1.0}, position=(7, 7)), "node 'attic': observation: sight has likel"),
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_no_map(name: str) -> None:
    map_, message = BAD[name]
    with pytest.raises(CogmapError, match=message) as raised:
        Agent(GRID, map=map_)
    assert "\n" not in str(raised.value)


def test_an_agent_needs_motions_from_somewhere() -> None:
    with pytest.raises(CogmapError, match=r"agent: it has no motions; give world\.motions"):
        Agent()
    with pytest.raises(CogmapError, match="it does not say 'motions'"):
        Agent(map=rooms_of("3x3"))


# -- going on --------------------------------------------------------------------------------------------------


def test_a_loaded_agent_goes_by_other_settings(tmp_path: Path) -> None:
    world, agent = load_world("3x3"), Agent(GRID, settings=Settings(look_ahead=3, window=8), seed=0)
    observation, _ = world.reset(seed=0)
    for _ in range(12):
        observation, *_ = world.step(agent.step(observation))
    agent.save(tmp_path / "agent.npz")
    settings = Settings(look_ahead=2, window=3, goal_weight=2.0)
    other = Agent.load(tmp_path / "agent.npz", settings=settings)
    assert other.settings == settings
    assert other.belief.places == agent.belief.places
    other.step(observation)
    assert len(other.window) == 4
    assert Agent.load(tmp_path / "agent.npz").settings == agent.settings


def test_an_agent_is_told_that_it_was_moved(tmp_path: Path) -> None:
    world, agent = load_world("4x4"), Agent(GRID, seed=0)
    observation, info = world.reset(seed=0)
    start = info["position"]
    for _ in range(30):
        observation, *_ = world.step(agent.step(observation))
    agent.perceive(observation)
    agent.moved()
    agent.save(tmp_path / "agent.npz")
    for each in (agent, Agent.load(tmp_path / "agent.npz")):
        each.perceive(world.displace((3, 0)))  # nothing was done in between, and need not be
        row, column = each.map.position(each.belief.place) or (9, 9)
        assert (row + start[0], column + start[1]) == (3, 0)
        each.perceive(world.displace((3, 0)) | {"taken": "stay"})
        assert each.belief.moved < 0.01  # it was told once


# -- hoping ----------------------------------------------------------------------------------------------------


def smelly(seen: Any, position: tuple[int, int]) -> dict[str, Any]:
    return {**seen, "smell": {(2, 2): "cheese", (0, 0): "bread"}.get(position, "nothing")}


def test_labels_of_any_sensor_can_be_hoped_for(tmp_path: Path) -> None:
    world = load_world("3x3")
    agent = Agent(GRID, sensors=[Sight(), Sight("smell"), Ways()], seed=0)
    observation, info = world.reset(seed=0)
    for _ in range(25):
        observation, *_, info = world.step(agent.step(smelly(observation, info["position"])))
    for hoped, there in (({"smell": {"cheese": 4.0}}, (2, 2)), ({"smell": {"bread": 4.0}}, (0, 0))):
        agent.prefer(sensors=hoped)
        agent.save(tmp_path / "agent.npz")
        agent = Agent.load(tmp_path / "agent.npz")
        for _ in range(8):
            observation, *_, info = world.step(agent.step(smelly(observation, info["position"])))
        assert info["position"] == there
        assert agent.preferences.sensors == hoped
    agent.prefer({world.unwrapped.maze.sights[0, 2]: 4.0}, sensors={"smell": {"cheese": 1.0}})
    for _ in range(8):
        observation, *_, info = world.step(agent.step(smelly(observation, info["position"])))
    assert info["position"] == (0, 2)


def test_labels_of_the_first_sensor_can_be_named_by_it() -> None:
    agent = Agent(GRID, seed=0)
    agent.step({"sight": 1, "open": UNSEEN})
    agent.prefer({1: 1.0}, sensors={"sight": {2: 3.0}})
    agent.step({"sight": 1, "open": UNSEEN})
    assert agent.preferences.sights == {1: 1.0, 2: 3.0}
    assert agent.preferences.sensors == {}


@pytest.mark.parametrize(
    ("sensors", "message"),
    [
        ({"smell": {1: 1.0}}, "no sensor 'smell' sees labels to prefer; those that do: 'sight'"),
        ({"open": {1: 1.0}}, "no sensor 'open' sees labels"),
        ({"sight": 3}, "preferences are a int; give a mapping"),
        ("sight", "preferences are a str; give a mapping"),
        ({"sight": {1: float("nan")}}, "preference nan of 1 is not a finite number"),
    ],
)
def test_what_no_sensor_sees_cannot_be_hoped_for(sensors: Any, message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        Agent(GRID, seed=0).prefer(sensors=sensors)


def test_a_large_map_is_not_in_doubt_because_it_is_large() -> None:
    maze = labyrinth(400, loops=0.1, sights=50, rng=np.random.default_rng(0))
    agent, world = Agent(GRID, map=maze.to_networkx(), seed=0), MazeEnv(maze)
    observation, _ = world.reset(options={"start": maze.rooms[5]})
    for _ in range(12):
        observation, *_ = world.step(agent.step(observation))
    assert agent.certain
    assert agent._recognition.question is None
