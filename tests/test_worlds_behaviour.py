from __future__ import annotations

from typing import Any

import networkx as nx
import numpy as np
import pytest
from cogmap.worlds import MAZES, Chart, GraphWorld, behaviour, distinguishable, parse_maze, read_graph
from hypothesis import given, settings
from hypothesis import strategies as st
from shared import shared


def told_apart(chart: Chart, a: Any, b: Any, *, doors: bool) -> bool:
    """Brute force: whether some sequence of actions shows something else from `a` than from `b`."""
    pairs, seen = [(a, b)], {(a, b)}
    for one, other in pairs:  # grows while it is read
        ahead, beyond = chart.exits(one), chart.exits(other)
        if chart.sights[one] != chart.sights[other] or list(ahead) != list(beyond):
            return True
        if doors and [x is None for x in ahead.values()] != [x is None for x in beyond.values()]:
            return True
        new = zip(chart.successors(one).values(), chart.successors(other).values(), strict=True)
        pairs += [pair for pair in dict.fromkeys(new) if pair not in seen]
        seen.update(pairs)
    return False


def machine(size: int, seed: int) -> Chart:
    rng = np.random.default_rng(seed)
    graph = nx.MultiDiGraph()
    graph.add_nodes_from((node, {"sight": int(rng.integers(2))}) for node in range(size))
    for node in range(size):
        graph.add_edge(node, (node + 1) % size, way="on")
        if rng.random() < 0.7:
            graph.add_edge(node, int(rng.integers(size)), way="over")
    return GraphWorld.from_networkx(graph).layout


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 9), st.integers(0, 999), st.booleans())
def test_places_behave_alike_where_no_sequence_of_actions_tells_them_apart(size: int, seed: int, doors: bool) -> None:
    chart = machine(size, seed)
    classes = behaviour(chart, doors=doors)
    for a in chart.places:
        for b in chart.places:
            assert (classes[a] != classes[b]) == told_apart(chart, a, b, doors=doors)


def test_all_places_of_the_mazes_can_be_told_apart() -> None:
    assert all(distinguishable(maze) and distinguishable(maze, doors=False) for maze in MAZES.values())


def test_a_corridor_of_one_sight_is_told_by_its_ends() -> None:
    corridor = parse_maze("a a a a a", name="corridor")
    assert distinguishable(corridor)
    assert not distinguishable(parse_maze("a a\na a", name="square"), doors=False)


@pytest.mark.parametrize(("name", "alike"), [("torus_3x3", 9), ("torus_4x4_alias", 16), ("one_way_ring", 6)])
def test_shared_worlds_have_as_many_places_as_can_be_told_apart(name: str, alike: int) -> None:
    assert len(set(behaviour(read_graph(shared(f"cases/{name}.json"))).values())) == alike
