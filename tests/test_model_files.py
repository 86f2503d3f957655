"""Files are replaced whole, keep their mode, and nothing else on the machine is touched."""

from __future__ import annotations

import os
import signal
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from cogmap.experiments import check_outputs, file_named
from cogmap.model import CogmapError, unused, write_through, write_whole


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o664, 0o444 | 0o200])
def test_a_file_keeps_its_mode(mode: int, tmp_path: Path) -> None:
    path = tmp_path / "map.npz"
    path.write_text("old")
    path.chmod(mode)
    write_whole(path, b"new")
    assert (path.read_bytes(), stat.S_IMODE(path.stat().st_mode)) == (b"new", mode)


@pytest.mark.parametrize(("mask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0o002, 0o664)])
def test_a_new_file_is_as_the_umask_has_it(mask: int, mode: int, tmp_path: Path) -> None:
    before = os.umask(mask)
    try:
        write_whole(tmp_path / "new", b"new")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "new").stat().st_mode) == mode


def test_a_private_file_is_private_while_it_is_written(tmp_path: Path) -> None:
    path, modes = tmp_path / "map.npz", list[int]()
    path.write_text("old")
    path.chmod(0o600)
    write_through(path, lambda beside: modes.append(stat.S_IMODE(beside.stat().st_mode)))
    assert modes == [0o600]


def test_a_link_gives_its_target_what_is_new_and_its_mode(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    real, link = tmp_path / "there" / "real.json", tmp_path / "link.json"
    real.write_text("old")
    real.chmod(0o640)
    link.symlink_to(real)
    write_whole(link, b"new")
    assert link.is_symlink()
    assert (real.read_text(), stat.S_IMODE(real.stat().st_mode)) == ("new", 0o640)
    assert os.listdir(tmp_path / "there") == ["real.json"]


@pytest.mark.skipif(os.name == "nt" or os.geteuid() != 0, reason="only root may give files away")
def test_a_file_of_another_stays_theirs(tmp_path: Path) -> None:
    path = tmp_path / "theirs"
    path.write_text("old")
    os.chown(path, 4321, 1234)
    write_whole(path, b"new")
    assert (path.stat().st_uid, path.stat().st_gid) == (4321, 1234)


def test_an_owner_that_cannot_be_kept_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, real = tmp_path / "theirs", os.fstat
    path.write_text("old")

    def other(handle: int) -> os.stat_result:
        values = list(real(handle))
        values[4] += 1
        return os.stat_result(values)

    def forbidden(*_: int) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr("cogmap.model.files._opened", lambda path, mode: os.open(path, os.O_RDWR | os.O_CREAT, mode))
    monkeypatch.setattr(os, "fstat", other)
    monkeypatch.setattr(os, "fchown", forbidden)
    with pytest.raises(CogmapError, match="owner or group is another"):
        write_whole(path, b"new")
    monkeypatch.undo()
    assert (path.read_text(), os.listdir(tmp_path)) == ("old", ["theirs"])


@pytest.mark.parametrize("kind", ["fifo", "device", "folder", "link to a fifo"])
def test_only_regular_files_are_replaced(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "node"
    if kind == "folder":
        path.mkdir()
    elif kind == "device":
        path = Path("/dev/null")
    else:
        os.mkfifo(path)
    if kind.startswith("link"):
        path.rename(tmp_path / "fifo")
        path.symlink_to(tmp_path / "fifo")
    before = os.stat(path)
    for attempt in (lambda: write_whole(path, b"new"), lambda: check_outputs([path])):
        with pytest.raises(CogmapError, match=r"cannot write .*no regular file; choose another file$"):
            attempt()
    assert stat.S_IFMT(os.stat(path).st_mode) == stat.S_IFMT(before.st_mode)
    assert not [name for name in os.listdir(tmp_path) if "cogmap-" in name]


def test_a_read_only_file_is_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "map.npz"
    path.write_text("old")
    path.chmod(0o444)
    for attempt in (lambda: write_whole(path, b"new"), lambda: check_outputs([path])):
        with pytest.raises(CogmapError, match="it is read-only; choose another file"):
            attempt()
    assert path.read_text() == "old"


def test_what_was_not_named_replaces_nothing(tmp_path: Path) -> None:
    path = tmp_path / "maze.png"
    path.write_text("mine")
    assert unused(path) == tmp_path / "maze-2.png"
    (tmp_path / "maze-2.png").symlink_to(tmp_path / "nowhere")  # is there, though it leads nowhere
    assert write_whole(path, b"new", new=True) == tmp_path / "maze-3.png"
    assert path.read_text() == "mine"
    assert sorted(os.listdir(tmp_path)) == ["maze-2.png", "maze-3.png", "maze.png"]


def test_names_that_are_taken_at_the_same_time(tmp_path: Path) -> None:
    made = list[Path]()
    jobs = [
        threading.Thread(target=lambda at=at: made.append(write_whole(tmp_path / "a", bytes([at]), new=True)))
        for at in range(8)
    ]
    for job in jobs:
        job.start()
    for job in jobs:
        job.join()
    assert len(set(made)) == 8
    assert sorted(path.read_bytes() for path in made) == [bytes([at]) for at in range(8)]


@pytest.mark.parametrize("name", ["../../etc/x", "a/b", "..", "", "\x1b[31mred", "\udcff", "x" * 500, ".hidden"])
def test_a_name_in_a_file_leads_nowhere(name: str) -> None:
    path = file_named(name, ".png")
    assert path.parent == Path()
    assert path.name.isprintable()
    assert not path.name.startswith(".")
    assert len(path.name) < 100
    assert file_named("4x4_alias", ".png") == Path("4x4_alias.png")


def test_a_hard_link_to_what_is_read_is_not_written(tmp_path: Path) -> None:
    (tmp_path / "in.txt").write_text("0 1")
    os.link(tmp_path / "in.txt", tmp_path / "same.txt")
    with pytest.raises(CogmapError, match=r"same\.txt is the file that is read"):
        check_outputs([tmp_path / "same.txt"], inputs=[tmp_path / "in.txt"])


WRITER = """
import sys, time
from pathlib import Path
sys.path[:0] = {path!r}
from cogmap.model import write_through
def write(target):
    target.write_bytes(b"half")
    print("there", flush=True)
    time.sleep(60)
write_through(Path(sys.argv[1]), write)
"""


def test_what_a_killed_process_left_is_swept_and_no_living_ones(tmp_path: Path) -> None:
    path, program = tmp_path / "map.npz", WRITER.format(path=sys.path)
    path.write_text("old")
    (tmp_path / ".mine.cogmap-notes").write_text("not ours")
    command = [sys.executable, "-c", program, str(path)]
    dead, alive = (subprocess.Popen(command, stdout=subprocess.PIPE) for _ in range(2))
    try:
        for process in (dead, alive):
            assert process.stdout is not None
            process.stdout.readline()
        dead.send_signal(signal.SIGKILL)
        dead.wait()
        assert len(os.listdir(tmp_path)) == 4
        assert path.read_text() == "old"
        write_whole(tmp_path / "other.json", b"{}")
        left = [name for name in os.listdir(tmp_path) if name.startswith(".map.cogmap-")]
        assert len(left) == 1
    finally:
        for process in (dead, alive):
            process.kill()
            process.communicate()
    write_whole(path, b"new")
    assert sorted(os.listdir(tmp_path)) == [".mine.cogmap-notes", "map.npz", "other.json"]


def test_file_and_folder_are_on_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    synced, real = list[str](), os.fsync

    def watch(handle: int) -> None:
        synced.append("folder" if stat.S_ISDIR(os.fstat(handle).st_mode) else "file")
        real(handle)

    monkeypatch.setattr(os, "fsync", watch)
    write_whole(tmp_path / "a", b"a")
    assert synced == ["file", "folder"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no full disk here")
def test_a_full_disk_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_text("old")

    def write(target: Path) -> None:
        with Path("/dev/full").open("wb", buffering=0) as full:
            full.write(b"x")

    with pytest.raises(CogmapError, match="No space left on device"):
        write_through(path, write)
    assert (path.read_text(), os.listdir(tmp_path)) == ("old", ["a"])
