from __future__ import annotations

import socket
import sys
import threading
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from cogmap.experiments import (
    Cell,
    Ledger,
    Row,
    WorkerLostError,
    completed,
    dask_cluster,
    map_tasks,
    pool,
    run_cells,
    workers,
)
from cogmap.model import CogmapError
from cogmap.worlds import MAZES
from command_line import cogmap

CELLS = [Cell(MAZES["3x3"], agent, seed) for agent in ("cogmap", "frontier") for seed in range(2)]


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """A cluster of two workers, ended after the last test of this module."""
    distributed: Any = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as cluster:
        yield cluster.scheduler_address


def nap(number: int) -> int:
    time.sleep(0.2)
    return number


def note(folder: Path, number: int) -> None:
    (folder / str(number)).touch()
    time.sleep(0.05)


def refusal(address: str) -> str:
    with pytest.raises(CogmapError) as error, workers(dask=address):
        pytest.fail("it began")
    return str(error.value)


def test_the_rows_are_those_of_this_process(address: str, tmp_path: Path) -> None:
    with workers(dask=address) as executor, Ledger(tmp_path / "cells.jsonl") as ledger:
        rows = list(run_cells(CELLS, executor=executor, ledger=ledger))
        assert [Row.from_dict(row) for row in ledger.rows] == rows
    assert sorted(rows, key=lambda row: row.key) == sorted(run_cells(CELLS), key=lambda row: row.key)


@pytest.mark.usefixtures("empty_folder")
def test_a_command_says_the_same(address: str) -> None:
    command = ("kidnap", "3x3", "--runs", 2)
    assert cogmap(*command, "--dask", address.removeprefix("tcp://")).stdout == cogmap(*command).stdout


def test_what_has_not_begun_is_cancelled(address: str, tmp_path: Path) -> None:
    with workers(dask=address) as executor:
        results = completed(partial(note, tmp_path), range(400), executor=executor)
        next(results)
        results.close()  # type: ignore[attr-defined]
        assert dict(completed(nap, range(2), executor=executor)) == {0: 0, 1: 1}  # both workers are free again
    assert len(list(tmp_path.iterdir())) < 400


def test_an_error_of_a_task_arrives(address: str) -> None:
    with workers(dask=address) as executor, pytest.raises(ZeroDivisionError):
        map_tasks((1).__truediv__, [1, 0], executor=executor)


def replaced(address: str, code: str) -> None:
    """Run code in the workers that replaces what they say their version of cogmap is."""
    distributed: Any = pytest.importorskip("distributed")
    with distributed.Client(address, set_as_default=False) as client:
        client.run(exec, f"import importlib, importlib.metadata as metadata\n{code}", {})


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("metadata.version = lambda name: '99.0'", "has cogmap 99.0, this is "),
        ("def version(name): raise metadata.PackageNotFoundError(name)\nmetadata.version = version", "has no cogmap; "),
    ],
)
def test_workers_of_another_version_or_without_cogmap_are_refused(address: str, code: str, message: str) -> None:
    replaced(address, code)
    try:
        assert message in (found := refusal(address))
        assert "there" in found
    finally:
        replaced(address, "importlib.reload(metadata)")


def test_a_cluster_that_goes_is_one_line(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
    distributed: Any = pytest.importorskip("distributed")
    monkeypatch.setattr(dask_cluster, "PATIENCE", 1.5)
    cluster = distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=":0")
    with workers(dask=cluster.scheduler_address) as executor:
        results = completed(nap, range(8), executor=executor)
        next(results)
        cluster.close()
        with pytest.raises(WorkerLostError, match="lost its scheduler"):
            list(results)
    assert "reconnect" not in capfd.readouterr().err


@pytest.mark.parametrize("address", ["", "here", "nonsense::1", "http://127.0.0.1:80", "127.0.0.1:1"])
def test_no_scheduler_is_one_line(
    address: str, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr(dask_cluster, "PATIENCE", 1.5)
    assert f"no Dask scheduler answers at '{address}' (" in (found := refusal(address))
    assert "\n" not in found
    assert capfd.readouterr().err == ""


def test_something_else_that_listens_is_no_scheduler(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr(dask_cluster, "PATIENCE", 1.5)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        assert "something else listens there" in refusal(f"127.0.0.1:{silent.getsockname()[1]}")


def test_a_cluster_without_workers_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    distributed: Any = pytest.importorskip("distributed")
    monkeypatch.setattr(dask_cluster, "PATIENCE", 1.5)
    with distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=":0") as cluster:
        assert "has no workers; start one: dask worker" in refusal(cluster.scheduler_address)


def test_without_the_package_the_way_to_install_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert refusal("here:8786").endswith("run: pip install 'cogmap[dask]'")


def test_a_worker_of_another_version_that_joins_later_is_one_line(address: str) -> None:
    with workers(dask=address) as executor:
        replaced(address, "metadata.version = lambda name: '99.0'")
        replaced(address, "import cogmap.experiments.dask_cluster as there\nthere.version = metadata.version")
        try:
            with pytest.raises(CogmapError, match=r"a Dask worker has cogmap 99\.0, this is .*; install the same"):
                map_tasks(nap, range(2), executor=executor)
        finally:
            replaced(address, "importlib.reload(metadata)")
            replaced(address, "import cogmap.experiments.dask_cluster as there\nthere.version = metadata.version")


def test_a_cluster_that_loses_its_workers_says_so_and_goes_on(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    distributed: Any = pytest.importorskip("distributed")
    monkeypatch.setattr(pool, "SILENCE", 0.3)
    with (
        distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=":0") as cluster,
        workers(dask=cluster.scheduler_address) as executor,
    ):
        results = completed(nap, range(4), executor=executor)
        next(results)
        cluster.scale(0)
        threading.Timer(2.5, cluster.scale, (1,)).start()
        assert len(list(results)) == 3
    assert [record.message for record in caplog.records if "has no workers left; start one" in record.message]


def missing_module(number: int) -> int:
    raise ModuleNotFoundError("No module named 'gtsam'", name="gtsam")


def test_a_worker_that_lacks_a_package_is_one_line(address: str) -> None:
    with workers(dask=address) as executor, pytest.raises(CogmapError, match="a Dask worker has no gtsam; install"):
        map_tasks(missing_module, range(1), executor=executor)
