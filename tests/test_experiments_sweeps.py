from __future__ import annotations

import json
import multiprocessing
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Settings
from cogmap.experiments import (
    Cell,
    Ledger,
    Parts,
    Row,
    WorkerLostError,
    completed,
    explore,
    explore_many,
    frontier_steps,
    map_seeds,
    map_tasks,
    run_cell,
    run_cells,
    workers,
)
from cogmap.experiments.cli import progress
from cogmap.model import CogmapError
from cogmap.worlds import MAZES, Maze, MazeEnv, random_maze
from command_line import cogmap, heeding_ctrl_c

SMALL, LINE = MAZES["3x3"], Maze("line", {(0, 0): 0, (0, 1): 1, (0, 2): 2})
CELLS = [
    *(Cell(SMALL, "cogmap", seed) for seed in range(4)),
    *(Cell(LINE, "cogmap", seed, growth) for growth in ("observed", "static") for seed in range(2)),
    *(Cell(LINE, agent, seed) for agent in ("frontier", "random") for seed in range(2)),
]


def ordered(rows: Iterator[Row] | list[Row]) -> list[Row]:
    return sorted(rows, key=lambda row: row.key)


@pytest.fixture(scope="module")
def serial() -> list[Row]:
    return list(run_cells(CELLS))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "cells.jsonl"


@pytest.fixture
def explored(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many explorations began in this process."""
    begun: list[int] = []
    reset = MazeEnv.reset

    def counted(self: MazeEnv, **options: Any) -> Any:
        begun.append(1)
        return reset(self, **options)

    monkeypatch.setattr(MazeEnv, "reset", counted)
    return begun


def square(number: int) -> int:
    if number < 0:
        raise ArithmeticError(f"{number} is negative")
    return number**2


# tasks


@pytest.mark.parametrize("executor", [lambda: nullcontext(None), lambda: ThreadPoolExecutor(2)])
def test_tasks_come_with_their_index_and_in_order(executor: Callable[[], Any]) -> None:
    told: list[None] = []
    with executor() as where:
        assert dict(completed(square, range(7), executor=where)) == {number: number**2 for number in range(7)}
        assert map_tasks(square, [3, 1, 2], executor=where, on_done=lambda: told.append(None)) == [9, 1, 4]
        assert map_seeds(square, runs=2, seed=5, executor=where) == [25, 36]
        assert map_tasks(square, [], executor=where) == []
        with pytest.raises(ArithmeticError, match="-1 is negative"):
            map_tasks(square, [1, -1, 2], executor=where)
    assert len(told) == 3


def test_without_an_executor_a_task_runs_when_it_is_asked_for() -> None:
    begun: list[int] = []

    def note(number: int) -> int:
        begun.append(number)
        return number

    results = completed(note, [1, 2, 3])
    assert begun == []
    assert next(results) == (0, 1)
    assert begun == [1]


@pytest.mark.parametrize("fails", [True, False])
def test_what_has_not_begun_is_cancelled(fails: bool) -> None:
    begun: list[int] = []

    def note(number: int) -> int:
        begun.append(number)
        time.sleep(0.02)
        return square(-1 if fails else number)

    with ThreadPoolExecutor(1) as threads:
        results = completed(note, range(100), executor=threads)
        if fails:
            with pytest.raises(ArithmeticError):
                next(results)
        else:
            next(results)
            results.close()  # type: ignore[attr-defined]
    assert len(begun) < 10


def test_at_an_error_what_has_finished_comes_first() -> None:
    with ThreadPoolExecutor(1) as threads:
        results = completed(square, [1, 2, -1, 3], executor=threads)
        first = next(results)
        threads.shutdown()  # all are done
        rest: list[tuple[int, int]] = []
        with pytest.raises(ArithmeticError):
            rest.extend(results)
        assert [first, *rest][:2] == [(0, 1), (1, 4)]


def test_executors_that_do_not_go_together_are_refused() -> None:
    for options, message in (
        ({"jobs": 0}, "jobs is 0; use 1 to 1024"),
        ({"jobs": 2, "dask": "localhost:8786"}, "jobs is 2 and dask is localhost:8786; give one of them"),
    ):
        with pytest.raises(CogmapError, match=message), workers(**options):  # type: ignore[arg-type]
            pytest.fail("it began")
    with workers() as executor:
        assert executor is None


# cells


def test_a_cell_is_the_exploration_with_its_seed() -> None:
    row = run_cell(Cell(SMALL, "cogmap", 3, "observed"), max_steps=40)
    assert row.run == explore(SMALL, seed=3, max_steps=40, agent=Parts(growth="observed"))
    assert (row.world, row.agent, row.growth) == ("3x3", "cogmap", "observed")
    assert explore_many(SMALL, runs=2, seed=3)[0] == run_cell(Cell(SMALL, "cogmap", 3)).run


def test_rows_are_equal_whatever_time_they_took(serial: list[Row]) -> None:
    row = serial[0]
    slower = replace(row, run=replace(row.run, seconds=row.run.seconds + 1))
    assert slower == row
    assert replace(row, run=replace(row.run, steps_to_learn=1)) != row


def test_rows_are_plain_json_and_come_back(serial: list[Row]) -> None:
    never = run_cell(Cell(SMALL, "random", 0), max_steps=1)
    for row in [*serial, never, replace(never, run=replace(never.run, oracle_steps=None, frontier_steps=9))]:
        assert Row.from_dict(json.loads(json.dumps(row.to_dict(), allow_nan=False))) == row
    assert never.run.steps_to_learn is None


def test_where_the_oracle_is_out_of_reach_the_row_has_the_frontier() -> None:
    maze = random_maze(90, sights=None, rng=np.random.default_rng(0))
    row = run_cell(Cell(maze, "random", 0), max_steps=1)
    assert row.to_dict()["oracle_steps"] is None
    assert row.run.frontier_steps == row.to_dict()["frontier_steps"] == frontier_steps(maze, row.run.start)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"seed": "1"}, "row has seed = '1', not a whole number"),
        ({"seed": None}, "row has seed = None"),
        ({"steps_to_learn": True}, "row has steps_to_learn = True, not a whole number or null"),
        ({"start": [0]}, r"row has start = \[0\], not a room"),
        ({"world": 3}, "row has world = 3, not a word"),
        ({"seconds": "fast"}, "row has seconds = 'fast', not a number"),
        ({"more": 1}, "row has an unknown value 'more'"),
    ],
)
def test_bad_rows_are_refused(serial: list[Row], change: dict[str, Any], message: str) -> None:
    values = serial[0].to_dict()
    with pytest.raises(CogmapError, match=message):
        Row.from_dict({**values, **change})
    name = next(iter(change))
    if name in values:
        del values[name]
        with pytest.raises(CogmapError, match=f"row has no {name}; remove it"):
            Row.from_dict(values)


@pytest.mark.parametrize("executor", [lambda: ThreadPoolExecutor(3), lambda: workers(jobs=2)])
def test_the_rows_do_not_depend_on_the_executor(serial: list[Row], executor: Callable[[], Any], path: Path) -> None:
    with executor() as where, Ledger(path) as ledger:
        assert ordered(run_cells(CELLS, executor=where, ledger=ledger)) == ordered(serial)
        assert ordered([Row.from_dict(row) for row in ledger.rows]) == ordered(serial)


def test_bad_cells_are_refused_before_anything_runs(explored: list[int]) -> None:
    good = Cell(LINE, "cogmap", 0)
    for cells, message in (
        ([good, Cell(LINE, "nobody", 0)], "no agent is called 'nobody'"),
        ([good, Cell(LINE, "cogmap", 0, "wild")], "cells: no growth is called 'wild'; choose one of"),
        ([good, Cell(LINE, "cogmap", -1)], "cells: seed is -1"),
        ([good, good], "cells: line, cogmap, seed 0 is given twice"),
    ):
        with pytest.raises(CogmapError, match=message):
            run_cells(cells)
    with pytest.raises(CogmapError, match="cells: max_steps is 0"):
        run_cells([good], max_steps=0)
    assert not explored


# resuming


def test_what_was_interrupted_goes_on_where_it_was(serial: list[Row], path: Path, explored: list[int]) -> None:
    with Ledger(path) as ledger:
        rows = run_cells(CELLS, ledger=ledger)
        first = [next(rows) for _ in range(5)]
    with path.open("ab") as file:
        file.write(b'{"world": "3x')  # killed while it wrote
    with Ledger(path) as ledger:
        rows = run_cells(CELLS, ledger=ledger)
        assert [next(rows) for _ in range(5)] == first
        assert len(explored) == 5
        assert [*first, *rows] == serial
    with Ledger(path) as ledger:
        assert list(run_cells(CELLS, ledger=ledger)) == serial
    assert len(explored) == len(CELLS)


def test_more_cells_may_be_asked_for_and_others_may_be_there(path: Path, explored: list[int]) -> None:
    with Ledger(path) as ledger:
        list(run_cells(CELLS[4:8], ledger=ledger))
        rows = list(run_cells(CELLS[6:10], ledger=ledger))
    assert [row.key for row in rows] == [cell.key for cell in CELLS[6:10]]
    assert len(explored) == 6


def test_of_two_rows_of_a_cell_the_first_counts(path: Path, serial: list[Row]) -> None:
    with Ledger(path) as ledger:
        list(run_cells(CELLS[8:10], ledger=ledger))
        ledger.append({**ledger.rows[0], "steps_to_learn": 77})
    with Ledger(path) as ledger:
        assert list(run_cells(CELLS[8:10], ledger=ledger)) == serial[8:10]


def test_a_maze_of_the_same_name_but_other_content_is_another_cell(path: Path) -> None:
    longer = Maze("line", {(0, column): column for column in range(4)})
    worded = Maze("line", {(0, column): str(column) for column in range(3)})
    layouts = [Cell(maze, "frontier", 0).key[1] for maze in (LINE, longer, worded, SMALL)]
    assert len(set(layouts)) == 4
    assert Cell(Maze("other", dict(LINE.sights)), "frontier", 0).key[1] == layouts[0]
    with Ledger(path) as ledger:
        for maze in (LINE, longer, worded):
            (row,) = run_cells([Cell(maze, "frontier", 0)], ledger=ledger)
            assert row == run_cell(Cell(maze, "frontier", 0))
        assert len(ledger.rows) == 3


def test_other_settings_are_refused_before_anything_runs(path: Path, explored: list[int]) -> None:
    cells = [Cell(LINE, "cogmap", 0)]
    with Ledger(path) as ledger:
        list(run_cells(cells, ledger=ledger, settings=Settings()))
    explored.clear()
    for options, message in (
        ({"settings": Settings(look_ahead=7)}, "settings.look_ahead = 6, this run has 7"),
        ({"max_steps": 9}, "max_steps = null, this run has 9"),
    ):
        with Ledger(path) as ledger, pytest.raises(CogmapError, match=re.escape(message)):
            run_cells(cells, ledger=ledger, **options)  # type: ignore[arg-type]
    assert not explored


# what ends too soon


def test_a_killed_worker_costs_no_more_than_what_was_in_flight(serial: list[Row], path: Path) -> None:
    seen: list[Row] = []

    def killing(executor: Executor | None, ledger: Ledger) -> None:
        for row in run_cells(CELLS, executor=executor, ledger=ledger):
            seen.append(row)
            if len(seen) == 2:
                os.kill(multiprocessing.active_children()[0].pid or 0, signal.SIGKILL)

    with (
        Ledger(path) as ledger,
        pytest.raises(WorkerLostError, match=r"killed, .*finished runs are kept in .*cells.jsonl, run the same again"),
        workers(jobs=2) as executor,
    ):
        killing(executor, ledger)
    assert multiprocessing.active_children() == []
    with Ledger(path) as ledger:
        rows = list(run_cells(CELLS, ledger=ledger))
    assert 2 <= len(seen) < len(CELLS)
    assert rows[: len(seen)] == seen
    assert ordered(rows) == ordered(serial)


SCRIPT = """
import multiprocessing, sys
from pathlib import Path
from cogmap.experiments import Cell, Ledger, run_cells, workers
from cogmap.worlds import MAZES
from cogmap.experiments import Parts

if __name__ == "__main__":
    cells = [Cell(MAZES["3x3"], "cogmap", seed) for seed in range(1000)]
    try:
        with Ledger("cells.jsonl") as ledger, workers(jobs=2) as executor:
            for _ in run_cells(cells, executor=executor, ledger=ledger):
                print(*(process.pid for process in multiprocessing.active_children()), flush=True)
    except KeyboardInterrupt:
        sys.exit(130)
"""


@pytest.mark.parametrize("blow", [signal.SIGINT, signal.SIGKILL])
def test_an_end_from_outside_leaves_the_rows_and_no_process(tmp_path: Path, blow: signal.Signals) -> None:
    (tmp_path / "script.py").write_text(SCRIPT)
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    pipes["preexec_fn"] = heeding_ctrl_c
    process = subprocess.Popen([sys.executable, "script.py"], cwd=tmp_path, start_new_session=True, **pipes)
    assert process.stdout is not None
    pids = [process.stdout.readline().split() for _ in range(3)][-1]
    if blow == signal.SIGINT:
        os.killpg(process.pid, blow)  # as Ctrl-C in a terminal does
    else:
        process.kill()
    _, errors = process.communicate(timeout=90)
    assert process.returncode == (130 if blow == signal.SIGINT else -signal.SIGKILL)
    assert "Traceback" not in errors
    assert len(pids) == 2
    assert _gone(pids)
    with Ledger(tmp_path / "cells.jsonl") as ledger:
        (row,) = run_cells([Cell(SMALL, "cogmap", 0)], ledger=ledger)
        assert len(ledger.rows) >= 3
        assert row == run_cell(Cell(SMALL, "cogmap", 0))


def _gone(pids: list[str], *, patience: float = 60.0) -> bool:
    """Whether these processes have ended, be it that nobody has asked for their exit code yet."""
    until = time.monotonic() + patience
    while time.monotonic() < until:
        if not any(_lives(pid) for pid in pids):
            return True
        time.sleep(0.05)
    return False


def _lives(pid: str) -> bool:
    found = subprocess.run(["ps", "-o", "stat=", "-p", pid], capture_output=True, text=True, check=False).stdout.strip()
    return bool(found) and not found.startswith("Z")


# the command line


def test_the_bar_shows_the_time_left_of_what_was_not_done_before(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.6)
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "100")
    with progress.counting("sweeping", 1000) as one_more:
        for _ in range(500):
            one_more()
        time.sleep(0.7)
        for _ in range(8):
            one_more()
            time.sleep(0.1)
    shown = re.findall(
        r"(\d+)/1000.*?(\d+):(\d\d):(\d\d)\D+left\D+(\d+):(\d\d):(\d\d)", _plain(capsys.readouterr().err)
    )
    assert shown
    hours, minutes, seconds = map(int, shown[-1][4:])
    assert 3600 * hours + 60 * minutes + seconds >= 30  # 492 at ten a second or fewer, not at those done at once


def _plain(text: str) -> str:
    return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text)


@pytest.mark.usefixtures("empty_folder")
@pytest.mark.parametrize(
    ("command", "message"),
    [
        (
            ["explore", "3x3", "--runs", 2, "--jobs", 2, "--dask", "here:1"],
            "jobs is 2 and dask is here:1; give one of them",
        ),
        (["kidnap", "3x3", "--jobs", 2, "--dask", "here:1"], "jobs is 2 and dask is here:1; give one of them"),
        (["navigate", "3x3", "--goal", 3, "--jobs", 2, "--dask", "here:1"], "jobs is 2 and dask is here:1"),
        (["explore", "3x3", "--dask", "here:1"], "--dask is for sweeps; give --runs as well"),
    ],
)
def test_options_that_do_not_go_together_are_refused(command: list[object], message: str) -> None:
    result = cogmap(*command)
    assert result.exit_code == 2
    assert message in result.stderr
    assert result.stderr.count("\n") == 1
    assert os.listdir() == []


@pytest.mark.skipif(os.name == "nt", reason="no limit of open files")
def test_processes_that_cannot_be_started_are_one_line() -> None:
    code = (
        "import resource; resource.setrlimit(resource.RLIMIT_NOFILE, (16, 16)); "
        "from cogmap.experiments.cli import main; main()"
    )
    command = [sys.executable, "-c", code, "explore", "3x3", "--runs", "8", "--jobs", "8"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr.startswith("cogmap: cannot start 8 processes (Too many open files); use fewer jobs, or")
    assert done.stderr.count("\n") == 1


def test_more_processes_than_a_machine_has_are_refused() -> None:
    with pytest.raises(CogmapError, match="jobs is 100000; use 1 to 1024"), workers(jobs=100_000):
        pytest.fail("it began")


def test_ctrl_c_waits_until_a_process_has_been_started(monkeypatch: pytest.MonkeyPatch) -> None:
    """Or else it would be told half of what it needs, and say so."""
    started: list[bool] = []
    submit = ProcessPoolExecutor.submit

    def interrupted(*args: Any) -> Any:
        os.kill(os.getpid(), signal.SIGINT)
        future = submit(*args)
        started.append(True)
        return future

    monkeypatch.setattr(ProcessPoolExecutor, "submit", interrupted)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have had it ignored
    try:
        with workers(jobs=2) as executor:
            assert executor is not None
            with pytest.raises(KeyboardInterrupt):
                executor.submit(abs, -1)
    finally:
        signal.signal(signal.SIGINT, before)
    assert started == [True]
