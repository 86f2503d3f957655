"""Files that are written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

from .errors import CogmapError


def write_whole(path: Path, content: bytes) -> Path:
    """Replace the file at once; answers with its path.

    Raises:
        CogmapError: it cannot be written; what was there before still is.
    """
    return write_through(path, lambda target: target.write_bytes(content))


def write_through(path: Path, write: Callable[[Path], object]) -> Path:
    """Let `write` fill a file of the same suffix beside `path`, and put it in its place when that is done.

    Raises:
        CogmapError: it cannot be written; what was there before still is.
    """
    target = Path(os.path.realpath(path))  # a link stays a link
    temporary: Path | None = None
    try:
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.stem[:80]}.", suffix=target.suffix)
        os.close(handle)
        temporary = Path(name)
        write(temporary)
        temporary.chmod(0o644)  # mkstemp lets nobody else read
        temporary.replace(target)
    except BaseException as error:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise CogmapError(f"cannot write {path} ({error.strerror or error}); choose another file") from error
        raise
    return path


def make_folder(folder: Path) -> Path:
    """The folder, made where it is missing.

    Raises:
        CogmapError: it cannot be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CogmapError(f"cannot make folder {folder} ({error.strerror or error}); choose another") from error
    return folder
