from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest
from cogmap.experiments import Ledger
from cogmap.model import CogmapError

SETTINGS: dict[str, Any] = {"settings": {"look_ahead": 6, "priors": {"sight": 0.1}}, "max_steps": None}


def begun(path: Path, **changes: Any) -> list[dict[str, Any]]:
    with Ledger(path) as ledger:
        return ledger.begin(dict, **{**SETTINGS, **changes})


def filled(path: Path, rows: int = 3) -> list[bytes]:
    with Ledger(path) as ledger:
        ledger.begin(dict, **SETTINGS)
        for number in range(rows):
            ledger.append({"row": number})
    return path.read_bytes().splitlines(keepends=True)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "cells.jsonl"


def test_rows_are_lines_after_a_header(path: Path) -> None:
    header, *rows = map(json.loads, filled(path))
    assert header == {"schema": "cogmap.cells", "version": 1, **SETTINGS}
    assert rows == begun(path) == [{"row": 0}, {"row": 1}, {"row": 2}]


def test_a_row_is_in_the_file_before_the_next(path: Path) -> None:
    with Ledger(path) as ledger:
        ledger.begin(dict, **SETTINGS)
        for number in range(3):
            ledger.append({"row": number})
            assert json.loads(path.read_bytes().splitlines()[-1]) == {"row": number} == ledger.rows[-1]


def test_wherever_a_write_is_torn_the_rows_before_it_are_kept(path: Path) -> None:
    lines = filled(path)
    content, ends = b"".join(lines), [sum(map(len, lines[: number + 1])) for number in range(len(lines))]
    for size in range(len(content) + 1):
        path.write_bytes(content[:size])
        whole = max(sum(end <= size for end in ends) - 1, 0)
        assert begun(path) == [{"row": number} for number in range(whole)]
        assert path.read_bytes() == content[: ends[whole]]


@pytest.mark.parametrize("last", [b"\0" * 40 + b"\n", b"\xff\n", b"[1, 2]\n", b"\n"])
def test_a_last_line_of_rubbish_is_cut_off(path: Path, last: bytes) -> None:
    lines = filled(path)
    path.write_bytes(b"".join(lines) + last)
    with Ledger(path) as ledger:
        assert ledger.begin(dict, **SETTINGS) == [{"row": 0}, {"row": 1}, {"row": 2}]
        ledger.append({"row": 3})
    assert path.read_bytes() == b"".join(lines) + b'{"row": 3}\n'


@pytest.mark.parametrize("bad", [b'{"row": 1, "sta\n', b"\0\0\0\n", b"3\n"])
def test_rubbish_elsewhere_is_refused_with_its_line(path: Path, bad: bytes) -> None:
    header, first, _, third = filled(path)
    path.write_bytes(header + first + bad + third)
    with pytest.raises(CogmapError, match=r"cells\.jsonl, line 3: unreadable; remove this line"):
        Ledger(path)
    assert path.read_bytes() == header + first + bad + third


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"max_steps": 600}, "max_steps = null, this run has 600"),
        ({"settings": {"look_ahead": 7, "priors": {"sight": 0.1}}}, "settings.look_ahead = 6, this run has 7"),
        ({"settings": {"look_ahead": 6, "priors": {"sight": 0.2}}}, "settings.priors.sight = 0.1, this run has 0.2"),
        ({"cogmap": "9.9"}, 'cogmap = "nothing", this run has "9.9"'),
        ({"settings": {"look_ahead": 6}}, 'settings.priors.sight = 0.1, this run has "nothing"'),
    ],
)
def test_other_settings_are_refused_by_name(path: Path, changes: dict[str, Any], message: str) -> None:
    lines = filled(path)
    path.write_bytes(b"".join(lines) + b'{"to')
    with pytest.raises(CogmapError) as error:
        begun(path, **changes)
    assert message in str(error.value)
    assert str(error.value).endswith("; give another file, or remove it")
    assert path.read_bytes() == b"".join(lines) + b'{"to'


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"my thesis, in one line", "keeps no runs of cogmap"),
        (b"my thesis\nin two\n", "keeps no runs of cogmap"),
        (b"\x89PNG\r\n\x1a\n\0\0", "keeps no runs of cogmap"),
        (b"[]\n", "keeps no runs of cogmap"),
        (b'{"schema": "other", "version": 1}\n', "keeps no runs of cogmap"),
        (b'{"schema": "cogmap.cells", "version": 2}\n{"torn', r"version 2 of the schema cogmap\.cells, .* writes 1"),
    ],
)
def test_other_files_are_refused_and_left_alone(path: Path, content: bytes, message: str) -> None:
    path.write_bytes(content)
    with pytest.raises(CogmapError, match=message):
        Ledger(path)
    assert path.read_bytes() == content


def test_a_row_that_cannot_be_used_is_refused_with_its_line(path: Path) -> None:
    filled(path)

    def read(row: object) -> object:
        if row == {"row": 1}:
            raise CogmapError("row has no seed")
        return row

    with Ledger(path) as ledger, pytest.raises(CogmapError, match=r"cells\.jsonl, line 3: row has no seed"):
        ledger.begin(read, **SETTINGS)


def test_what_cannot_be_written_is_refused_before_anything_runs(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for bad in (tmp_path, Path("/dev/null"), tmp_path / "pipe"):
        with pytest.raises(CogmapError, match="it is a folder or a device"):
            Ledger(bad)
    with pytest.raises(CogmapError, match=r"cannot write .*No such file or directory\); choose another file"):
        Ledger(tmp_path / "no" / "cells.jsonl")


def test_a_full_disk_is_one_line_and_harms_no_row(path: Path) -> None:
    resource = pytest.importorskip("resource")
    with Ledger(path) as ledger:
        ledger.begin(dict, **SETTINGS)
        ledger.append({"row": 0})
        before = path.read_bytes()
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        for room in (0, 5):
            resource.setrlimit(resource.RLIMIT_FSIZE, (len(before) + room, limits[1]))
            try:
                with pytest.raises(CogmapError, match=r"cannot write .*rows are kept, make room and go on"):
                    ledger.append({"row": 1})
            finally:
                resource.setrlimit(resource.RLIMIT_FSIZE, limits)
            assert path.read_bytes() == before
        ledger.append({"row": 1})
    assert begun(path) == [{"row": 0}, {"row": 1}]


def test_one_process_at_a_time(path: Path) -> None:
    pytest.importorskip("fcntl")
    with Ledger(path), pytest.raises(CogmapError, match="is in use by another run; wait for its end"):
        Ledger(path)
    Ledger(path).close()


def test_where_there_are_no_locks_it_goes_without(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fcntl = pytest.importorskip("fcntl")

    def unsupported(*_: object) -> None:
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(fcntl, "flock", unsupported)
    assert begun(path) == []
    monkeypatch.setitem(__import__("sys").modules, "fcntl", None)
    assert begun(path) == []


def test_a_ledger_is_written_between_begin_and_close(path: Path) -> None:
    ledger = Ledger(path)
    with pytest.raises(CogmapError, match="call begin first"):
        ledger.append({})
    ledger.begin(dict, **SETTINGS)
    ledger.close()
    with pytest.raises(CogmapError, match="is closed"):
        ledger.append({})
