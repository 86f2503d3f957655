"""Mazes in files, in each of the ways that people write them."""

import csv
from collections.abc import Callable, Mapping
from pathlib import Path

from .errors import WorldError
from .maze import Maze, Position
from .sights import Sights, give_sights
from .text import EMPTY, build, check_label, parse_maze, read_text

_SIDES = ((-1, 0), (1, 0), (0, -1), (0, 1))


def read_maze(path: str | Path, *, format: str = "text", sights: Sights = "distinct", seed: int = 0) -> Maze:
    """The maze in a text file, named after the file without its suffix.

    Args:
        path: the file.
        format: `"text"`, labels with blanks between (see `parse_maze`); `"commas"`, labels with commas between;
            `"ascii"`, a character a cell: `#` a wall, `.` the floor (blanks are, where there is no `.`), anything
            else the label of a room.
        sights: of the cells of an ASCII maze that have no label: `"distinct"`, `"ways"`, or how many at random.
        seed: of sights at random.

    Raises:
        WorldError: the file cannot be read, is not UTF-8 text, or is no maze (with file and line); unknown format.
    """
    if format not in FORMATS:
        raise WorldError(f"unknown format {format!r} of a maze; use one of {', '.join(FORMATS)}")
    return FORMATS[format](read_text(path), Path(path).stem, str(path), sights, seed)


def _parse_text(text: str, name: str, source: str, _sights: Sights, _seed: int) -> Maze:
    return parse_maze(text, name=name, source=source)


def _parse_commas(text: str, name: str, source: str, _sights: Sights, _seed: int) -> Maze:
    above = text[: len(text) - len(text.lstrip())].count("\n") + 1
    words: dict[Position, str] = {}
    lines = text.strip().splitlines()
    try:
        for row, cells in enumerate(csv.reader(lines, strict=True)):
            labels = [cell.strip() for cell in cells]
            for label in set(labels):
                check_label(label, f"{source}, line {above + row}")
            words.update(((row, column), label) for column, label in enumerate(labels) if label not in ("", *EMPTY))
    except csv.Error as error:
        raise WorldError(f"{source} is no comma file: {error}; write labels with commas between") from error
    return build(name, source, words, (), range(above, above + len(lines)))


def _parse_ascii(text: str, name: str, source: str, sights: Sights, seed: int) -> Maze:
    lines = text.splitlines()
    floor = "." if "." in text else " "
    cells = {
        (row, column): mark
        for row, line in enumerate(lines)
        for column, mark in enumerate(line.replace("\t", " "))
        if mark != "#" and (mark == floor or not mark.isspace())
    }
    bare = [cell for cell, mark in cells.items() if mark == floor]
    labels = {mark for mark in cells.values() if mark != floor}
    given = give_sights(sights, _ways(bare, cells), seed=seed, taken=labels, where=source)
    words = {**cells, **{cell: str(label) for cell, label in zip(bare, given, strict=True)}}
    top, left = (min((cell[axis] for cell in words), default=0) for axis in (0, 1))
    moved = {(row - top, column - left): word for (row, column), word in words.items()}
    return build(name, source, moved, (), range(top + 1, len(lines) + 1))


def _ways(bare: list[Position], cells: Mapping[Position, str]) -> list[int]:
    return [sum((row + down, column + right) in cells for down, right in _SIDES) for row, column in bare]


Parser = Callable[[str, str, str, Sights, int], Maze]
FORMATS: Mapping[str, Parser] = {
    "text": _parse_text,
    "commas": _parse_commas,
    "ascii": _parse_ascii,
}
