"""Agents in npz files: arrays, and a JSON header with a schema version; no pickle."""

import json
import struct
import zipfile
import zlib
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from importlib.metadata import PackageNotFoundError, version
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model import CogmapError, open_regular, parse_json, write_through
from .members import Members
from .parts import MissingPart
from .schema_2 import from_schema_2
from .schema_3 import from_schema_3

SCHEMA, OLDEST = 4, 2  # version of the layout of the file, and the oldest that can be read

FORMAT = "cogmap agent"

_UPDATES = {2: from_schema_2, 3: from_schema_3}  # what reads earlier versions as if they were written now

_BROKEN = (OSError, EOFError, RuntimeError, struct.error, zipfile.BadZipFile, zlib.error)
"""What reading raises where a file is none; deep nesting is a `RuntimeError` too."""

_WRONG = (AssertionError, AttributeError, ArithmeticError, LookupError, MemoryError, TypeError, ValueError)
"""What making an agent of it raises where something in it is wrong."""


def write(path: str | PathLike[str], header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> None:
    """Write an agent's state; the file is replaced whole, or not at all.

    Raises:
        CogmapError: a label or a setting cannot be written, or the folder cannot be.
    """
    header = {"format": FORMAT, "schema": SCHEMA, "version": _version(), **header}
    packed = np.frombuffer(_json(header).encode(), dtype=np.uint8)

    def fill(target: Path) -> None:
        with target.open("wb") as file:
            np.savez(file, header=packed, **arrays)  # pyright: ignore[reportArgumentType]

    write_through(Path(path), fill)


@contextmanager
def reading(path: str | PathLike[str]) -> Generator[tuple[dict[str, Any], Mapping[str, NDArray[Any]]]]:
    """Header and arrays of the file, in the present schema; each array is read when it is asked for.

    What goes wrong within means that the file is damaged, and so does an array that nobody has asked for in the end.

    Raises:
        CogmapError: no such file, no saved agent, too large, truncated, or written by a newer version.
    """
    with _members(Path(path)) as members, damage(path):
        header = _header(Path(path), members)
        yield _UPDATES[header["schema"]](header, members) if header["schema"] in _UPDATES else (header, members)
        if unknown := members.unread:
            raise ValueError(f"it has an array {unknown[0][:80]!r} that no agent has")


@contextmanager
def damage(path: str | PathLike[str]) -> Generator[None]:
    """What goes wrong within means that the file is damaged."""
    try:
        yield
    except MissingPart:
        raise
    except (*_BROKEN, *_WRONG) as error:
        if isinstance(error, CogmapError) and str(error).startswith(f"load: {path}"):
            raise
        why = " ".join(f"{type(error).__name__}: {error}".split())[:300]
        raise CogmapError(f"load: {path} is damaged ({why}); save the agent again") from error


def read_header(path: str | PathLike[str]) -> dict[str, Any]:
    """The header of a saved file, without its arrays: `schema`, `version` of cogmap (if there), `settings`, ...

    Raises:
        CogmapError: no such file, no saved agent, truncated, or of another schema.
    """
    with _members(Path(path)) as members:
        return _header(Path(path), members)


def _version() -> str | None:
    try:
        return version("cogmap")
    except PackageNotFoundError:
        return None


def _json(header: dict[str, Any]) -> str:
    try:
        return json.dumps(header, allow_nan=False, default=_plain)
    except (TypeError, ValueError) as error:
        raise CogmapError(f"save: {error}; give labels, goals and settings as plain finite values") from error


def _plain(value: object) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"cannot write {value!r} of type {type(value).__name__}")


@contextmanager
def _members(path: Path) -> Generator[Members]:
    try:
        raw = open_regular(path)
    except FileNotFoundError as error:
        raise CogmapError(f"load: there is no file {path}; give a file that save wrote") from error
    except (OSError, CogmapError) as error:
        raise CogmapError(f"load: {path} is no saved agent ({error}); give a file that save wrote") from error
    with raw:
        if raw.read(6) == b"\x93NUMPY":
            raise CogmapError(f"load: {path} is no saved agent but a single array; give a file that save wrote")
        try:
            members = Members(raw)
        except (*_BROKEN, ValueError) as error:
            why = f"no saved agent, or truncated ({' '.join(str(error).split())[:200]})"
            raise CogmapError(f"load: {path} is {why}; give a file that save wrote") from error
        yield members


def _header(path: Path, members: Members) -> dict[str, Any]:
    try:
        header: dict[str, Any] = parse_json(members["header"].tobytes())
        schema = int(header["schema"]) if header["format"] == FORMAT else -1
    except (*_BROKEN, KeyError, OverflowError, TypeError, ValueError) as error:
        why = " ".join(str(error).split())[:200]
        raise CogmapError(f"load: {path} is no saved agent (no header: {why}); give a file that save wrote") from error
    if schema < 0:
        kind = f"{header['format']!r}"[:80]
        raise CogmapError(f"load: {path} is a {kind}, no saved agent; give a file that save wrote")
    if schema < OLDEST:
        raise CogmapError(f"load: {path} has schema {schema}, older than {OLDEST}; explore and save again")
    if schema > SCHEMA:
        raise CogmapError(f"load: {path} has schema {schema}, newer than {SCHEMA}; update cogmap to read it")
    return header
