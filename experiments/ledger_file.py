"""The file of a ledger: opened for one process alone, and read."""

from __future__ import annotations

import json
import os
import stat
from pathlib import Path
from typing import Any, cast

from ..model.errors import CogmapError

SCHEMA = "cogmap.cells"
VERSION = 1
_BEGINNING = f'{{"schema": "{SCHEMA}"'.encode()

Rows = list[tuple[int, dict[str, Any]]]
"""With the numbers of their lines."""


def open_file(path: Path) -> int:
    """A descriptor that writes behind what is there; the file is made if it is missing.

    Raises:
        CogmapError: it cannot be written, or is no regular file.
    """
    try:
        if path.exists() and not path.is_file():
            raise CogmapError(f"cannot write {path}: it is a folder or a device; give a file")
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o644)
        if not stat.S_ISREG(os.fstat(file).st_mode):  # another has just put it there
            os.close(file)
            raise CogmapError(f"cannot write {path}: it is no regular file; give another")
    except OSError as error:
        raise CogmapError(f"cannot write {path} ({error.strerror or error}); choose another file") from error
    return file


def lock(file: int, path: Path) -> None:
    """Keep others out until the descriptor is closed; where there are no locks, go without.

    Raises:
        CogmapError: another has it.
    """
    try:
        import fcntl
    except ImportError:
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        raise CogmapError(f"{path} is in use by another run; wait for its end, or give another file") from error
    except OSError:  # a file system without locks
        return


def read_lines(file: int, path: Path) -> tuple[dict[str, Any] | None, Rows, int | None]:
    """Header (None of an empty file), rows, and the byte from which on the last line is torn, if it is.

    A torn line was being written when its process was killed.

    Raises:
        CogmapError: it is another kind of file, of another version, or a line before the last is no row.
    """
    with os.fdopen(os.dup(file), "rb") as source:
        source.seek(0)
        lines = source.read().splitlines(keepends=True)
    if not lines:
        return None, [], None
    if len(lines) == 1 and _torn_header(lines[0]):
        return None, [], 0
    header, rows, end = _checked_header(lines[0], path), Rows(), len(lines[0])
    for number, line in enumerate(lines[1:], start=2):
        row = _parsed(line)
        if row is None:
            if number == len(lines):
                return header, rows, end
            raise CogmapError(f"{path}, line {number}: unreadable; remove this line, its run is made again")
        rows.append((number, row))
        end += len(line)
    return header, rows, None


def _torn_header(line: bytes) -> bool:
    return not line.endswith(b"\n") and (line.startswith(_BEGINNING) or _BEGINNING.startswith(line))


def _checked_header(line: bytes, path: Path) -> dict[str, Any]:
    header = _parsed(line)
    if header is None or header.get("schema") != SCHEMA:
        raise CogmapError(
            f"{path} keeps no runs of cogmap (its first line names no schema {SCHEMA}); give another file"
        )
    if header.get("version") != VERSION:
        raise CogmapError(
            f"{path} has version {header.get('version')} of the schema {SCHEMA}, this cogmap writes {VERSION}; "
            "give another file"
        )
    return header


def _parsed(line: bytes) -> dict[str, Any] | None:
    """The object in a whole line; None if there is none."""
    try:
        value: Any = json.loads(line) if line.endswith(b"\n") else None
    except ValueError:
        return None
    return cast(dict[str, Any], value) if isinstance(value, dict) else None
