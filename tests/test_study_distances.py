"""The study `distances`: one goal, rooms at every distance, beside CSCG."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import pytest
from cogmap.experiments import shortest
from cogmap.experiments.studies import distances, run_study, study_named
from cogmap.worlds import MAZES

STUDY: Any = study_named("distances")


@cache
def row(model: str, world: str = "3x3") -> Any:
    return STUDY.run((world, model, 0), STUDY.settings)


def test_rooms_are_told_by_their_distance_to_the_nearest_goal() -> None:
    maze = MAZES["3x3_alias"]
    found = distances.by_distance(maze)
    rooms = [room for goals in found.values() for room in goals.get(0, ())]
    assert sorted(rooms) == [room for room in sorted(maze.rooms) if maze.sights[room] != 0]
    for distance, goals in found.items():
        assert all(shortest(maze, room, goal) == distance for goal, rooms in goals.items() for room in rooms)


@pytest.mark.parametrize("model", distances.MODELS)
def test_each_model_sets_out_once_from_every_distance(model: str) -> None:
    done = row(model)
    there = distances.by_distance(MAZES["3x3"])
    assert [way.shortest for way in done.ways] == list(there) == [1, 2, 3, 4]
    assert all(way.goal in there[way.shortest] for way in done.ways)
    assert all(way.steps is None or way.steps >= way.shortest for way in done.ways)
    assert done.learned is (model != "cogmap_unknown")
    if model == "cogmap":
        assert [way.steps for way in done.ways] == [way.shortest for way in done.ways]
        assert done == STUDY.run(("3x3", model, 0), STUDY.settings)


def test_every_maze_of_the_paper_meets_every_model() -> None:
    tasks = STUDY.tasks(range(2), STUDY.settings)
    assert len(tasks) == 7 * 4 * 2
    assert {world for world, _, _ in tasks} == set(MAZES) - {"tolman"}


def test_ways_given_up_count_as_the_bound_and_are_named() -> None:
    way = distances.WayTo
    rows = [
        distances.DistanceRow("3x3_alias", True, "cscg", 0, True, (way(2, None, 4), way(3, 5, 0))),
        distances.DistanceRow("3x3_alias", True, "cscg", 1, True, (way(2, 4, 4),)),
        distances.DistanceRow("3x3", False, "cscg_pose", 1, False, ()),
    ]
    assert distances.summarised(rows)[True, 2]["cscg"].value == (distances.MOST + 4) / 2
    found = STUDY.summarise(rows)
    assert list(found.failed) == [
        "3x3_alias, CSCG with its map, seed 0: not reached: goal 4 from distance 2",
        "3x3, CSCG with positions and its map, seed 1: not learned after 600 moves",
    ]
    assert found.tables[0].rows[0][:2] == ["sights repeat", 2]


def test_what_is_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(distances, "PAPERS", ("3x3",))
    monkeypatch.setattr(distances, "MODELS", {name: distances.MODELS[name] for name in ("cogmap", "cogmap_unknown")})
    outcome = run_study(STUDY, tmp_path, runs=1)
    assert not outcome.failed
    assert {path.name for path in tmp_path.iterdir()} >= {"distances.png", "distances.md", "distances.csv"}
