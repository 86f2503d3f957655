"""The growth log as a table and as differences."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from cogmap.agent import Agent, Settings
from cogmap.model import CogmapError, CognitiveMap, GrowthEvent, Motions, growth_between, growth_table
from cogmap.worlds import load_world
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import DOWN, GRID, walk, walked


def by_hand() -> CognitiveMap:
    map_ = CognitiveMap(Motions.of(GRID))
    map_.new_place((0, 0), step=0)  # place 0
    map_.sensors["sight"].read("hall", step=0)
    map_.new_place((1, 0), step=1, source=0, action=DOWN)  # place 1
    map_.new_place((2, 0), step=1, source=1, action=DOWN)  # place 2
    map_.grow_time(step=2)
    map_.clear(step=3)
    map_.new_place((0, 0), step=3)  # the same again
    map_.new_place((1, 0), step=3, source=0, action=DOWN)
    map_.new_place((1, 1), step=4, source=1, action=3)  # and place 2, another one
    return map_


def test_the_table_has_action_names() -> None:
    table = growth_table(by_hand(), since=1, until=2)
    assert table.columns == ("step", "kind", "index", "label", "source", "action")
    assert [tuple(row) for row in table.cells] == [
        (1, "place", 1, (1, 0), 0, "down"),
        (1, "position", 1, (1, 0), None, None),
        (1, "place", 2, (2, 0), 1, "down"),
        (1, "position", 2, (2, 0), None, None),
        (2, "time", 2, None, None, None),
    ]
    assert "action 1" in str(growth_table(by_hand().growth))
    pytest.importorskip("pandas")
    frame: Any = table.to_pandas()
    assert frame["step"].tolist() == [1, 1, 1, 1, 2]
    assert frame["source"].tolist() == [0, None, 1, None, None]


def test_places_that_were_taken_away_are_told() -> None:
    map_ = by_hand()
    late = growth_between(map_, 3)
    assert (late.since, late.until) == (3, 4)
    assert [(old.place, old.position) for old in late.taken] == [(0, (0, 0)), (1, (1, 0)), (2, (2, 0))]
    assert [(new.place, new.position, new.source, new.action) for new in late.places] == [
        (0, (0, 0), None, None),
        (1, (1, 0), 0, "down"),
        (2, (1, 1), 1, "right"),
    ]
    assert "- places (3): 0 at (0, 0), 1 at (1, 0) (down of 0), 2 at (2, 0) (down of 1)" in str(late)
    whole = growth_between(map_)
    assert [new.place for new in whole.places] == [0, 1, 2]
    assert whole.taken == ()
    assert whole.sights == ("hall",)
    assert whole.variables == ("s2", "p2", "moved2", "o2", "c2")
    assert growth_between(map_, 2, 2).places == ()
    assert "nothing was added" in str(growth_between(map_.growth, 9, 12))
    with pytest.raises(CogmapError, match="no step from 5 to 4"):
        growth_between(map_, 5)
    assert [new.action for new in growth_between(map_.growth, 4).places] == ["action 3"]


def test_positions_given_and_lost_without_a_new_place() -> None:
    map_ = CognitiveMap(Motions.of(GRID))
    map_.new_place(None, step=0)
    map_.new_place(None, step=0)
    map_.bind(0, (0, 0), step=1)
    map_.bind(1, (1, 0), step=2)
    log = [*map_.growth, GrowthEvent(3, "unbind", 1, (1, 0))]  # as files of earlier versions have it
    assert growth_between(log, 1, 2).bound == ((0, (0, 0)), (1, (1, 0)))
    assert growth_between(log, 1).bound == ((0, (0, 0)),)
    assert growth_between(log, 3).unbound == ((1, (1, 0)),)
    assert "- positions of places (1): 1 at (1, 0)" in str(growth_between(log, 3))


def test_the_graph_has_the_added_nodes_and_where_they_hang() -> None:
    graph = growth_between(by_hand(), 4).to_networkx()
    assert graph.nodes["place", 2] | {"step": 4} == {
        "kind": "place",
        "label": 2,
        "added": True,
        "step": 4,
        "position": (1, 1),
    }
    assert not graph.nodes["place", 1]["added"]
    assert graph.edges[("place", 1), ("place", 2)] == {"relation": "leads to", "action": "right"}
    assert graph.edges[("place", 2), ("position", (1, 1))]["relation"] == "is at"
    whole = growth_between(by_hand()).to_networkx()
    assert all(added for _, added in whole.nodes(data="added"))
    assert ("sight", "hall") in whole
    assert ("variable", "moved2") in whole


@settings(max_examples=6, deadline=None)
@given(st.integers(0, 50), st.sampled_from(["predicted", "observed"]), st.integers(0, 20))
def test_differences_add_up_to_the_map(seed: int, growth: str, cut: int) -> None:
    """Replayed from nothing the log gives the map, with silent moves and what was taken back because of them."""
    map_ = walked(load_world("3x3_alias"), 20, seed=seed, displace_every=6, growth=growth).map
    whole = growth_between(map_)
    assert [new.place for new in whole.places] == list(map_.places)
    assert [new.position for new in whole.places] == [map_.position(place) for place in map_.places]
    assert whole.sights == tuple(map_.sights)
    assert whole.positions == tuple(map_.positions)
    if cut:
        early, late = growth_between(map_, 0, cut - 1), growth_between(map_, cut, 20)
        assert len(early.places) + len(late.places) - len(late.taken) == len(map_.places)
        assert early.variables + late.variables == whole.variables


def test_variables_are_those_of_the_window() -> None:
    world = load_world("3x3")
    agent = Agent(world.motions, settings=Settings(look_ahead=2, window=30), seed=1)
    for _ in walk(world, agent, 6):
        pass
    assert set(growth_between(agent.map).variables) == {variable.name for variable in agent.graph.variables}


def test_steps_of_growth_between_are_both_included() -> None:
    map_ = walked(load_world("4x4"), 8).map
    singles = [growth_between(map_, step, step) for step in range(8)]
    assert sum((single.places for single in singles), ()) == growth_between(map_).places
    assert all(a.until < b.since for a, b in pairwise(singles))
