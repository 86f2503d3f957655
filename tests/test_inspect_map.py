"""The map as a graph for other tools."""

from __future__ import annotations

import json

import networkx as nx
import numpy as np
import pytest
from cogmap.model import BLOCKED, OPEN, CogmapError, CognitiveMap, Motions
from cogmap.worlds import load_world
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import GRID, UP, walked


@settings(max_examples=12, deadline=None)
@given(st.sampled_from(["3x3", "3x3_alias", "t_maze"]), st.integers(0, 12), st.sampled_from([0, 4]))
def test_the_graph_is_the_tables(name: str, steps: int, displace_every: int) -> None:
    map_ = walked(load_world(name), steps, seed=steps, displace_every=displace_every).map
    graph, B = map_.to_networkx(), map_.B()
    rows = enumerate(map_.B_s.keys(np.arange(len(map_.B_s))))
    ahead = {divmod(row, len(map_.motions)): {*keys.tolist()} - {-1, -2} for row, keys in rows}
    shut = {way for way in ahead if map_.sensed[way] == BLOCKED}
    assert graph.number_of_edges() == sum(len(to & {way[0]} if way in shut else to) for way, to in ahead.items())
    for place, next_, key, facts in graph.edges(keys=True, data=True):
        action = map_.motions.names.index(key)
        assert facts["action"] == key
        assert facts["probability"] == pytest.approx(B[next_, place, action], abs=1e-12)
        assert facts["count"] == map_.B_s.evidence(map_.row(place, action), next_)
        sensed, walked_ = map_.sensed[place, action], map_.walked[place, action]
        if action != map_.motions.stay:
            expected = "refuted" if sensed == BLOCKED else "walked" if walked_ else "imagined"
            assert facts["known"] == (expected if sensed in (OPEN, BLOCKED) or walked_ else "unknown")
    for place, facts in graph.nodes(data=True):
        assert (facts["position"], facts["visited"]) == (map_.position(place), bool(map_.visited[place]))
        assert list(facts["sights"].values()) == sorted(facts["sights"].values(), reverse=True)
        for label, probability in facts["sights"].items():
            assert probability == pytest.approx(map_.A()[map_.sights.index(label), place], abs=1e-12)


def test_json_is_a_node_link_graph_that_networkx_reads() -> None:
    map_ = walked(load_world("3x3_alias"), 6).map
    values = json.loads(map_.to_json())
    twin = nx.node_link_graph(values, edges="edges")
    graph = map_.to_networkx()
    assert list(twin.nodes) == list(graph.nodes)
    assert list(twin.edges(keys=True, data=True)) == list(graph.edges(keys=True, data=True))
    for place, facts in graph.nodes(data=True):
        assert tuple(twin.nodes[place]["position"]) == facts["position"]
        assert {pair["sight"]: pair["probability"] for pair in twin.nodes[place]["sights"]} == facts["sights"]
    assert twin.graph["motions"]["up"] == [-1, 0]


def test_places_without_a_position_and_labels_that_json_cannot_hold() -> None:
    map_ = CognitiveMap(Motions.of(GRID))
    map_.new_place(None, step=0)
    assert json.loads(map_.to_json())["nodes"][0]["position"] is None
    assert "pos=" not in map_.to_dot()
    map_.sensors["sight"].read(frozenset(), step=0)
    map_.A_o.add(0, 0, 1.0)
    with pytest.raises(CogmapError, match="map: cannot write label frozenset"):
        map_.to_json()


def test_dot_fills_the_visited_and_dashes_the_imagined() -> None:
    map_ = walked(load_world("3x3"), 3).map
    lines = map_.to_dot().splitlines()
    visited = int(map_.visited.sum())
    assert sum("style=filled" in line for line in lines) == visited
    assert sum("style=dashed" in line and "->" not in line for line in lines) == len(map_.places) - visited
    assert not any(f"  {place} -> {place} " in line for place in map_.places for line in lines)


def test_a_thousand_rooms_are_a_graph() -> None:
    map_ = CognitiveMap(Motions.of(GRID))
    for k in range(1000):
        place = map_.new_place(divmod(k, 25), step=k)
        map_.A_o.add(place, map_.sensors["sight"].read(k % 7, step=k), 1.0)
        map_.B_s.add(map_.row(place, UP), place, 7.0)
        map_.mark_visited(place)
    graph = map_.to_networkx()
    assert graph.number_of_nodes() == 1000
    assert graph.number_of_edges() == sum(len({*row} - {-1, -2}) for row in map_.B_s.keys(np.arange(len(map_.B_s))))
