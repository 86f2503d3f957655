"""Agents in npz files: arrays, and a JSON header with a schema version; no pickle."""

from __future__ import annotations

import json
import struct
import tokenize
import zipfile
import zlib
from importlib.metadata import PackageNotFoundError, version
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..model.errors import CogmapError
from ..model.files import write_through

if TYPE_CHECKING:
    from .agent import Agent

SCHEMA, OLDEST = 3, 2
"""Version of the layout of the file, and the oldest that can be read."""

FORMAT = "cogmap agent"


def save(agent: Agent, path: str | PathLike[str]) -> None:
    """Write the agent; the file is replaced whole, or not at all.

    Raises:
        CogmapError: a label or a setting cannot be written, or the folder cannot be.
    """
    header, arrays = agent.state()
    header = {"format": FORMAT, "schema": SCHEMA, "version": _version(), **header}
    packed = np.frombuffer(_json(header).encode(), dtype=np.uint8)

    def write(target: Path) -> None:
        with target.open("wb") as file:
            np.savez(file, header=packed, **arrays)  # pyright: ignore[reportArgumentType]

    write_through(Path(path), write)


def load(path: str | PathLike[str]) -> Agent:
    """The agent in the file.

    Raises:
        CogmapError: no such file, no saved agent, truncated, or written by a newer version.
    """
    from .agent import Agent

    arrays = _read(Path(path))
    header = _header(Path(path), arrays)
    if header["schema"] == 2:
        _of_schema_2(header, arrays)
    try:
        agent = Agent.from_state(header, arrays)
        _check(agent)
    except (AttributeError, ArithmeticError, LookupError, TypeError, ValueError) as error:
        raise CogmapError(f"load: {path} is damaged ({type(error).__name__}: {error}); save the agent again") from error
    return agent


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


def _check(agent: Agent) -> None:
    """Whether belief and window are about the map."""
    for variable in agent.graph.variables:  # its factors check their shapes
        if variable.name.startswith("s") and not all(place in agent.map.places for place in variable.domain):
            raise CogmapError("the window is about places that the map does not have")
    if agent.steps:
        message = agent.belief.message
        for numbers, count in ((message.places, len(agent.map.places)), (message.positions, len(agent.map.positions))):
            if numbers.min() < 0 or numbers.max() >= count:
                raise CogmapError("the belief is about places that the map does not have")


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


def _of_schema_2(header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> None:
    """Make it one of the present schema; what was learned before cannot be taken back."""
    header["recent"] = []
    arrays["changes.rows"], arrays["changes.first"] = np.zeros((0, 9)), np.zeros(1, dtype=np.int64)
    arrays["changes.marks"], arrays["changes.undone"] = (np.zeros(n, dtype=np.int64) for n in ((0,), (0, 2)))
