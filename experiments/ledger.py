"""A file that keeps finished rows, so that what was interrupted goes on where it was."""

import json
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, suppress
from io import FileIO
from pathlib import Path
from typing import Any, TypeVar, cast

from ..model import CogmapError, check_size, parse_json

LARGEST = 256 * 2**20  # bytes of the largest file of rows that is read

SCHEMA, VERSION = "cogmap.cells", 1
_BEGINNING = f'{{"schema": "{SCHEMA}"'.encode()
_Row = dict[str, Any]
_Read = TypeVar("_Read")


class Ledger(AbstractContextManager["Ledger"]):
    """Rows in a file of JSON lines, after a header line that says what they were made with.

    Each row is on the disk before `append` returns, written at once behind those before it: whatever ends the
    process, no earlier row is harmed. Only one process at a time may have the file open.

    Args:
        path: the file, made if it is missing.

    Raises:
        CogmapError: it cannot be written, another process has it open, or something else is in it.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        self._file = _opened(self.path)
        try:
            self._header, self._rows, self._end = _read(self._file, self.path)
        except BaseException:
            self.close()
            raise

    @property
    def rows(self) -> list[_Row]:
        """The rows in the file, the oldest first."""
        return list(self._rows)

    def begin(self, read: Callable[[_Row], _Read], **made_with: Any) -> list[_Read]:
        """Go on with what is there, its torn last line cut off, or write the header of a new file.

        Args:
            read: makes something of a row; what it made of the rows is returned, the oldest first.
            made_with: plain JSON values on which rows depend: settings and versions, by name.

        Raises:
            CogmapError: the rows there were made with something else, or `read` refuses one.
        """
        here: _Row = {"schema": SCHEMA, "version": VERSION, **json.loads(json.dumps(made_with))}
        if self._header is not None:
            old, new = dict(_leaves(self._header)), dict(_leaves(here))
            for name in {**new, **old}:
                there, wanted = (json.dumps(leaves.get(name, "nothing")) for leaves in (old, new))
                if there != wanted:
                    made = f"{self.path} was made with {name} = {there}, this run has {wanted}"
                    raise CogmapError(f"{made}; give another file, or remove it")
        os.ftruncate(self._file.fileno(), self._end)
        if self._header is None:
            self._header = here
            self._write(here)
        return [self._made(read, number, row) for number, row in enumerate(self._rows, start=2)]

    def append(self, row: Mapping[str, Any]) -> None:
        """Write a row, plain JSON values; it is on the disk when this returns.

        Raises:
            CogmapError: it could not be written, or `begin` was not called; the rows before it are whole.
        """
        if self._header is None:
            raise CogmapError(f"ledger {self.path} has no header; call begin first")
        self._write(row)
        self._rows.append(dict(row))

    def close(self) -> None:
        """Let others open it; nothing can be written any more."""
        self._file.close()

    def __exit__(self, *error: object) -> None:
        self.close()

    def _made(self, read: Callable[[_Row], _Read], number: int, row: _Row) -> _Read:
        try:
            return read(row)
        except CogmapError as error:
            raise CogmapError(f"{self.path}, line {number}: {error}") from error

    def _write(self, row: Mapping[str, Any]) -> None:
        if self._file.closed:
            raise CogmapError(f"ledger {self.path} is closed; open it again")
        line = json.dumps(row, allow_nan=False).encode() + b"\n"
        try:
            if self._file.write(line) != len(line):
                raise OSError("the disk is full")
            os.fsync(self._file.fileno())
        except OSError as error:
            with suppress(OSError):
                os.ftruncate(self._file.fileno(), self._end)
            why = f"cannot write {self.path} ({error.strerror or error})"
            raise CogmapError(f"{why}; its finished rows are kept, make room and go on") from error
        self._end += len(line)


def _opened(path: Path) -> FileIO:
    """The file, to be read and written behind what is there; others are kept out where there are locks."""
    try:
        if path.exists() and not path.is_file():
            raise CogmapError(f"cannot write {path}: it is a folder or a device; give a file")
        file = path.open("ab+", buffering=0)
    except OSError as error:
        raise CogmapError(f"cannot write {path} ({error.strerror or error}); choose another file") from error
    try:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        file.close()
        raise CogmapError(f"{path} is in use by another run; wait for its end, or give another file") from error
    except (ImportError, OSError):  # a system or a file system without locks
        pass
    return file


def _read(file: FileIO, path: Path) -> tuple[_Row | None, list[_Row], int]:
    """Header (None of an empty file), rows, and how many bytes are whole lines: the last one may be torn."""
    check_size(path, file.seek(0, os.SEEK_END), LARGEST)
    file.seek(0)
    lines = file.readall().splitlines(keepends=True)
    torn = len(lines) == 1 and not lines[0].endswith(b"\n")
    if not lines or (torn and (lines[0].startswith(_BEGINNING) or _BEGINNING.startswith(lines[0]))):
        return None, [], 0
    header, *rows = map(_parsed, lines)
    if header is None or header.get("schema") != SCHEMA:
        raise CogmapError(
            f"{path} keeps no runs of cogmap (its first line names no schema {SCHEMA}); give another file"
        )
    if header.get("version") != VERSION:
        other = f"{path} has version {header.get('version')} of the schema {SCHEMA}"
        raise CogmapError(f"{other}, this cogmap writes {VERSION}; give another file")
    if rows and rows[-1] is None:
        del rows[-1], lines[-1]
    if None in rows:
        number = rows.index(None) + 2
        raise CogmapError(f"{path}, line {number}: unreadable; remove this line, its run is made again")
    return header, cast(list[_Row], rows), sum(map(len, lines))


def _parsed(line: bytes) -> _Row | None:
    """The object in a whole line; None if there is none."""
    try:
        value: Any = parse_json(line) if line.endswith(b"\n") else None
    except ValueError:
        return None
    return cast(_Row, value) if isinstance(value, dict) else None


def _leaves(values: _Row, above: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in values.items():
        nested = isinstance(value, dict)
        yield from _leaves(cast(_Row, value), f"{above}{name}.") if nested else [(f"{above}{name}", value)]
