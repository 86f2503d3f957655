"""Graphs on the command line, and the study of real maps, small."""

from __future__ import annotations

import json
from pathlib import Path

import networkx as nx
import pytest
from cogmap.experiments.studies import Buildings, run_study
from cogmap.model import CogmapError
from command_line import cogmap


@pytest.fixture
def house(tmp_path: Path) -> Path:
    """A file of a small building: a corridor with rooms on both sides."""
    graph = nx.Graph(name="small")
    for i in range(4):
        graph.add_node(i, position=(3.0 * i, 0.0))
        graph.add_node(4 + i, position=(3.0 * i, 2.0 + 0.1 * i))
        graph.add_edge(i, 4 + i)
        if i:
            graph.add_edge(i - 1, i)
    path = tmp_path / "small.json"
    path.write_text(json.dumps(nx.node_link_data(graph, edges="edges")))
    return path


def test_a_graph_is_shown(house: Path, tmp_path: Path) -> None:
    facts, picture = tmp_path / "facts.json", tmp_path / "small.png"
    done = cogmap("show", str(house), "--json", str(facts), "--out", str(picture))
    assert done.exit_code == 0
    assert "8 places" in done.stdout
    assert picture.read_bytes().startswith(b"\x89PNG")
    found = json.loads(facts.read_text())
    assert (found["places"], found["ways"], found["one_way"], found["most_ways"]) == (8, 14, 0, 3)
    assert found["oracle_steps"] == found["tour_steps"] == 10


@pytest.mark.parametrize("text", ["{}", "[1]", '{"nodes": [{}], "edges": []}', "no json"])
def test_what_is_no_graph_is_refused_in_a_line(text: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    path.write_text(text)
    done = cogmap("show", str(path))
    assert done.exit_code == 2
    assert len(done.stderr.strip().splitlines()) == 1


def test_rows_of_a_graph_have_metres_and_what_they_are_measured_by(house: Path) -> None:
    done = cogmap("explore", str(house), "--sights", "2", "--runs", "1", "--json", str(house.parent / "e.json"))
    assert done.exit_code == 0
    (row,) = json.loads((house.parent / "e.json").read_text())["runs"]
    assert row["map_right"]
    assert row["tour_steps"] <= row["steps_to_visit_all"]
    assert row["metres"] >= 2.0 * row["steps_to_visit_all"]
    assert row["frontier_mean"] >= row["tour_steps"]


def test_nearest_frontier_lives_in_graphs(house: Path, tmp_path: Path) -> None:
    done = cogmap(
        "explore", str(house), "--sights", "2", "--agent", "frontier", "--runs", "2", "--json", tmp_path / "f.json"
    )
    assert done.exit_code == 0
    for row in json.loads((tmp_path / "f.json").read_text())["runs"]:
        assert row["steps_to_complete"] == row["steps_to_visit_all"] >= row["tour_steps"]


def test_the_study_of_buildings_takes_a_folder(house: Path, tmp_path: Path) -> None:
    study = Buildings(str(house.parent))
    outcome = run_study(study, tmp_path / "out", runs=1)
    summary = json.loads((tmp_path / "out" / "buildings.json").read_text())["summary"]
    assert [row["sights"] for row in summary] == ["distinct", "ways", "six", "six, drift 5 %"]
    assert all(row["map right"] == row["runs"] for row in summary[:3])
    assert f"--maps {house.parent}" in (tmp_path / "out" / "buildings.md").read_text()
    assert outcome.written


def test_a_folder_without_maps_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CogmapError, match="no graph files"):
        Buildings(str(tmp_path)).rows(1)
    done = cogmap("study", "donut", "--maps", str(tmp_path))
    assert done.exit_code == 2
    assert "buildings" in done.stderr
