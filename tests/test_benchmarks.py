from __future__ import annotations

import contextlib
import importlib
import io
import json
import runpy
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.experiments import Truth
from cogmap.model import FactorGraph, save_graph
from cogmap.worlds import GRID, MazeEnv, labyrinth
from shared import shared

BENCHMARKS = Path(__file__).parent.parent / "benchmarks"


def measured(name: str, tmp_path: Path, *arguments: str) -> tuple[str, dict[str, Any]]:
    """What a benchmark prints and writes, run in this process, which has imported everything already."""
    file, printed = tmp_path / "out.json", io.StringIO()
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(printed):
        patch.setattr(sys, "argv", [name, *arguments, "--json", str(file)])
        patch.syspath_prepend(str((BENCHMARKS / name).parent))
        patch.chdir(tmp_path)
        try:
            runpy.run_path(str(BENCHMARKS / name), run_name="__main__")
        except SystemExit as end:
            if end.code:
                pytest.fail(str(end.code))
    return printed.getvalue(), json.loads(file.read_text())


def measured_apart(name: str, tmp_path: Path, *arguments: str) -> tuple[str, dict[str, Any]]:
    """The same in a process of its own, which may be given limits."""
    file = tmp_path / "out.json"
    command = [sys.executable, str(BENCHMARKS / name), *arguments, "--json", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    return done.stdout, json.loads(file.read_text())


def test_an_agent_led_along_a_recorded_animal_is_where_it_is_led(tmp_path: Path) -> None:
    recordings = shared("worlds")
    files = [str(recordings / "mice"), "--world", str(recordings / "mouse_labyrinth.json")]
    printed, result = measured("recordings.py", tmp_path, *files, "--individuals", "B2", "--steps", "150")
    row = result["rows"][0]
    assert (row["steps"], row["astray"]) == (150, 0)
    assert row["places"] == row["nodes"] > 20
    assert "0 of 150 steps astray" in printed


def test_long_walks_say_what_has_grown(tmp_path: Path) -> None:
    _, result = measured("long.py", tmp_path, "plain", "noise", "--steps", "20")
    plain, noisy = result["rows"]
    assert (plain["form"], plain["places"], plain["rooms"], noisy["form"]) == ("plain", 9, 9, "noise")
    assert 0.8 < plain["growth"] < 1.5
    assert plain["ratio"] > 0.0


def test_damage_and_interruptions_leave_what_is_sound(tmp_path: Path) -> None:
    printed, result = measured("damage.py", tmp_path, "maze", "--trials", "6", "--keep", str(tmp_path))
    (row,) = result["rows"]
    assert (row["trials"], row["failures"], sum(row["found"].values())) == (6, {}, 6)
    assert "maze" in printed
    _, result = measured("interruptions.py", tmp_path, "paper", "--trials", "2")
    assert [(row["form"], row["torn"]) for row in result["rows"]] == [("paper", 0)]


def test_long_lists_of_actions_take_the_same_steps(tmp_path: Path) -> None:
    _, result = measured("actions.py", tmp_path, "4x4_alias", "--actions", "0", "12", "--seeds", "1")
    assert [[row["right"] for row in found["rows"]] for found in result["found"]] == [[True], [True]]
    assert len({row["steps"] for found in result["found"] for row in found["rows"]}) == 1


def test_percepts_of_every_kind_leave_the_map_right(tmp_path: Path) -> None:
    rows = ("features", "two", "hand")
    printed, result = measured("percepts.py", tmp_path, *rows, "--seeds", "0")
    assert {name: [row["right"] for row in found] for name, found in result["rows"].items()} == {
        name: [True] for name in rows
    }
    assert "features         right 1 of 1" in printed


def test_graphs_are_explored_beside_nearest_frontier(tmp_path: Path) -> None:
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (1, 3)]
    nodes = [{"id": i, "position": [4.0 * (i % 3), 3.0 * (i // 2)]} for i in range(4)]
    ways = [{"source": a, "target": b} for pair in edges for a, b in (pair, pair[::-1])]
    (tmp_path / "small.json").write_text(json.dumps({"directed": True, "nodes": nodes, "edges": ways}))
    asked = ("--worlds", "small", "--sights", "distinct", "2", "--noise", "odometry=0.02", "--starts", "2")
    printed, result = measured("buildings.py", tmp_path, str(tmp_path), *asked)
    assert [(row["sights"], row["right"]) for row in result["rows"]] == [
        (s, True) for s in ("distinct",) * 2 + ("2",) * 2
    ]
    assert all(row["over_frontier"] <= 1.5 for row in result["rows"])
    assert "small            distinct  n 2  entered 2  right 2" in printed


def test_a_robot_that_drives_in_rounds_knows_its_cells_again_though_its_odometry_drifts(tmp_path: Path) -> None:
    """Three rounds of 12 m by 8 m; the heading drifts by half a degree a metre, 60 degrees in all."""
    side = [(1.0, 0.0, 0.0)] * 11 + [(1.0, 0.0, np.pi / 2)], [(1.0, 0.0, 0.0)] * 7 + [(1.0, 0.0, np.pi / 2)]
    moves = np.array((side[0] + side[1] + side[0] + side[1]) * 3)
    heading = np.append(0.0, np.cumsum(moves[:, 2]))
    steps = np.stack([np.cos(heading[:-1]), np.sin(heading[:-1])], axis=1)
    truth = np.column_stack([np.append(np.zeros((1, 2)), np.cumsum(steps, axis=0), axis=0), heading])
    moves[:, 2] += np.deg2rad(0.5)
    log = {"odometry": moves.tolist(), "truth": truth.tolist()}
    (tmp_path / "log.json").write_text(json.dumps(log))
    printed, result = measured("odometry.py", tmp_path, str(tmp_path / "log.json"))
    row = result["rows"][0]
    assert row["right"] == row["cells"] >= 20
    assert row["off"] < 1.5
    assert "split 0" in printed


def test_detours_are_walked_around_shut_doors(tmp_path: Path) -> None:
    asked = ("--worlds", "donut", "t_maze", "random", "--look-ahead", "2", "6", "--ways", "2")
    printed, result = measured("detours.py", tmp_path, *asked)
    assert "t_maze         no door can be done without" in printed
    assert [(row["world"], row["look_ahead"], row["ways"], row["never"]) for row in result["rows"]] == [
        (world, look_ahead, 2, 0) for world in ("donut", "random") for look_ahead in (2, 6)
    ]
    assert max(row["worst"] for row in result["rows"] if row["world"] == "donut") <= 1.05


def test_step_time(tmp_path: Path) -> None:
    asked = ("3x3", "--steps", "3", "--runs", "2", "--look-ahead", "2", "--policies", "map_guided", "l_shaped")
    printed, result = measured("step_time.py", tmp_path, *asked)
    assert (result["world"], result["steps"]) == ("3x3", 3)
    kinds = [(row["policies"], row["look_ahead"]) for row in result["rows"]]
    assert kinds == [("map_guided", 2), ("l_shaped", 2)]
    for row in result["rows"]:
        assert row["policies"] in printed
        assert 0.0 < row["min"] <= row["median"]
        assert len(row["runs"]) == 2
        assert row["first"] == row["runs"][0]
        assert row["made"] == 3
        assert 10.0 < row["peak_megabytes"] < 2000.0
    assert 0.0 < result["import_seconds"] < 30.0
    assert result["machine"]["cores"] >= 1
    assert result["machine"]["python"] == sys.version.split()[0]


def test_step_time_breaks_off_what_takes_too_long_and_leaves_out_what_cannot_be_listed(tmp_path: Path) -> None:
    asked = ("3x3", "--steps", "50", "--runs", "1", "--look-ahead", "1", "10", "--policies", "exhaustive")
    printed, result = measured("step_time.py", tmp_path, *asked, "--seconds", "0")
    (row,) = result["rows"]
    assert (row["look_ahead"], row["made"]) == (1, 1)
    assert "exhaustive: more than 2,000,000 policies at look-ahead 10" in printed


def test_inference_engines_agree(tmp_path: Path) -> None:
    _, result = measured("inference.py", tmp_path, "--windows", "1", "3", "--supports", "2", "7", "--runs", "1")
    assert [(row["window"], row["support"]) for row in result["rows"]] == [(1, 2), (1, 7), (3, 2), (3, 7)]
    for row in result["rows"]:
        assert min(row["numpy"], row["gtsam"]) > 0.0
        assert row["difference"] <= 1e-9


def test_ablations(tmp_path: Path) -> None:
    _, result = measured("ablations.py", tmp_path, "commit", "rates", "--mazes", "3x3", "t_maze", "--runs", "1")
    rows = [(row["ablation"], row["maze"], row["variant"]) for row in result["rows"]]
    assert rows[:4] == [
        ("commit", "3x3", "committed"),
        ("commit", "3x3", "kept apart"),
        ("commit", "t_maze", "committed"),
        ("commit", "t_maze", "kept apart"),
    ]
    assert [variant for _, _, variant in rows[4:]] == ["table", "text"] * 2
    assert all(row["runs"] == 1 and row["completed"] == 1 for row in result["rows"])


@pytest.mark.parametrize(
    ("measure", "maze", "variants"),
    [("kidnap", "random12_4", 1), ("doors", "random12_4", 2), ("exploring", "3x3", 3), ("search", "3x3", 2)],
)
def test_moves(measure: str, maze: str, variants: int, tmp_path: Path) -> None:
    printed, result = measured("moves.py", tmp_path, measure, "--mazes", maze, "--runs", "1")
    assert [row["maze"] for row in result["rows"]] == [maze] * variants
    assert maze in printed
    for row in result["rows"]:
        assert all(row[count] in (0, 1) for count in ("recovered", "intact", "right") if count in row)
    if measure == "search":
        assert result["rows"][0]["labels"] == result["rows"][0]["rooms"]  # each room of 3x3 has its own
        assert 4.0 <= result["rows"][0]["rooms"] < 6.0


def test_scale(tmp_path: Path) -> None:
    asked = ("--rooms", "9", "40", "--steps", "5", "--moves", "2", "--mazes", "2", "--look-ahead", "3")
    printed, result = measured_apart("scale.py", tmp_path, *asked)
    rows = {(row["part"], row["rooms"]): row for row in result["rows"]}
    assert set(rows) == {(part, n) for part in ("localised", "goal", "lost", "save", "explore") for n in (9, 40)}
    for (part, rooms), row in rows.items():
        assert f"{rooms:8}  {part}" in printed
        if part == "save":
            assert min(row["save_s"], row["load_s"]) > 0.0
            assert 100.0 < row["file_bytes_a_room"] < row["bytes_a_room"] < row["in_use_bytes_a_room"] < 60_000.0
            continue
        assert 0.0 < row["median_ms"] <= row["p99_ms"]
        if part == "lost":
            assert (row["moves"], row["recovered"]) == (2, 2)
            assert row["to_recover"] >= 0.0
        if part == "explore":
            assert row["mazes"] == 2
            assert rooms - 1 <= min(row["agent"], row["frontier"]) < 3 * rooms
            assert row["steps"] == sum(row["of_each"]["agent"]) + 2  # the observation of the first room comes first


def test_scale_says_when_memory_does_not_suffice(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    scale = importlib.import_module("scale")

    def too_large(rooms: int, asked: object) -> dict[str, Any]:
        raise MemoryError

    monkeypatch.setitem(scale.PARTS, "localised", too_large)
    row = scale.measured("localised", 900, SimpleNamespace(gigabytes=0.3))
    assert row == {"part": "localised", "rooms": 900, "failed": "more than 0.3 GB"}


@pytest.mark.parametrize("seed", range(3))
def test_a_known_agent_is_like_one_that_walked(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    known = importlib.import_module("known")
    maze = labyrinth(25, loops=0.3, rng=np.random.default_rng(seed))
    start = maze.rooms[7 * seed]
    taught, walked, truth = known.known_agent(maze, start), Agent(GRID), Truth(maze, start)
    world = MazeEnv(maze)
    observation, _ = world.reset(options={"start": start})
    walk = list(known.depth_first(maze, start))
    for (_, room), (action, _) in zip(walk, [*walk[1:], (4, start)], strict=True):
        assert world.position == room
        walked.step(observation)
        observation = {**world.step(action)[0], "taken": action}
    for agent in (taught, walked):
        assert truth.visited(agent.map)
        assert truth.learned(agent.map)
    assert taught.map.positions._labels == walked.map.positions._labels
    for name in ("sensed", "walked", "visited_places"):
        np.testing.assert_array_equal(getattr(taught.map, name), getattr(walked.map, name))
    for name in ("A", "B", "positions_given_places"):
        np.testing.assert_allclose(getattr(taught.map, name)(), getattr(walked.map, name)(), atol=1e-3)
    taught.step(world.reset(options={"start": start})[0])
    assert taught.belief.place == walked.belief.place == 0
    assert taught.certain


def test_peers_our_side_alone(tmp_path: Path) -> None:
    asked = ("--places", "16", "--length", "3", "--seconds", "0.01", "--peers")
    printed, result = measured("peers/run.py", tmp_path, *asked)
    (row,) = result["rows"]
    assert (row["places"], row["library"], row["ratio"], row["G_differs_by"]) == (16, "cogmap", 1.0, 0.0)
    assert min(row["inference"], row["planning"]) > 0.0
    assert result["policies"] == 36
    assert "cogmap" in printed
    assert result["versions"]["cogmap"]["numpy"] == np.__version__


def test_peers_solve_the_same_problem_as_the_equations(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(BENCHMARKS / "peers"))
    problem = importlib.import_module("problem").grid_problem(4, 3)
    A, B, D = (problem[name] for name in ("A", "B", "D"))
    for table in (A, B, D, np.exp(problem["log_C"])):
        np.testing.assert_allclose(table.sum(axis=0), 1.0)
    infer, plan, last = importlib.import_module("side_cogmap").side(problem)
    infer()
    plan()
    posterior, gain = last()
    q = (B[:, :, problem["action"]] @ D) * A[problem["sight"]]
    np.testing.assert_allclose(posterior, q / q.sum(), atol=1e-12)
    expected = []
    for policy in problem["policies"]:
        s, total = q / q.sum(), 0.0
        for action in policy:
            s = B[:, :, action] @ s
            o = A @ s
            total += (
                o @ problem["log_C"] - (o * np.log(np.maximum(o, 1e-300))).sum()
            )  # sights are certain: no ambiguity
        expected.append(total)
    np.testing.assert_allclose(gain, expected, atol=1e-9)


def test_unknown_names_are_refused(tmp_path: Path) -> None:
    for arguments in (["discounts"], ["rates", "--mazes", "5x5"]):
        command = [sys.executable, str(BENCHMARKS / "ablations.py"), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
        assert done.returncode == 2
        assert arguments[-1] in done.stderr


@pytest.mark.parametrize("name", ["step_time.py", "inference.py", "ablations.py", "moves.py", "scale.py"])
def test_bad_arguments_are_refused(name: str) -> None:
    option = "--steps" if name == "scale.py" else "--runs"
    done = subprocess.run([sys.executable, str(BENCHMARKS / name), option, "many"], capture_output=True, check=False)
    assert done.returncode == 2


@pytest.mark.parametrize(
    "name", sorted(path.name for path in BENCHMARKS.glob("*.py") if "json_path)" in path.read_text())
)
def test_a_result_that_cannot_be_written_is_refused_before_anything_is_measured(name: str, tmp_path: Path) -> None:
    command = [sys.executable, str(BENCHMARKS / name), "--json", str(tmp_path / "nowhere" / "result.json")]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 2
    assert "cannot be written; name a file in a folder that is there" in done.stderr


def test_networks(tmp_path: Path) -> None:
    graph = FactorGraph()
    graph.variable("rain", ("no", "yes"))
    graph.variable("wet", ("no", "yes"))
    graph.factor("P", ["rain"], [0.8, 0.2])
    graph.factor("P", ["wet", "rain"], [[0.9, 0.2], [0.1, 0.8]])
    folder = tmp_path / "networks"
    folder.mkdir()
    save_graph(graph, folder / "rain.bif")
    save_graph(graph, folder / "rain.uai")
    (folder / "rain.uai.evid").write_text("1 1 1")
    (folder / "rain.uai.MAR").write_text("MAR 2 2 0.333333 0.666667 2 0 1")
    printed, result = measured("networks.py", tmp_path, str(folder), "--runs", "2", "--no-peer")
    one, other = result["rows"]
    assert (one["variables"], other["variables"]) == (2, 2)
    assert one["solution"] is None
    assert other["solution"] < 1e-6
    assert all(one["milliseconds"][question]["cogmap"] > 0 for question in ("all", "one", "again"))
    assert printed.count("rain ") == 2
    printed, result = measured("inference.py", tmp_path, "--windows", "1", "--supports", "2", "--runs", "1")
    assert result["rows"][0]["difference"] < 1e-9
    file = tmp_path / "out.json"
    given = ["--networks", str(folder), "--runs", "1", "--memory", "10", "--no-peer", "--json", str(file)]
    subprocess.run([sys.executable, str(BENCHMARKS / "inference.py"), *given], check=True, capture_output=True)
    assert "needs" in json.loads(file.read_text())["rows"][0]["refused"]


def test_tables_of_the_documents_are_written_row_by_row() -> None:
    sys.path.insert(0, str(BENCHMARKS))
    try:
        written = importlib.import_module("tables").written
    finally:
        sys.path.remove(str(BENCHMARKS))
    page = "# A\n\n| maze | done |\n| --- | ---: |\n| `3x3` | 1/2 |\n| `4x4` | 2/2 |\n\n| `3x3` | stays |\n"
    changed = written(page, "| maze | done |", {"3x3": ["20/20"]})
    assert changed == page.replace("1/2", "20/20")
    whole = written(page, "| maze | done |", {"donut | 1": ["2.0"]}, whole=True)
    assert whole == page.replace("| `3x3` | 1/2 |\n| `4x4` | 2/2 |", "| donut | 1 | 2.0 |")
    for heading, maze in (("| no | such |", "3x3"), ("| maze | done |", "donut")):
        with pytest.raises(ValueError, match="no"):
            written(page, heading, {maze: ["x"]})
