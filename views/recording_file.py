"""Recordings on disk: JSON, packed where the name ends in .gz, whole or not at all."""

from __future__ import annotations

import gzip
import json
import zlib
from os import PathLike
from pathlib import Path
from typing import Any, cast

from ..model import CogmapError, write_whole

FORMAT = "cogmap recording"

SCHEMA = 2
"""Version of the layout of the file."""

READ = (1, 2)
"""Schemas that are read."""


def pack(data: dict[str, Any], *, packed: bool = False) -> bytes:
    """The recording as JSON in UTF-8.

    Raises:
        CogmapError: something in it is no finite JSON value.
    """
    try:
        text = json.dumps(data, separators=(",", ":"), allow_nan=False, ensure_ascii=True)
    except (TypeError, ValueError) as error:
        raise CogmapError(f"recording: {error}; record plain finite values") from error
    return gzip.compress(text.encode(), mtime=0) if packed else text.encode()


def write(data: dict[str, Any], path: str | PathLike[str]) -> None:
    """Replace the file at once.

    Raises:
        CogmapError: the file cannot be written; what was there before still is.
    """
    write_whole(Path(path), pack(data, packed=Path(path).suffix == ".gz"))


def read(path: str | PathLike[str]) -> dict[str, Any]:
    """What `write` wrote; `schema` is one of `READ`, the rest is as it comes.

    Raises:
        CogmapError: no such file, no recording, truncated, or of another schema.
    """
    try:
        content = Path(path).read_bytes()
        if content[:2] == b"\x1f\x8b":
            content = gzip.decompress(content)
        data = json.loads(content)
    except FileNotFoundError as error:
        raise CogmapError(f"recording: there is no file {path}; give one that --trace wrote") from error
    except (OSError, EOFError, RecursionError, ValueError, zlib.error) as error:
        raise CogmapError(f"recording: {path} is no recording, or truncated; give a file that --trace wrote") from error
    if not isinstance(data, dict) or cast(dict[str, Any], data).get("format") != FORMAT:
        raise CogmapError(f"recording: {path} is JSON, but no recording; give a file that --trace wrote")
    found: dict[str, Any] = data
    if (schema := found.get("schema")) not in READ:
        known = " and ".join(map(str, READ))
        raise CogmapError(f"recording: {path} has schema {schema!r}, this cogmap reads {known}; record it again")
    return found
