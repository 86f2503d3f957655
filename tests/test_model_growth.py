"""Growth strategies, and the log from which a map's structure can be replayed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import pytest
from cogmap.agent import Agent, Settings
from cogmap.model import (
    GROWTHS,
    CogmapError,
    CognitiveMap,
    Growth,
    GrowthEvent,
    Motions,
    Position,
    StaticGrowth,
    Whereabouts,
)
from cogmap.worlds import load_world
from parts import agent_with
from walks import DOWN, GRID, LEFT, RIGHT, STAY, UP, walk

OPEN_ALL = (True, True, True, True, True)
TWO_OPEN = (False, True, False, True, True)


def made(name: str, places: int | None = None) -> Growth:
    return GROWTHS[name](*([] if places is None else [places]))


class Fresh:
    """A map that grows by one rule, from where the agent is sure to be."""

    def __init__(self, name: str, places: int | None = None) -> None:
        self.map, self._rule = CognitiveMap(Motions.of(GRID)), made(name, places)
        self.new = self._rule.begin(self.map, step=0)

    def look(self, place: int, open_: Sequence[bool], *, step: int) -> list[int]:
        return self._rule.look(self.map, Whereabouts({place: 1.0}), open_, step=step)

    def enter(self, place: int, action: int, *, step: int) -> list[int]:
        return self._rule.enter(self.map, Whereabouts({place: 1.0}), action, step=step)


def replayed(map_: CognitiveMap) -> CognitiveMap:
    """A new map, grown by nothing but those events of another that were not taken back."""
    lasting: list[GrowthEvent] = []
    for event in map_.growth:
        if event.kind == "unbind":
            bound = [old for old in lasting if old.kind == "bind" and old.index == event.index]
            lasting = [old for old in lasting if not bound or old is not bound[-1]]
        elif event.kind == "retract":
            gone = [old for old in lasting if old.kind == "place"]
            left = len(gone) - event.index
            lasting = [
                old
                for old in lasting
                if old.kind not in ("place", "bind") or (old not in gone[left:] and old.index < left)
            ]
        else:
            lasting.append(event)
    copy = CognitiveMap(map_.motions)
    for event in lasting:
        position = cast("Position | None", event.label)
        if event.kind == "sight":
            assert copy.sensors["sight"].read(event.label, step=event.step) == event.index
        elif event.kind == "position":
            assert copy.pose.new_position(cast(Position, event.label), step=event.step) == event.index
        elif event.kind == "place":
            assert copy.new_place(position, step=event.step, source=event.source, action=event.action) == event.index
        elif event.kind == "bind":
            copy.bind(event.index, cast(Position, event.label), step=event.step)
    return copy


@pytest.mark.parametrize("growth", GROWTHS)
def test_the_log_replays_to_the_same_structure(growth: str) -> None:
    world = load_world("4x4_alias")
    agent = agent_with(world.motions, growth=growth, places=60, look_ahead=2, seed=1)
    for _ in walk(world, agent, 40, seed=1, displace_every=6, steer=True):
        pass
    map_ = agent.map
    assert len(map_.visited_places) > 4
    copy = replayed(map_)
    assert list(copy.sights) == list(map_.sights)
    assert list(copy.positions) == list(map_.positions)
    assert len(copy.places) == len(map_.places)
    assert [copy.position(place) for place in copy.places] == [map_.position(place) for place in map_.places]
    assert copy.A_o.outcomes == map_.A_o.outcomes
    assert len(copy.A_o) == len(map_.A_o)


def test_the_log_is_only_appended_to() -> None:
    world = load_world("3x3_alias")
    agent = Agent(world.motions, settings=Settings(look_ahead=2), seed=3)
    kept: list[GrowthEvent] = list(agent.map.growth)
    assert [event.kind for event in kept] == ["place", "position"]
    for step, _ in enumerate(walk(world, agent, 20, displace_every=5)):
        log = agent.map.growth
        assert log[: len(kept)] == kept
        assert {event.step for event in log[len(kept) :]} == {step}
        assert [event.index for event in log[len(kept) :] if event.kind == "time"] == [step]
        assert agent.trace[-1].grown == tuple(log[len(kept) :])
        kept = list(log)
    for kind, size in (("time", 20), ("sight", len(agent.map.sights))):
        assert [event.index for event in kept if event.kind == kind] == list(range(size))
    taken = sum(event.index for event in kept if event.kind == "retract")
    assert sum(event.kind == "place" for event in kept) - taken == len(agent.map.places)
    with pytest.raises(AttributeError):
        kept[0].index = 5  # type: ignore[misc]


def test_predicted_growth_imagines_what_lies_behind_open_doors() -> None:
    growth = Fresh("predicted")
    map_ = growth.map
    assert growth.new == [0]
    assert map_.position(0) == (0, 0)
    assert growth.look(0, TWO_OPEN, step=1) == [1, 2]
    assert [map_.position(place) for place in (1, 2)] == [(1, 0), (0, 1)]
    assert [(e.source, e.action) for e in map_.growth if e.kind == "place" and e.step == 1] == [(0, DOWN), (0, RIGHT)]
    assert growth.look(0, TWO_OPEN, step=2) == []
    assert growth.enter(0, RIGHT, step=2) == []
    assert growth.look(2, OPEN_ALL, step=3) == [3, 4, 5]  # not back to place 0
    assert map_.beyond(2, LEFT) == 0
    # a place found from two sides is one place, with both its neighbours
    assert growth.look(1, (False, False, False, True, True), step=4) == []
    assert map_.beyond(1, RIGHT) == map_.place_at((1, 1)) == map_.beyond(2, DOWN)


def test_observed_growth_waits_until_a_door_is_taken() -> None:
    growth = Fresh("observed")
    map_ = growth.map
    assert growth.new == [0]
    assert growth.look(0, OPEN_ALL, step=1) == []
    assert growth.enter(0, UP, step=2) == [1]
    assert map_.position(1) == (-1, 0)
    assert (map_.growth[-2].source, map_.growth[-2].action) == (0, UP)
    assert growth.enter(0, UP, step=3) == []
    assert growth.enter(1, DOWN, step=3) == []
    assert growth.enter(1, STAY, step=3) == []


def test_static_growth_knows_the_size_and_binds_as_it_goes() -> None:
    growth = Fresh("static", places=3)
    map_ = growth.map
    assert growth.new == [0, 1, 2]
    assert map_.position(0) == (0, 0)
    assert map_.position(1) is None
    assert growth.look(0, OPEN_ALL, step=1) == []
    assert growth.enter(0, RIGHT, step=2) == [1]
    assert growth.enter(0, RIGHT, step=3) == []
    assert growth.enter(2, RIGHT, step=3) == []  # a place without a position leads nowhere
    assert growth.enter(1, STAY, step=3) == []
    assert growth.enter(1, RIGHT, step=4) == [2]
    with pytest.raises(CogmapError, match=r"larger than its 3 places; give static growth more"):
        growth.enter(2, RIGHT, step=5)
    assert len(map_.places) == 3


@pytest.mark.parametrize("places", [None, 0, -1, 2.5, True, "9"])
def test_static_growth_needs_the_size(places: Any) -> None:
    with pytest.raises(CogmapError, match=r"static growth cannot have .* places; give the size of the world"):
        StaticGrowth(places)


@pytest.mark.parametrize("name", ["predicted", "observed"])
def test_no_place_grows_from_one_without_position(name: str) -> None:
    growth = Fresh(name)
    map_ = growth.map
    nowhere = map_.new_place(None, step=0)
    assert growth.look(nowhere, OPEN_ALL, step=1) == []
    assert growth.enter(nowhere, UP, step=1) == []


def test_places_found_from_another_side_are_not_made_twice() -> None:
    for name, places in (("observed", None), ("static", 4)):
        growth = Fresh(name, places)
        map_ = growth.map
        growth.enter(0, RIGHT, step=1)
        growth.enter(1, DOWN, step=2)
        growth.enter(2, LEFT, step=3)
        assert growth.enter(3, UP, step=4) == []
        assert map_.beyond(3, UP) == 0
        assert map_.beyond(0, DOWN) == 3


@pytest.mark.parametrize("growth", GROWTHS)
def test_an_agent_leaves_its_first_room(growth: str) -> None:
    world = load_world("3x3")
    agent = agent_with(world.motions, growth=growth, places=9, look_ahead=3)
    rooms = {world.position for _ in walk(world, agent, 20)}
    assert len(rooms) > 1
