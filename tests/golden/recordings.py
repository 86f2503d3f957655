"""The recordings of golden walks: JSON, compressed, the values of one fact in a row."""

from __future__ import annotations

import gzip
import json
from functools import lru_cache
from pathlib import Path
from typing import Any

from .adapters import Facts

FILE = Path(__file__).parent / "walks.json.gz"


def write_recordings(walks: dict[str, list[Facts]], path: Path = FILE) -> None:
    """Write the facts of each walk's steps and, last of each, of its map."""
    packed = {name: {"steps": _columns(facts[:-1]), "map": facts[-1]} for name, facts in walks.items()}
    lines = ",\n".join(f"{json.dumps(name)}: {_json(walk)}" for name, walk in packed.items())
    path.write_bytes(gzip.compress(f"{{\n{lines}\n}}\n".encode(), mtime=0))


@lru_cache
def read_recordings(path: Path = FILE) -> dict[str, list[Facts]]:
    """What `write_recordings` wrote."""
    packed = json.loads(gzip.decompress(path.read_bytes()))
    return {name: [*_rows(walk["steps"]), walk["map"]] for name, walk in packed.items()}


def _columns(rows: list[Facts]) -> dict[str, list[Any]]:
    return {name: [row[name] for row in rows] for name in rows[0]}


def _rows(columns: dict[str, list[Any]]) -> list[Facts]:
    return [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]


def _json(value: Any) -> str:
    return json.dumps(_rounded(value), separators=(",", ":"))


def _rounded(value: Any) -> Any:
    """The value with twelve digits, a thousandth of what a comparison lets pass."""
    if isinstance(value, float):
        return float(f"{round(value, 12):.12g}")
    if isinstance(value, dict):
        return {key: _rounded(one) for key, one in value.items()}
    return [_rounded(one) for one in value] if isinstance(value, list) else value
