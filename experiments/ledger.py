"""A file that keeps finished rows, so that what was interrupted goes on where it was."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TypeVar, cast

from ..model.errors import CogmapError
from .ledger_file import SCHEMA, VERSION, lock, open_file, read_lines

_UNSET = "nothing"
Read = TypeVar("Read")


class Ledger:
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
        self._file = open_file(self.path)
        try:
            lock(self._file, self.path)
            self._header, self._rows, self._torn_from = read_lines(self._file, self.path)
        except BaseException:
            self.close()
            raise

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The rows in the file, the oldest first."""
        return [row for _, row in self._rows]

    def begin(self, read: Callable[[Mapping[str, Any]], Read], **made_with: Any) -> list[Read]:
        """Go on with what is there, its torn last line cut off, or write the header of a new file.

        Args:
            read: makes something of a row.
            made_with: plain JSON values on which rows depend: settings and versions, by name.

        Returns:
            What `read` made of the rows, the oldest first.

        Raises:
            CogmapError: the rows there were made with something else, or `read` refuses one.
        """
        here = json.loads(json.dumps(made_with))
        if self._header is not None and (other := _difference(self._header, here)):
            name, there, wanted = other
            raise CogmapError(
                f"{self.path} was made with {name} = {json.dumps(there)}, this run has {json.dumps(wanted)}; "
                "give another file, or remove it"
            )
        if self._torn_from is not None:
            os.ftruncate(self._file, self._torn_from)
            self._torn_from = None
        if self._header is None:
            self._write({"schema": SCHEMA, "version": VERSION, **here})
            self._header = here
        return [self._read(read, number, row) for number, row in self._rows]

    def append(self, row: Mapping[str, Any]) -> None:
        """Write a row, plain JSON values; it is on the disk when this returns.

        Raises:
            CogmapError: it could not be written, or `begin` was not called; the rows before it are whole.
        """
        if self._header is None:
            raise CogmapError(f"ledger {self.path} has no header; call begin first")
        self._write(row)
        self._rows.append((len(self._rows) + 2, dict(row)))

    def close(self) -> None:
        """Let others open it; nothing can be written any more."""
        file, self._file = self._file, -1
        if file >= 0:
            os.close(file)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def __del__(self) -> None:
        if getattr(self, "_file", -1) >= 0:
            self.close()

    def _read(self, read: Callable[[Mapping[str, Any]], Read], number: int, row: Mapping[str, Any]) -> Read:
        try:
            return read(row)
        except CogmapError as error:
            raise CogmapError(f"{self.path}, line {number}: {error}") from error

    def _write(self, row: Mapping[str, Any]) -> None:
        if self._file < 0:
            raise CogmapError(f"ledger {self.path} is closed; open it again")
        line = json.dumps(row, allow_nan=False).encode() + b"\n"
        before = os.fstat(self._file).st_size
        try:
            if os.write(self._file, line) < len(line):
                raise OSError("the disk is full")
            os.fsync(self._file)
        except OSError as error:
            with suppress(OSError):
                os.ftruncate(self._file, before)
            raise CogmapError(
                f"cannot write {self.path} ({error.strerror or error}); its finished rows are kept, make room and go on"
            ) from error


def _difference(there: Mapping[str, Any], here: Mapping[str, Any]) -> tuple[str, Any, Any] | None:
    """The first name with another value: its path, and both."""
    old, new = dict(_leaves(there)), dict(_leaves(here))
    for name in {**new, **old}:
        was, is_now = old.get(name, _UNSET), new.get(name, _UNSET)
        if was != is_now and name not in ("schema", "version"):
            return name, was, is_now
    return None


def _leaves(values: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, dict):
            yield from _leaves(cast(dict[str, Any], value), f"{above}{name}.")
        else:
            yield f"{above}{name}", value
