from __future__ import annotations

import json
import pickle
import warnings
from pathlib import Path
from typing import Any

import gymnasium as gym
import networkx as nx
import numpy as np
import pytest
from cogmap.worlds import (
    CanClose,
    CanDisplace,
    Chart,
    GraphWorld,
    HasChart,
    MazeEnv,
    World,
    WorldError,
    load_world,
    offered,
    place_of,
    read_graph,
)
from gymnasium.utils.env_checker import check_env
from hypothesis import given, settings
from hypothesis import strategies as st
from shared import shared

fast = settings(max_examples=30, deadline=None)


def street(size: int, seed: int) -> nx.DiGraph:
    """A strongly connected graph: a ring of one-way ways and some ways across, with positions."""
    rng = np.random.default_rng(seed)
    graph = nx.DiGraph(name="street")
    for node in range(size):
        graph.add_node(node, sight=int(rng.integers(3)), position=rng.uniform(0.0, 9.0, size=2).tolist())
    graph.add_edges_from((node, (node + 1) % size) for node in range(size))
    graph.add_edges_from(rng.integers(size, size=(size, 2)).tolist())
    graph.remove_edges_from(list(nx.selfloop_edges(graph)) if size > 1 else [])
    return graph


def square(**extra: Any) -> dict[str, Any]:
    """Four places in a ring, east, south, west, north, as node-link data that can be spoilt."""
    ways = ["east", "south", "west", "north"]
    return {
        "directed": True,
        "multigraph": False,
        "graph": {"name": "square"},
        "nodes": [{"id": i, "sight": f"s{i}"} for i in range(4)],
        "edges": [{"source": i, "target": (i + 1) % 4, "way": ways[i]} for i in range(4)],
        **extra,
    }


def written(folder: Path, data: Any, name: str = "world.json") -> Path:
    path = folder / name
    path.write_text(data if isinstance(data, str) else json.dumps(data))
    return path


@fast
@given(st.integers(1, 12), st.integers(0, 999))
def test_moves_follow_the_ways_of_the_graph_and_displacements_add_up(size: int, seed: int) -> None:
    graph = street(size, seed)
    world = GraphWorld.from_networkx(graph)
    observation, info = world.reset(seed=seed)
    begin, moved = graph.nodes[place_of(info)]["position"], np.zeros(2)
    for _ in range(20):
        here, ways = place_of(info), list(observation["ways"])
        assert set(world.chart.successors(here).values()) - {here} == set(graph[here]) - {here}
        assert observation["bearings"].keys() == observation["ways"].keys()
        action = int(world.np_random.integers(1 + len(ways)))
        observation, _, _, _, info = world.step(action)
        assert observation in world.observation_space
        target = world.chart.successors(here)["stay" if action == 0 else ways[action - 1]]
        assert place_of(info) == target
        assert observation["sight"] == graph.nodes[target]["sight"]
        moved += observation["displacement"]
        assert info["cost"] == pytest.approx(np.linalg.norm(observation["displacement"]))
        assert graph.nodes[target]["position"] == pytest.approx(np.add(begin, moved).tolist())


@fast
@given(st.integers(2, 10), st.integers(0, 999))
def test_json_graphml_and_networkx_are_the_same_world(tmp_path_factory: Any, size: int, seed: int) -> None:
    folder, graph = tmp_path_factory.mktemp("graphs"), street(size, seed)
    data = {key: value for key, value in nx.node_link_data(graph).items() if key not in ("edges", "links")}
    ways = [{"source": a, "target": b, **attributes} for a, b, attributes in graph.edges(data=True)]
    layout = GraphWorld.from_networkx(graph).layout
    for key in ("edges", "links"):  # networkx has written the one and the other
        assert read_graph(written(folder, {**data, key: ways})) == layout
    for _, attributes in graph.nodes(data=True):
        attributes["x"], attributes["y"] = attributes.pop("position")
    nx.write_graphml(graph, folder / "street.graphml")
    other = read_graph(folder / "street.graphml")
    assert (other.ways, other.labels, other.motions) == (layout.ways, layout.labels, layout.motions)
    assert np.allclose(other.bearings, layout.bearings)
    assert list(other.places) == [str(place) for place in layout.places]


def test_bearings_are_degrees_clockwise_from_north_and_name_the_ways() -> None:
    graph = nx.Graph()
    for name, position in {"m": (0, 0), "n": (0, 2), "e": (3, 0), "s": (0, -1), "w": (-1, 0)}.items():
        graph.add_node(name, sight=name, position=position)
    graph.add_edges_from(("m", name) for name in "nesw")
    world = GraphWorld.from_networkx(graph)
    observation, _ = world.reset(options={"start": "m"})
    assert observation["ways"] == {0: True, 90: True, 180: True, 270: True}
    assert observation["bearings"] == {0: 0.0, 90: 90.0, 180: 180.0, 270: 270.0}
    assert world.chart.successors("m") == {"stay": "m", 0: "n", 90: "e", 180: "s", 270: "w"}
    assert world.step(2)[0]["displacement"].tolist() == [3.0, 0.0]
    assert world.step(0)[0]["displacement"].tolist() == [0.0, 0.0]


def test_what_is_told_of_a_pose_is_an_option() -> None:
    graph = street(5, 0)
    keys = {
        pose: set(GraphWorld.from_networkx(graph, pose=pose).reset(seed=0)[0])
        for pose in ("displacement", "lengths", "bearing", "none")
    }
    assert keys == {
        "displacement": {"sight", "ways", "bearings", "displacement"},
        "lengths": {"sight", "ways", "bearings", "displacement", "lengths"},
        "bearing": {"sight", "ways", "bearings"},
        "none": {"sight", "ways"},
    }
    numbered = GraphWorld.from_networkx(graph, pose="none")
    assert all(list(numbered.chart.exits(place)) == ["stay", *range(graph.out_degree(place))] for place in graph)
    assert numbered.chart.positions is not None
    with pytest.raises(WorldError, match="pose 'motions' is not known; use one of displacement, lengths, bearing"):
        GraphWorld.from_networkx(graph, pose="motions")
    with pytest.raises(WorldError, match="unknown pose 'lattice'"):
        GraphWorld.from_networkx(graph, pose="lattice")


def test_bearings_and_lengths_do_without_positions() -> None:
    graph = nx.DiGraph()
    graph.add_nodes_from("ab", sight="grey")
    graph.add_edge("a", "b", bearing=90, length=2.0)
    graph.add_edge("b", "a", bearing=-90, length=3.0)
    world = GraphWorld.from_networkx(graph)
    world.reset(options={"start": "a"})
    observation, _, _, _, info = world.step(1)
    assert np.allclose(observation["displacement"], [2.0, 0.0])
    assert info == {"place": "b", "cost": 2.0}
    assert observation["bearings"] == {270: 270.0}


def test_few_names_of_ways_are_actions_of_the_world_and_many_belong_to_the_place(tmp_path: Path) -> None:
    few = load_world(written(tmp_path, square()))
    assert few.motions.names == ("east", "south", "west", "north", "stay")
    assert (few.motions.displacements, few.motions.reverse, few.motions.local) == ((), (), False)
    observation, _ = few.reset(options={"start": 1})
    assert observation["open"].tolist() == [False, True, False, False, True]
    many = nx.cycle_graph(30)
    nx.set_node_attributes(many, 0, "sight")
    nx.set_edge_attributes(many, {edge: f"door {i}" for i, edge in enumerate(many.edges)}, "way")
    world = GraphWorld.from_networkx(many)
    assert (world.motions.names, world.motions.local) == (("stay",), True)
    assert set(world.reset(options={"start": 0})[0]["ways"]) == {"door 0", "door 1"}


def test_which_action_undoes_which_is_told_where_one_always_does(tmp_path: Path) -> None:
    grid = nx.DiGraph()
    grid.add_nodes_from((node, {"sight": 0}) for node in nx.grid_2d_graph(3, 3))
    for row, column in list(grid):
        for way, there in {"n": (row - 1, column), "s": (row + 1, column), "e": (row, column + 1)}.items():
            if there in grid:
                grid.add_edge((row, column), there, way=way)
                grid.add_edge(there, (row, column), way={"n": "s", "s": "n", "e": "w"}[way])
    motions = GraphWorld.from_networkx(grid).motions
    assert {motions.names[i]: motions.names[j] for i, j in enumerate(motions.reverse)} == {
        "n": "s",
        "s": "n",
        "e": "w",
        "w": "e",
        "stay": "stay",
    }
    grid.graph["reverse"] = {}
    assert GraphWorld.from_networkx(grid).motions.reverse == ()


def test_declared_motions_are_the_actions_and_stay_is_added(tmp_path: Path) -> None:
    motions = {"east": [0, 1], "west": [0, -1], "north": [-1, 0], "south": [1, 0]}
    path = written(tmp_path, square(graph={"motions": motions}))
    world = load_world(path)
    assert world.motions.names == ("east", "west", "north", "south", "stay")
    assert world.motions.displacements == ((0, 1), (0, -1), (-1, 0), (1, 0), (0, 0))
    assert world.motions.reverse == (1, 0, 3, 2, 4)
    assert load_world(path, pose="none").motions.displacements == ()
    assert set(world.reset(seed=0)[0]) == {"sight", "open"}


def test_undirected_edges_are_walked_both_ways() -> None:
    motions = {"left": (-1,), "right": (1,)}
    line = nx.path_graph(3)
    nx.set_node_attributes(line, {i: i for i in range(3)}, "sight")
    nx.set_edge_attributes(line, "right", "way")
    line.graph["motions"] = motions
    world = GraphWorld.from_networkx(line)
    assert world.chart.successors(1) == {"left": 0, "right": 2, "stay": 1}
    line.graph["motions"] = {"right": (1,)}
    with pytest.raises(WorldError, match="no motion undoes 'right'"):
        GraphWorld.from_networkx(line)
    line.graph.clear()
    with pytest.raises(WorldError, match="two ways at 1 are called 'right'"):
        GraphWorld.from_networkx(line)


def test_two_ways_may_join_the_same_places_and_a_way_may_lead_back() -> None:
    graph = nx.MultiDiGraph()
    graph.add_nodes_from("ab", sight="same")
    for way in ("door", "hatch"):
        graph.add_edge("a", "b", way=way)
    graph.add_edge("b", "a", way="door")
    graph.add_edge("b", "b", way="loop")
    world = GraphWorld.from_networkx(graph)
    assert world.chart.exits("b") == {"door": "a", "hatch": None, "loop": "b", "stay": "b"}
    observation, _ = world.reset(options={"start": "b"})
    assert observation["open"].tolist() == [True, False, True, True]
    assert world.step(2)[4]["place"] == "b"


def test_several_sensors_have_keys_of_their_own(tmp_path: Path) -> None:
    nodes = [{"id": i, "colour": c, "smell": s, "area": 1.5} for i, (c, s) in enumerate(["ra", "rb", "ga", "gb"])]
    world = load_world(written(tmp_path, square(nodes=nodes)))
    observation, _ = world.reset(options={"start": 2})
    assert (observation["colour"], observation["smell"]) == ("g", "a")
    assert "sight" not in observation
    assert world.chart.sights[1] == ("r", "b")
    one = load_world(written(tmp_path, square(nodes=nodes, graph={"sensors": ["smell"]})))
    assert set(one.reset(seed=0)[0]) == {"smell", "open"}
    assert set(load_world(written(tmp_path, square(nodes=nodes)), sensors=["area"]).reset()[0]) == {"area", "open"}


def test_sights_are_given_to_nodes_that_have_none(tmp_path: Path) -> None:
    nodes: list[dict[str, Any]] = [{"id": i} for i in range(4)]
    path = written(tmp_path, square(nodes=nodes))
    with pytest.raises(WorldError, match=r"nodes have no sights; give each a 'sight', or use sights='distinct'"):
        load_world(path)
    assert list(read_graph(path, sights="distinct").sights.values()) == [0, 1, 2, 3]
    assert list(read_graph(path, sights="ways").sights.values()) == [1, 1, 1, 1]
    drawn = [read_graph(path, sights="3", seed=seed).labels for seed in (1, 1, 2, 3, 4)]
    assert drawn[0] == drawn[1]
    assert len(set(drawn)) > 1
    nodes[1]["sight"] = 0
    path = written(tmp_path, square(nodes=nodes))
    with pytest.raises(WorldError, match=r"3 of 4 nodes have no 'sight' \(0, 2, 3\)"):
        load_world(path)
    labels = list(read_graph(path, sights="distinct").sights.values())
    assert labels[1] == 0
    assert len(set(labels)) == 4


def test_closures_and_displacing_go_by_the_names_of_places(tmp_path: Path) -> None:
    graph = nx.cycle_graph(4)
    nx.set_node_attributes(graph, 0, "sight")
    world = GraphWorld.from_networkx(graph)
    for kind in (World, HasChart, CanDisplace, CanClose):
        assert offered(world, kind, "this") is world
    world.reset(options={"start": 0})
    world.close_room(1)
    world.close_door(0, 3)
    assert world.observe()["ways"] == {0: False, 1: False}
    assert world.step(1)[4]["place"] == 0
    assert world.displace(2)["ways"] == {0: False, 1: True}
    assert (world.closed_rooms, world.closed_doors) == ({1}, {(0, 3)})
    assert not hasattr(world, "maze")
    for call in (world.displace, world.close_room):
        with pytest.raises(WorldError, match="no place 'attic'"):
            call("attic")
    with pytest.raises(WorldError, match="no door between 0 and 2"):
        world.close_door(0, 2)


def test_a_refused_reset_leaves_the_agent_and_what_it_measured() -> None:
    graph = street(5, 0)
    world = GraphWorld.from_networkx(graph)
    world.reset(options={"start": 0})
    measured = world.step(1)[0]["displacement"].tolist()
    with pytest.raises(WorldError, match="no place 9"):
        world.reset(options={"start": 9})
    assert world.observe()["displacement"].tolist() == measured != [0.0, 0.0]


def test_doors_between_places_of_any_names_can_be_closed() -> None:
    graph = nx.path_graph(3)
    nx.set_node_attributes(graph, 0, "sight")
    world = GraphWorld.from_networkx(nx.relabel_nodes(graph, {0: "a", 1: (1, 2), 2: 3}))
    world.reset(options={"start": (1, 2)})
    for end in ("a", 3):
        world.close_door((1, 2), end)
        world.close_door(end, (1, 2))
    assert len(world.closed_doors) == 2
    assert set(world.observe()["ways"].values()) == {False}


def test_layouts_are_equal_by_what_is_in_them_and_can_be_sent() -> None:
    layout = GraphWorld.from_networkx(street(6, 1)).layout
    other = pickle.loads(pickle.dumps(layout))
    assert (other, hash(other)) == (layout, hash(layout))
    assert layout != GraphWorld.from_networkx(street(6, 2)).layout
    assert isinstance(layout, Chart)
    assert layout.positions is not None
    assert dict(layout.positions)[3] == pytest.approx(tuple(street(6, 1).nodes[3]["position"]))


def test_a_topological_map_of_ros_is_a_world(tmp_path: Path) -> None:
    def entry(name: str, x: float, y: float, edges: list[str]) -> str:
        lines = "".join(f"\n    - {{action: move, edge_id: {name}_{end}, node: {end}}}" for end in edges)
        return (
            f"- meta: {{map: m, node: {name}, pointset: p}}\n  node:\n    name: {name}\n    edges:{lines}\n"
            f"    pose:\n      orientation: {{w: 1.0, x: 0.0, y: 0.0, z: 0.0}}\n"
            f"      position: {{x: {x}, y: {y}, z: 0.0}}\n"
        )

    nodes = entry("A", 0, 0, ["B", "C"]) + entry("B", 0, 5, ["A"]) + entry("C", 2, 0, ["B"])
    new = written(tmp_path, f"meta: {{last_updated: today}}\nmetric_map: m\nname: yard\nnodes:\n{nodes}", "yard.tmap2")
    old = written(tmp_path, nodes, "yard.yaml")
    with pytest.raises(WorldError, match="no sights"):
        load_world(new)
    layouts = [read_graph(path, sights="distinct") for path in (new, old)]
    assert layouts[0] == layouts[1]
    layout = layouts[0]
    assert (layout.name, layout.places) == ("yard", ("A", "B", "C"))
    assert layout.exits("A") == {"stay": "A", 0: "B", 90: "C"}
    assert layout.exits("C") == {"stay": "C", 338: "B"}
    assert layout.length("A", 0) == 5.0


@pytest.mark.parametrize("seed", range(3))
def test_graph_worlds_pass_gymnasiums_check(tmp_path: Path, seed: int) -> None:
    words = written(tmp_path, square())
    mixed = written(tmp_path, square(nodes=[{"id": i, "sight": [1.5, "a"]} for i in range(4)]), "mixed.json")
    for world in (GraphWorld.from_networkx(street(7, seed)), load_world(words), load_world(mixed)):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            check_env(world, skip_render_check=True)


def test_any_file_has_a_gymnasium_id(tmp_path: Path) -> None:
    world = gym.make("cogmap/World-v0", name_or_path=str(written(tmp_path, square())))
    assert world.reset(options={"start": 3})[1] == {"place": 3}
    assert isinstance(gym.make("cogmap/World-v0", name_or_path="3x3").unwrapped, MazeEnv)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        ({"nodes": []}, "has no nodes"),
        ({"nodes": [{"sight": 1}]}, "node 0 has no 'id'"),
        ({"nodes": [{"id": None, "sight": 1}]}, "node 0 has no 'id'"),
        ({"nodes": [{"id": {}, "sight": 1}]}, "id of node 0 is {}"),
        ({"nodes": [{"id": 0, "sight": 1}, {"id": 0, "sight": 1}]}, "two nodes have the id 0"),
        (
            {"nodes": [{"id": 0, "sight": [[[[[1]]]]]}], "edges": []},
            "sight of a node is .*use a word, a finite",
        ),
        ({"nodes": [{"id": 0, "sight": [1] * 50}], "edges": []}, "sight of a node is .* short list"),
        ({"nodes": [1]}, "node 0 is 1"),
        ({"nodes": {}}, "is no graph: give"),
        ({"edges": 3}, "no list 'edges'"),
        ({"edges": [{"source": 0}]}, "edge 0 has no 'target'"),
        ({"edges": [{"source": 0, "target": 9}]}, "the edge from 0 to 9 leads nowhere; there is no node 9"),
        (
            {"edges": [{"source": 0, "target": i, "way": "up"} for i in (1, 2)]},
            "two ways at 0 are called 'up'; give each",
        ),
        ({"edges": [{"source": 0, "target": 1, "way": "up"}, {"source": 1, "target": 0}]}, "1 of 2 edges name no way"),
        ({"edges": [{"source": 0, "target": 1, "way": {}}]}, "way of an edge is {}"),
        ({"edges": [{"source": 0, "target": 1, "way": "stay"}]}, "a way 'stay' leads to another place"),
        ({"edges": [{"source": i, "target": i + 1} for i in range(3)]}, "not strongly connected: 3 of 4 places"),
        ({"graph": {"motions": {"up": 1}}}, "motion 'up' is 1; give a displacement"),
        ({"graph": {"motions": {"up": [0.5]}}}, "motion 'up' is .*; use whole numbers"),
        ({"graph": {"motions": {"up": [1], "down": [1, 0]}}}, "motions differ in length"),
        ({"graph": {"motions": [1]}}, "graph.motions is "),
        ({"graph": {"motions": {"up": [1]}}}, "way 'east' is none of the motions"),
        ({"graph": 3}, "'graph' is 3"),
        ({"graph": {"sensors": 3}}, "sensors are 3"),
        ({"graph": {"sensors": ["open"]}}, "'open' cannot be a sensor"),
        ({"graph": {"sensors": ["smell"]}}, "4 of 4 nodes have no 'smell'"),
    ],
)
def test_what_is_no_world_is_refused_in_one_line(tmp_path: Path, spoil: dict[str, Any], message: str) -> None:
    with pytest.raises(WorldError, match=message) as caught:
        load_world(written(tmp_path, square(**spoil)))
    assert "\n" not in str(caught.value)
    assert "world.json" in str(caught.value)


@pytest.mark.parametrize(
    ("nodes", "edge", "message"),
    [
        ({}, {"length": 0}, "is 0 long; lengths are above 0"),
        ({}, {"length": -1.5}, "is -1.5 long"),
        ({}, {"length": "far"}, "length of a way is 'far'"),
        ({}, {"bearing": float("nan")}, "bearing of a way is nan"),
        ({}, {"length": True}, "length of a way is True"),
        ({"position": [0, 0, 0, 0]}, {}, r"position of 0 is \[0, 0, 0, 0\]; use two or three"),
        ({"position": [0, "x"]}, {}, "position of 0 is 'x'"),
        ({"position": "here"}, {}, "position of 0 is 'here'"),
        ({"position": [0, 0, 0]}, {}, "some positions have two numbers, others three"),
        ({"position": None}, {}, r"1 of 4 nodes have no position \(0\); give all of them one, or pose='none'"),
        ({"sight": float("inf")}, {}, "sight of a node is inf"),
        ({"sight": {"a": 1}}, {}, "sight of a node is {'a': 1}"),
    ],
)
def test_bad_numbers_are_refused_in_one_line(tmp_path: Path, nodes: dict, edge: dict, message: str) -> None:
    data = square()
    for i, node in enumerate(data["nodes"]):
        node["position"] = [i % 2, i // 2]
    data["nodes"][0].update(nodes)
    data["edges"][0].update(edge)
    with pytest.raises(WorldError, match=message):
        load_world(written(tmp_path, data))


def test_positions_of_some_places_only_can_be_left_out(tmp_path: Path) -> None:
    data = square()
    data["nodes"][0]["position"] = [1, 2]
    layout = read_graph(written(tmp_path, data), pose="none")
    assert layout.positions is None
    assert layout.lengths is None


def test_lengths_of_some_ways_only_are_refused(tmp_path: Path) -> None:
    data = square()
    data["edges"][0]["length"] = 3
    with pytest.raises(WorldError, match="3 of 4 ways have no length"):
        load_world(written(tmp_path, data))


def test_what_is_not_strongly_connected_can_be_asked_for(tmp_path: Path) -> None:
    path = written(tmp_path, square(edges=[{"source": i, "target": i + 1} for i in range(3)]))
    assert read_graph(path, strong=False).exits(3) == {"stay": 3}


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.json", "{", "a.json is no JSON"),
        ("a.json", "[1, 2]", "a.json is no graph"),
        ("a.json", "[" * 100_000, "nested too deeply|is no JSON"),
        ("a.graphml", "<a", "a.graphml is no GraphML"),
        ("a.graphml", "<gexf/>", "a.graphml is no GraphML|has no nodes"),
        ("a.yaml", "a: [", "a.yaml is no YAML"),
        ("a.yaml", "a: 1", "is no topological map"),
        ("a.yaml", "- node: {edges: []}", "node 0 has no 'name'"),
        ("a.yaml", "- 3", "node 0 is 3"),
        ("a.yaml", "nodes: [{name: A, edges: [{edge_id: x}]}]", "an edge has no 'node'"),
        ("a.yaml", "nodes: [{name: A, pose: 3}]", "pose is 3"),
    ],
)
def test_files_of_other_formats_are_refused_in_one_line(tmp_path: Path, name: str, text: str, message: str) -> None:
    with pytest.raises(WorldError, match=message) as caught:
        load_world(written(tmp_path, text, name))
    assert "\n" not in str(caught.value)


def test_a_map_that_swells_when_it_is_read_is_refused_at_once(tmp_path: Path) -> None:
    rows = "".join(
        f"{a}: &{a} [{', '.join([f'*{b}'] * 9)}]\n" for b, a in zip("abcdefghijkl", "bcdefghijklm", strict=True)
    )
    with pytest.raises(WorldError, match="id of node 0"):
        load_world(written(tmp_path, f"a: &a [x, x]\n{rows}nodes: [{{name: *m}}]\n", "bomb.yaml"))


def test_a_name_that_cannot_be_printed_is_not_taken(tmp_path: Path) -> None:
    assert read_graph(written(tmp_path, square(graph={"name": "\x1b[31mred"}))).name == "world"


def test_files_that_are_too_large_or_not_graphs_by_name_are_not_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(WorldError, match="no graph file by its name"):
        read_graph(written(tmp_path, "a b", "a.txt"))
    monkeypatch.setattr("cogmap.worlds.graph.files.LARGEST", 10)
    with pytest.raises(WorldError, match="such a file has 10 at most"):
        load_world(written(tmp_path, square()))
    (tmp_path / "d.json").mkdir()
    with pytest.raises(WorldError, match="is a directory"):
        load_world(tmp_path / "d.json")


@pytest.mark.parametrize(
    ("name", "places", "local"),
    [
        ("cases/torus_3x3.json", 9, False),
        ("cases/torus_4x4_alias.json", 16, False),
        ("cases/portal_4x4.json", 16, False),
        ("cases/one_way_ring.json", 6, False),
        ("cases/4x4_alias_no_positions.json", 16, False),
        ("worlds/house_31.json", 31, True),
        ("worlds/farm.json", 190, True),
        ("worlds/streets_300.json", 300, True),
        ("worlds/mouse_labyrinth.json", 128, True),
        ("worlds/streets_5000.json", 5000, True),
    ],
)
def test_shared_graphs_are_worlds(name: str, places: int, local: bool) -> None:
    world = load_world(shared(name), sights="ways")
    assert (len(world.chart.places), world.motions.local) == (places, local)
    observation, info = world.reset(seed=0)
    for _ in range(50):
        assert observation in world.observation_space
        ahead = world.chart.successors(place_of(info))
        action = int(world.np_random.integers(len(ahead)))
        observation, _, _, _, info = world.step(action)
        assert place_of(info) == list(ahead.values())[action]
