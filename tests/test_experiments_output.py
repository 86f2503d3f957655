from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from cogmap.experiments import check_outputs, write_json
from cogmap.model import CogmapError, write_whole


def test_json_is_written_whole(tmp_path: Path) -> None:
    path = tmp_path / "runs.json"
    path.write_text("old")
    write_json(path, {"a": [1, None]})
    assert json.loads(path.read_text()) == {"a": [1, None]}
    assert os.listdir(tmp_path) == ["runs.json"]


def test_nothing_is_left_of_a_write_that_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "runs.json"
    path.write_text("old")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(CogmapError, match="No space left"):
        write_whole(path, b"new")
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["runs.json"]


def test_an_interrupt_leaves_nothing_either(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_whole(tmp_path / "new.json", b"new")
    assert os.listdir(tmp_path) == []


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real.json").write_text("old")
    (tmp_path / "link.json").symlink_to("real.json")
    write_whole(tmp_path / "link.json", b"new")
    assert (tmp_path / "link.json").is_symlink()
    assert (tmp_path / "real.json").read_text() == "new"


def test_nan_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_json(tmp_path / "x.json", float("nan"))


def test_outputs_that_can_be_written_are_not_touched(tmp_path: Path) -> None:
    (tmp_path / "old.json").write_text("old")
    check_outputs([None, tmp_path / "old.json", tmp_path / "new.png"])
    assert sorted(os.listdir(tmp_path)) == ["old.json"]
    assert (tmp_path / "old.json").read_text() == "old"


@pytest.mark.parametrize("path", [".", "missing/x.json", "/dev/null", "/proc/x.json", "a" * 300])
def test_outputs_that_cannot_be_written(tmp_path: Path, path: str) -> None:
    with pytest.raises(CogmapError, match="cannot write"):
        check_outputs([tmp_path / path])


def test_two_outputs_need_two_files(tmp_path: Path) -> None:
    with pytest.raises(CogmapError, match="two outputs"):
        check_outputs([tmp_path / "x", tmp_path / "." / "x"])


def test_what_is_read_is_not_written(tmp_path: Path) -> None:
    (tmp_path / "in.txt").write_text("0 1")
    (tmp_path / "link.txt").symlink_to("in.txt")
    for path in ("in.txt", "link.txt"):
        with pytest.raises(CogmapError, match=r"\.txt is the file that is read; write to another"):
            check_outputs([tmp_path / path], inputs=[tmp_path / "in.txt"])
    check_outputs([tmp_path / "3x3"], inputs=["3x3"])


@pytest.mark.parametrize("path", ["x", "x.bmp", ".png"])
def test_pictures_have_a_known_format(path: str, tmp_path: Path) -> None:
    check_outputs([], picture=Path("x.PNG"))
    with pytest.raises(CogmapError, match="picture suffix"):
        check_outputs([], picture=Path(path))
