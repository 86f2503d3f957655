"""Recordings on disk: JSON, packed where the name ends in .gz, whole or not at all; earlier schemas in this one."""

import gzip
import json
import zlib
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any, cast

from ..model import CogmapError, parse_json, read_file, unpack_gzip, write_whole
from ..planning import TERMS
from .recording_frames import term_json

FORMAT = "cogmap recording"
SCHEMA = 2  # of the layout of the file
READ = (1, 2)  # schemas that are read


def write(data: dict[str, Any], path: str | PathLike[str]) -> None:
    """Replace the file at once.

    Raises:
        CogmapError: something is no finite JSON value, or the file cannot be written; what was there before still is.
    """
    try:
        text = json.dumps(data, separators=(",", ":"), allow_nan=False, ensure_ascii=True)
    except (TypeError, ValueError) as error:
        raise CogmapError(f"recording: {error}; record plain finite values") from error
    write_whole(Path(path), gzip.compress(text.encode(), mtime=0) if Path(path).suffix == ".gz" else text.encode())


def read(path: str | PathLike[str]) -> dict[str, Any]:
    """What `write` wrote; `schema` is one of `READ`, the rest is as it comes.

    Raises:
        CogmapError: no such file, no recording, truncated, or of another schema.
    """
    try:
        content = read_file(path)
        data = parse_json(unpack_gzip(path, content) if content[:2] == b"\x1f\x8b" else content)
    except FileNotFoundError as error:
        raise CogmapError(f"recording: there is no file {path}; give one that --trace wrote") from error
    except (OSError, EOFError, MemoryError, RecursionError, ValueError, zlib.error) as error:
        why = " ".join(str(error).split())[:200]
        truncated = f"recording: {path} is no recording, or truncated ({why})"
        raise CogmapError(f"{truncated}; give a file that --trace wrote") from error
    if not isinstance(data, dict) or cast(dict[str, Any], data).get("format") != FORMAT:
        raise CogmapError(f"recording: {path} is JSON, but no recording; give a file that --trace wrote")
    found: dict[str, Any] = data
    if (schema := found.get("schema")) not in READ:
        known = " and ".join(map(str, READ))
        raise CogmapError(f"recording: {path} has schema {schema!r}, this cogmap reads {known}; record it again")
    return found


def upgraded(data: dict[str, Any]) -> dict[str, Any]:
    """A recording in the present schema; 1 knew mazes, one sensor of sights and one of doors, and the paper's terms.

    Raises:
        AttributeError, LookupError, TypeError, ValueError: it is damaged.
    """
    if data["schema"] == SCHEMA:
        return data
    numbers: dict[tuple[int, ...], int] = {}

    def number(room: list[int] | tuple[int, ...]) -> int:
        return numbers.setdefault(tuple(room), len(numbers))

    rooms = [(row, column) for row, column, _ in data["maze"] or ()]
    ends = [(number(a), (a[0] + down, a[1] + right)) for a in rooms for down, right in ((1, 0), (0, 1))]
    ways = [[a, numbers[b], 0] for a, b in ends if b in numbers]
    world = data["maze"] and {"rooms": True, "places": data["maze"], "ways": ways, "walls": []}
    terms = {term.name: term_json(term) for term in TERMS}
    return {
        **{name: value for name, value in data.items() if name != "maze"},
        "schema": SCHEMA,
        "terms": [terms[name] for name in data["terms"]],
        "world": world,
        "origin": None if data["origin"] is None else number(data["origin"]),
        "frames": [_upgraded_frame(frame, number, data["sights"]) for frame in data["frames"]],
        "places": [{"tuple": list(room)} for room in numbers],
    }


def _upgraded_frame(frame: dict[str, Any], number: Callable[[list[int]], int], sights: list[Any]) -> dict[str, Any]:
    rooms: dict[str, Callable[[Any], Any]] = {
        "at": number,
        "closed_rooms": lambda rooms: [number(room) for room in rooms],
        "closed_doors": lambda doors: [[number(a), number(b)] for a, b in doors],
    }
    kept = {name: rooms.get(name, lambda value: value)(value) for name, value in frame.items() if name != "sight"}
    return kept | {"seen": {"sight": sights[frame["sight"]]}}
