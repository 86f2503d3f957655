"""Files that are written whole or not at all."""

import os
import re
import stat
from collections.abc import Callable
from contextlib import suppress
from itertools import count
from pathlib import Path
from secrets import token_hex

from .errors import CogmapError

try:
    import fcntl
except ImportError:  # a system without locks
    fcntl = None

_TEMPORARY = re.compile(r"\..*\.cogmap-[0-9a-f]{16}(\.[^.]*)?", re.S)
"""Names of files that are being written, or were when their process was killed."""


def write_whole(path: Path, content: bytes, *, new: bool = False) -> Path:
    """Replace the file at once, and return its path. See `write_through`.

    Raises:
        CogmapError: it cannot be written; what was there before still is.
    """
    return write_through(path, lambda target: target.write_bytes(content), new=new)


def write_through(path: Path, write: Callable[[Path], object], *, new: bool = False) -> Path:
    """Let `write` fill a temporary file beside `path`, then put it in place of `path`.

    A file that is there keeps its mode and owner, a link its target; a new one is as the umask has it. What it holds
    is on the disk when this returns. What a killed process has left in the folder is swept.

    Args:
        path: where it goes.
        write: fills the file at the path that it is given.
        new: replace nothing, for a file that nobody named: where something is there the first of NAME-2, NAME-3, …
            that is not is taken.

    Returns:
        Where it is now.

    Raises:
        CogmapError: it cannot be written, or is no regular file; what was there before still is.
    """
    target = Path(os.path.realpath(path))  # a link stays a link
    temporary, handle = _beside(target), -1
    try:
        old = None if new else check_writable(path)
        handle = _opened(temporary, 0o666 if old is None else 0o600)
        write(temporary)
        if old is not None:
            _make_like(handle, old, path)
        os.fsync(handle)
        if new:
            path = _named(temporary, path)
        else:
            os.replace(temporary, target)
        _sync_folder(target.parent)
        _sweep(target.parent)
    except OSError as error:
        raise CogmapError(f"cannot write {path} ({error.strerror or error}); choose another file") from error
    finally:
        with suppress(OSError):  # where it has taken its place there is none
            temporary.unlink()
        if handle >= 0:
            os.close(handle)
    return path


def unused(path: Path) -> Path:
    """The path, or the first of NAME-2, NAME-3, … that does not exist."""
    names = (path.with_stem(f"{path.stem}-{number}") for number in count(2))
    return path if not os.path.lexists(path) else next(name for name in names if not os.path.lexists(name))


def check_writable(path: Path) -> os.stat_result | None:
    """The file at a path, if it may be replaced; None if there is no file.

    Raises:
        CogmapError: it is a folder, a device, a pipe, or read-only.
        OSError: nobody can tell.
    """
    try:
        old = os.stat(path)
    except FileNotFoundError:
        return None
    if not stat.S_ISREG(old.st_mode):
        raise CogmapError(f"cannot write {path}: it is a folder or a device, no regular file; choose another file")
    if not (old.st_mode & 0o222 and os.access(path, os.W_OK)):  # root may write to any, but is asked not to
        raise CogmapError(f"cannot write {path}: it is read-only; choose another file")
    return old


def check_folder(path: Path) -> None:
    """Check that a file can be created at `path`. Raises OSError if not."""
    probe = _beside(Path(os.path.realpath(path)))
    try:
        os.close(_opened(probe, 0o600))
    finally:
        probe.unlink(missing_ok=True)


def make_folder(folder: Path) -> Path:
    """The folder; it is created if it is missing. Raises CogmapError if it cannot be created."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CogmapError(f"cannot make folder {folder} ({error.strerror or error}); choose another") from error
    return folder


def _beside(target: Path) -> Path:
    stem = os.fsencode(target.stem)[:80].decode(errors="ignore")  # a name has 255 bytes at most
    return target.with_name(f".{stem}.cogmap-{token_hex(8)}{target.suffix}")


def _opened(temporary: Path, mode: int) -> int:
    """A new file, locked as long as it is open, so that nobody sweeps it."""
    while True:
        handle = os.open(temporary, os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_CLOEXEC", 0), mode)
        if fcntl is None or _locked(handle, wait=True):
            with suppress(FileNotFoundError):
                if fcntl is None or os.path.samestat(os.fstat(handle), os.stat(temporary)):
                    return handle
        os.close(handle)  # it was swept before it was locked


def _locked(handle: int, *, wait: bool) -> bool:
    assert fcntl is not None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:
        return wait  # a file system without locks: nothing is swept there
    return True


def _named(temporary: Path, path: Path) -> Path:
    """Give the file the first free name, also where others are looking for one."""
    while True:
        free = unused(path)
        try:
            os.link(temporary, free)
        except FileExistsError:
            continue
        except OSError:  # a file system without links
            os.rename(temporary, free)
        return free


def _make_like(handle: int, old: os.stat_result, path: Path) -> None:
    """Give a new file owner and mode of that which it replaces."""
    new = os.fstat(handle)
    if (new.st_uid, new.st_gid) != (old.st_uid, old.st_gid):
        try:
            os.fchown(handle, old.st_uid, old.st_gid)
        except OSError as error:
            raise CogmapError(f"cannot write {path}: its owner or group is another; choose another file") from error
    os.fchmod(handle, stat.S_IMODE(old.st_mode) & 0o777)


def _sync_folder(folder: Path) -> None:
    with suppress(OSError):  # a folder that may not be read, or a system where none can be opened
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _sweep(folder: Path) -> None:
    """Remove what processes that were killed have left; the files of those that live are locked."""
    if fcntl is None:
        return
    with suppress(OSError):
        for name in os.listdir(folder):
            if name.startswith(".") and _TEMPORARY.fullmatch(name):
                _remove_left(folder / name)


def _remove_left(temporary: Path) -> None:
    with suppress(OSError):
        handle = os.open(temporary, os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW)
        try:
            if stat.S_ISREG(os.fstat(handle).st_mode) and _locked(handle, wait=False):
                temporary.unlink()
        finally:
            os.close(handle)
