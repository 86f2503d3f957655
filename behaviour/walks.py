"""Recorded walks: who went where, bout by bout."""

import csv
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

from ..model import CogmapError
from ..views import Recording

SUFFIXES = (".json", ".csv", ".gz")
_COLUMNS = ("individual", "bout", "node")


@dataclass(frozen=True, slots=True)
class Walk:
    """The recorded walk of one individual."""

    individual: str  # its name
    bouts: tuple[tuple[Any, ...], ...]  # the nodes of each bout, in order, as they were written
    # what else the file says of it, such as `water_restricted`
    about: Mapping[str, Any] = field(default_factory=dict[str, Any])
    source: str = "walk"  # the file

    def __post_init__(self) -> None:
        if not self.bouts:
            raise CogmapError(f"{self.source}: {self.individual} has no bouts; give one or more, each a list of nodes")
        for number, bout in enumerate(self.bouts, start=1):
            if not bout:
                raise CogmapError(f"{self.source}: bout {number} of {self.individual} is empty; leave it out")


def load_walks(*paths: Path | str) -> list[Walk]:
    """The walks in some files or folders, in the order given; in a folder every JSON and CSV file by name.

    - CSV: a line of heads with `individual`, `bout` and `node` among them, then one line a step, in order.
    - JSON: an object with `bouts`, a list of lists of nodes, and perhaps `individual` (or `mouse`), or a list of such.
    - JSON that `--trace` wrote, packed or not: one individual and one bout.

    Raises:
        CogmapError: no such file, nothing of the kind in it, an empty bout, or two individuals of one name.
    """
    walks = [walk for path in paths for file in _files(Path(path)) for walk in _walks(file)]
    names = [walk.individual for walk in walks]
    if twice := [name for name in dict.fromkeys(names) if names.count(name) > 1]:
        raise CogmapError(f"walks: {twice[0]} was given twice; give each individual a name of its own")
    return walks


def _files(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    found = sorted(file for file in path.iterdir() if file.suffix.lower() in SUFFIXES and not file.name.startswith("."))
    if not found:
        raise CogmapError(f"{path} has no walks; give a folder with files of JSON or CSV")
    return found


def _walks(file: Path) -> list[Walk]:
    if file.suffix.lower() == ".csv":
        return _from_csv(file)
    if file.suffix.lower() == ".gz":
        return [_from_trace(file)]
    value = _parsed(file)
    if isinstance(value, dict) and "format" in value:
        return [_from_trace(file)]
    entries: list[Any] = cast(list[Any], value) if isinstance(value, list) else [value]
    if not entries:
        raise CogmapError(f"{file} has no walks; give objects with 'bouts'")
    return [_from_json(file, entry, None if len(entries) == 1 else n) for n, entry in enumerate(entries, start=1)]


def _text(file: Path) -> str:
    try:
        return file.read_text("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        why = getattr(error, "strerror", None) or "no text"
        raise CogmapError(f"cannot read {file} ({why}); give walks as JSON, CSV or a trace") from error


def _parsed(file: Path) -> Any:
    try:
        return json.loads(_text(file))
    except (ValueError, RecursionError) as error:
        if isinstance(error, CogmapError):
            raise
        raise CogmapError(f"{file} is no JSON, or truncated ({error}); give walks as JSON, CSV or a trace") from error


def _from_json(file: Path, entry: Any, number: int | None) -> Walk:
    where = f"{file}" if number is None else f"{file}, walk {number}"
    if not isinstance(entry, dict) or not isinstance(cast(dict[str, Any], entry).get("bouts"), list):
        raise CogmapError(f"{where}: has no 'bouts'; give an object with a list of lists of nodes")
    values = cast(dict[str, Any], entry)
    names = [values[key] for key in ("individual", "mouse") if key in values]
    name = str(names[0]) if names else file.stem if number is None else f"{file.stem}-{number}"
    bouts: list[tuple[Any, ...]] = []
    for n, bout in enumerate(values["bouts"], start=1):
        if not isinstance(bout, list):
            raise CogmapError(f"{where}: bout {n} is {bout!r:.40}; give a list of nodes")
        bouts.append(tuple(_hashable(node) for node in cast(list[Any], bout)))
    about = {key: value for key, value in values.items() if key not in ("individual", "mouse", "bouts")}
    return Walk(name, tuple(bouts), about, where)


def _hashable(node: Any) -> Any:
    return tuple(_hashable(part) for part in cast(list[Any], node)) if isinstance(node, list) else node


def _from_csv(file: Path) -> list[Walk]:
    rows = list(csv.reader(_text(file).splitlines()))
    heads = [head.strip().lower() for head in rows[0]] if rows else []
    if missing := [column for column in _COLUMNS if column not in heads]:
        raise CogmapError(f"{file} has no column {missing[0]!r}; give the columns {', '.join(_COLUMNS)}")
    at = [heads.index(column) for column in _COLUMNS]
    bouts: dict[str, dict[str, list[str]]] = {}
    for line, row in enumerate(rows[1:], start=2):
        if not any(cell.strip() for cell in row):
            continue
        cells = [row[i].strip() if i < len(row) else "" for i in at]
        if missing := [column for column, cell in zip(_COLUMNS, cells, strict=True) if not cell]:
            raise CogmapError(f"{file}, line {line}: no {missing[0]}; give each line {', '.join(_COLUMNS)}")
        individual, bout, node = cells
        bouts.setdefault(individual, {}).setdefault(bout, []).append(node)
    if not bouts:
        raise CogmapError(f"{file} has no walks; give a line for each step")
    return [Walk(name, tuple(map(tuple, of.values())), {}, str(file)) for name, of in bouts.items()]


def _from_trace(file: Path) -> Walk:
    recording = Recording.load(file)
    places = recording.places
    nodes = [places[frame["at"]] for frame in recording.frames if frame.get("at") is not None]
    if len(nodes) < len(recording):
        raise CogmapError(f"{file} does not say where the agent was; record it again in a world with a map")
    name = file.name.removesuffix(".gz").removesuffix(".json")
    return Walk(name, (tuple(nodes),), {"title": recording.data.get("title", "")}, str(file))
