from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import networkx as nx
import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.experiments import Moment, Parts, Trail, exploration, explore_many, judge, walk
from cogmap.model import CogmapError, CognitiveMap, Motions, NoPose
from cogmap.worlds import GRID, MAZES, GraphWorld, MazeEnv, NoisyWorld, geometric, ring, torus

UP, DOWN, LEFT, RIGHT, STAY = range(5)


def true_map(chart: Any, rooms: list[Any], times: int = 1) -> tuple[CognitiveMap, dict[int, Any]]:
    """A map without positions that has these rooms `times` over, and believes the transitions among them."""
    motions = dict(zip(chart.motions.names, chart.motions.displacements, strict=True))
    map_, stands_for = CognitiveMap(Motions.of(motions), pose=NoPose()), dict[int, Any]()
    for room in rooms * times:
        place = map_.new_place(step=0)
        map_.mark_visited(place)
        stands_for[place] = room
    for place, room in stands_for.items():
        for action, ahead in enumerate(chart.successors(room).values()):
            if ahead in rooms:
                map_.transitions.add(rooms.index(ahead), place, action, 9.0)
    return map_, stands_for


@pytest.mark.parametrize(
    "chart", [torus(3, 3).chart, ring(6, one_way=False).chart, MAZES["4x4_alias"]], ids=lambda chart: chart.name
)
def test_a_true_map_is_right_whatever_the_world(chart: Any) -> None:
    rooms = list(chart.places)
    map_, stands_for = true_map(chart, rooms)
    verdict = judge(map_, chart, stands_for, rooms)
    assert (verdict.places, verdict.map_right, verdict.known) == (len(rooms), True, 1.0)


def test_half_a_map_may_be_right_and_knows_half() -> None:
    chart = torus(3, 3).chart
    rooms = list(chart.places[:2])
    map_, stands_for = true_map(chart, rooms)
    verdict = judge(map_, chart, stands_for, rooms)
    assert verdict.map_right
    among = sum(ahead in rooms for room in rooms for ahead in chart.successors(room).values())
    assert verdict.known == pytest.approx(among / (9 * 5))
    assert not judge(map_, chart, stands_for, chart.places[:3]).map_right  # a third room was visited


def test_what_is_imagined_behind_ways_counts_while_they_are_believed_open() -> None:
    chart = MAZES["3x3"]
    map_, stands_for = true_map(chart, [(0, 0)])
    before = judge(map_, chart, stands_for, [(0, 0)])
    assert (before.places, before.map_right) == (1, True)
    map_.transitions.add(map_.new_place(step=1), 0, RIGHT, 9.0)
    after = judge(map_, chart, stands_for, [(0, 0)])
    assert (after.places, after.map_right) == (2, True)
    assert after.known == pytest.approx(before.known + 1 / 45)  # it stands for the room beyond
    map_.transitions.add(0, 0, RIGHT, 90.0)
    assert judge(map_, chart, stands_for, [(0, 0)]).places == 1


def test_one_room_as_two_places_and_two_rooms_as_one_are_wrong() -> None:
    chart = torus(3, 3).chart
    rooms = list(chart.places)
    twice, stands_for = true_map(chart, rooms, times=2)
    assert not judge(twice, chart, stands_for, rooms).map_right
    once, stands_for = true_map(chart, rooms)
    assert not judge(once, chart, {**stands_for, 1: rooms[0]}, rooms).map_right
    assert not judge(once, chart, {**stands_for, 1: None}, rooms).map_right


def test_a_wall_believed_to_be_a_way_is_wrong() -> None:
    chart = MAZES["3x3"]
    rooms = list(chart.places)
    map_, stands_for = true_map(chart, rooms)
    map_.transitions.add(1, 0, UP, 20.0)
    verdict = judge(map_, chart, stands_for, rooms)
    assert not verdict.map_right
    assert verdict.known == pytest.approx(44 / 45)


def looked_at(agent: Any, rooms: list[Any]) -> Trail:
    trail = Trail()
    for step, room in enumerate(rooms):
        trail(Moment(step, agent, MazeEnv(MAZES["3x3"]), {}, {"position": room}, 0))
    return trail


class Told(Agent):
    """Takes itself to be in place 0 always, and says when it was there."""

    steps = 5  # type: ignore[assignment]
    there = (0, 1, 2, 3, 4)

    @property
    def belief(self) -> Any:  # type: ignore[override]
        return SimpleNamespace(place=0, certainty=0.7)

    def steps_in(self, place: int) -> tuple[int, ...]:
        return self.there if place == 0 else ()


def test_a_place_belongs_to_the_room_where_it_was_visited_most() -> None:
    agent = Told(GRID, seed=0)
    trail = looked_at(agent, [(0, 0), (0, 0), (0, 1), (0, 0), (0, 1)])
    assert trail.room(agent, 0) == (0, 0)
    assert trail.room(agent, 1) is None
    agent.there = (2, 4)
    assert trail.room(agent, 0) == (0, 1)


def test_a_new_place_for_a_known_room_is_not_right() -> None:
    there = {0: (0, 1, 3), 1: (2,), 2: (4,)}
    agent: Any = SimpleNamespace(steps=5, steps_in=there.get, belief=SimpleNamespace(place=2))
    assert looked_at(agent, [(0, 0), (0, 0), (0, 1), (0, 0), (0, 2)]).right(agent)  # a room never entered before
    trail = looked_at(agent, [(0, 0), (0, 0), (0, 1), (0, 0), (0, 1)])
    assert not trail.right(agent)
    assert trail.room(agent, 2) == (0, 1)
    agent.belief.place, there[1] = 1, (2, 4)
    assert trail.right(agent)
    agent.belief.place = 0
    assert not trail.right(agent)


def test_it_is_wrong_where_it_is_certain_of_another_room() -> None:
    class Growing(Told):
        @property
        def steps(self) -> int:  # type: ignore[override]
            return len(trail.rooms)

        def steps_in(self, place: int) -> tuple[int, ...]:
            return tuple(range(len(trail.rooms)))

    trail, agent = Trail(), Growing(GRID, seed=0)
    for step, room in enumerate([(0, 0), (0, 0), (0, 1), (0, 0), (0, 1)]):
        trail(Moment(step, agent, MazeEnv(MAZES["3x3"]), {}, {"position": room}, 0))
    assert trail.wrong == 2


def test_rows_of_agents_with_maps_say_what_these_are_worth() -> None:
    runs = explore_many(MAZES["3x3"], runs=2)
    for run in runs:
        assert (run.places, run.map_right, run.known, run.certain_but_wrong) == (9, True, 1.0, 0.0)
        assert run.to_dict()["map_right"] is True
    summary = exploration(MAZES["3x3"], runs)["summary"]
    assert (summary["map_right"], summary["mean_places"]) == (2, 9.0)
    other = explore_many(MAZES["3x3"], runs=1, agent="frontier")
    assert "map_right" not in other[0].to_dict()
    assert "map_right" not in exploration(MAZES["3x3"], other, agent="frontier")["summary"]


def test_walking_on_whatever_is_complete() -> None:
    free, on = walk(MAZES["3x3"], 1), walk(MAZES["3x3"], 1, steps=40)
    assert len(on.path) == 41
    assert on.path[: len(free.path)] == free.path
    assert on.run.steps_to_complete == free.run.steps_to_complete
    with pytest.raises(CogmapError, match="steps is 0"):
        walk(MAZES["3x3"], steps=0)


def test_noise_makes_a_world_harder_and_stands_in_results() -> None:
    noisy = NoisyWorld(MazeEnv(MAZES["3x3"]), slip=0.3, moved=0.1)
    one, again = (walk(noisy, 3, steps=60) for _ in range(2))
    assert one.path == again.path
    assert one.path != walk(MAZES["3x3"], 3, steps=60).path
    result = exploration(noisy, [one.run], steps=60)
    assert result["noise"] == {"slip": 0.3, "moved": 0.1}
    assert result["summary"]["max_steps"] == 60
    assert "noise" not in exploration(MAZES["3x3"], [one.run])


def test_the_pose_is_a_part() -> None:
    world = MazeEnv(MAZES["3x3"])
    assert isinstance(Parts(pose="none").make(world, _seed()).map.pose, NoPose)
    assert Parts(pose="none").to_dict()["pose"] == "none"
    assert "pose" not in Parts().to_dict()
    with pytest.raises(CogmapError, match="pose is 'sphere'"):
        Parts(pose="sphere")


def test_a_lattice_needs_displacements() -> None:
    graph = nx.DiGraph()
    graph.add_nodes_from([0, 1], sight="a")
    graph.add_edges_from([(0, 1), (1, 0)], way="on")
    world = GraphWorld.from_networkx(graph)
    with pytest.raises(CogmapError, match="lattice needs actions with displacements"):
        Parts(pose="lattice").make(world, _seed())


def _seed() -> Any:
    return np.random.SeedSequence(0)


def test_worlds_whose_ways_belong_to_the_place_are_explored() -> None:
    run = walk(geometric(6, degree=3, seed=1), 0, steps=15).run
    assert run.places is not None
    assert 0.0 < (run.known or 0.0) <= 1.0


@pytest.mark.parametrize("world", [torus(3, 3), ring(6)], ids=["torus", "ring"])
def test_places_are_recognised_where_positions_do_not_say_which_is_which(world: Any) -> None:
    run = walk(world, 0, steps=45).run
    assert run.places == len(world.chart.places)
    assert run.certain_but_wrong == 0.0
