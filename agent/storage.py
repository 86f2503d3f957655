"""Agents in npz files: arrays, and a JSON header with a schema version; no pickle."""

from __future__ import annotations

import json
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Generator
from contextlib import contextmanager
from importlib.metadata import PackageNotFoundError, version
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model import CogmapError, write_through
from .parts import MissingPart
from .schema_2 import from_schema_2
from .schema_3 import from_schema_3

SCHEMA, OLDEST = 4, 2
"""Version of the layout of the file, and the oldest that can be read."""

FORMAT = "cogmap agent"


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


def read(path: str | PathLike[str]) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Header and arrays of the file, in the present schema.

    Raises:
        CogmapError: no such file, no saved agent, truncated, or written by a newer version.
    """
    arrays = _read(Path(path))
    header = _header(Path(path), arrays)
    with damage(path):
        if header["schema"] == 2:
            return from_schema_2(header, arrays)
        if header["schema"] == 3:
            return from_schema_3(header), arrays
    return header, arrays


@contextmanager
def damage(path: str | PathLike[str]) -> Generator[None]:
    """What goes wrong within means that the file is damaged."""
    try:
        yield
    except MissingPart:
        raise
    except (AssertionError, AttributeError, ArithmeticError, LookupError, TypeError, ValueError) as error:
        raise CogmapError(f"load: {path} is damaged ({type(error).__name__}: {error}); save the agent again") from error


def read_header(path: str | PathLike[str]) -> dict[str, Any]:
    """What the file says of itself besides its arrays: `schema`, `version` of cogmap (if it says so), `settings`, ...

    Raises:
        CogmapError: no such file, no saved agent, truncated, or of another schema.
    """
    return _header(Path(path), _read(Path(path)))


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


def _read(path: Path) -> dict[str, NDArray[Any]]:
    try:
        with path.open("rb") as raw:
            file = np.load(raw, allow_pickle=False)
            if not isinstance(file, np.lib.npyio.NpzFile):
                raise CogmapError(f"load: {path} is no saved agent but a single array; give a file that save wrote")
            with file:
                return {name: file[name] for name in file.files}
    except FileNotFoundError as error:
        raise CogmapError(f"load: there is no file {path}; give a file that save wrote") from error
    except (
        OSError,
        EOFError,
        RuntimeError,
        SyntaxError,
        ValueError,
        struct.error,
        tokenize.TokenError,
        zipfile.BadZipFile,
        zlib.error,
    ) as error:
        if isinstance(error, CogmapError):
            raise
        raise CogmapError(f"load: {path} is no saved agent, or truncated; give a file that save wrote") from error


def _header(path: Path, arrays: dict[str, NDArray[Any]]) -> dict[str, Any]:
    try:
        header: dict[str, Any] = json.loads(arrays["header"].tobytes())
        schema = int(header["schema"]) if header["format"] == FORMAT else -1
    except (KeyError, OverflowError, TypeError, ValueError) as error:
        raise CogmapError(f"load: {path} is no saved agent (no header); give a file that save wrote") from error
    if schema < 0:
        raise CogmapError(f"load: {path} is a {header['format']!r}, no saved agent; give a file that save wrote")
    if schema < OLDEST:
        raise CogmapError(f"load: {path} has schema {schema}, older than {OLDEST}; explore and save again")
    if schema > SCHEMA:
        raise CogmapError(f"load: {path} has schema {schema}, newer than {SCHEMA}; update cogmap to read it")
    return header
