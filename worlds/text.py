"""Mazes as text: a row of whitespace-separated labels a line, `-1` or `.` where there is no room."""

from __future__ import annotations

import re
from pathlib import Path

from .errors import WorldError
from .maze import LARGEST_LABEL, Label, Maze, Position, name_rooms, unreachable

EMPTY = frozenset({".", "-1"})
_NUMBER = re.compile(r"[0-9]+")
_NEGATIVE = re.compile(r"-[0-9]+")


def read_maze(path: str | Path) -> Maze:
    """The maze in a text file, named after the file without its suffix.

    Raises:
        WorldError: the file cannot be read, is not UTF-8 text, or is no maze (with file and line).
    """
    path = Path(path)
    try:
        if path.is_dir():
            raise WorldError(f"{path} is a directory; give a maze text file")
        if path.exists() and not path.is_file():
            raise WorldError(f"{path} is not a regular file; give a maze text file")
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise WorldError(f"{path} is not text (byte {error.start} is not UTF-8); give a maze text file") from error
    except OSError as error:
        raise WorldError(f"{path} cannot be read: {error.strerror or error}; give a maze text file") from error
    return _parse(text, name=path.stem, source=str(path))


def parse_maze(text: str, *, name: str) -> Maze:
    """The maze written in `text`.

    The labels are whole numbers if all of them are decimal, otherwise all of them are words. Blank lines
    before and after are ignored. Positions count from the first line that is not blank.

    Raises:
        WorldError: empty text, ragged rows, a blank line inside, labels that are negative (other than -1)
            or not printable, rooms that cannot be reached; with `name` and the line.
    """
    return _parse(text, name=name, source=name)


def format_maze(maze: Maze) -> str:
    """The text that `parse_maze` reads back as the same maze, columns aligned.

    Raises:
        WorldError: the labels would be read back as something else.
    """
    words = {room: str(label) for room, label in maze.sights.items()}
    _check_writable(maze, list(words.values()))
    rows, columns = maze.shape
    width = max(len(word) for word in words.values())
    lines = [" ".join(words.get((row, column), ".").rjust(width) for column in range(columns)) for row in range(rows)]
    return "\n".join(lines) + "\n"


def _parse(text: str, *, name: str, source: str) -> Maze:
    lines = text.splitlines()
    full = [i for i, line in enumerate(lines) if line.strip()]
    if not full:
        raise WorldError(f"{source} is empty; write a row of labels a line")
    first = full[0]
    words: dict[Position, str] = {}
    width = len(lines[first].split())
    for row, line in enumerate(lines[first : full[-1] + 1]):
        where = f"{source}, line {first + row + 1}"
        words.update(((row, column), word) for column, word in _row(line, width, where) if word not in EMPTY)
    if not words:
        raise WorldError(f"{source} has no rooms; write a label where there is one")
    if lost := unreachable(words):
        where = f"{source}, line {first + lost[0][0] + 1}"
        raise WorldError(f"{where}: {name_rooms(lost)} cannot be reached from the rest; join or remove them")
    return Maze(name, _labels(words, source, first))


def _row(line: str, width: int, where: str) -> list[tuple[int, str]]:
    labels = line.split()
    if not labels:
        raise WorldError(f"{where} is blank; write `.` where there is no room")
    if len(labels) != width:
        raise WorldError(
            f"{where} has {len(labels)} labels, the first row has {width}; write `.` where there is no room"
        )
    for label in labels:
        if _NEGATIVE.fullmatch(label) and label != "-1":
            raise WorldError(f"{where}: label {label} is negative; labels count from 0, -1 means no room")
        if not label.isprintable():
            raise WorldError(f"{where}: label {label!r} cannot be printed; is this a text file?")
    return list(enumerate(labels))


def _labels(words: dict[Position, str], source: str, first: int) -> dict[Position, Label]:
    if not all(_NUMBER.fullmatch(word) for word in words.values()):
        return dict(words)
    for (row, _), word in words.items():
        if len(word.lstrip("0")) > len(str(LARGEST_LABEL)) or int(word) > LARGEST_LABEL:
            raise WorldError(f"{source}, line {first + row + 1}: label {word:.20} is over {LARGEST_LABEL}")
    return {room: int(word) for room, word in words.items()}


def _check_writable(maze: Maze, words: list[str]) -> None:
    if isinstance(maze.sights[maze.rooms[0]], int):
        return
    for word in words:
        if word in EMPTY or _NEGATIVE.fullmatch(word):
            raise WorldError(f"maze {maze.name!r}: label {word!r} cannot be written; it would mean no room")
    if all(_NUMBER.fullmatch(word) for word in words):
        raise WorldError(f"maze {maze.name!r}: the labels are decimal words; use whole numbers or other words")
