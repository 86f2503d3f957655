"""Mazes as text: a row of whitespace-separated labels a line, `-1` or `.` where there is no room, and walls between.

A `|` between two labels is a wall between their rooms. A line of `--` and `.`, one a column, between two rows of
labels has a wall wherever dashes stand:

    hall  hall | study
    ----   .     ----
    attic den    den
"""

import os
import re
import stat
from collections.abc import Iterable, Sequence
from pathlib import Path

from .errors import WorldError
from .maze import Maze
from .maze_checks import LARGEST_LABEL, Door, Label, Position, UnreachableError

LARGEST = 128 * 2**20  # bytes of the largest text that is read

EMPTY = frozenset({".", "-1"})
_NUMBER = re.compile(r"[0-9]+")
_NEGATIVE = re.compile(r"-[0-9]+")
_DASHES = re.compile(r"--+")
_HASHES = re.compile(r"[#.]*#[#.]*")


def read_text(path: str | Path, *, most: int = LARGEST) -> str:
    """What a text file has in it.

    Raises:
        WorldError: the file cannot be read, has more than `most` bytes, or is not UTF-8 text.
    """
    path = Path(path)
    try:
        if path.is_dir():
            raise WorldError(f"{path} is a directory; give a maze text file")
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))  # a pipe would wait for ever
        with os.fdopen(handle, "rb") as file:
            size = os.fstat(handle).st_size
            if not stat.S_ISREG(os.fstat(handle).st_mode):
                raise WorldError(f"{path} is not a regular file; give a maze text file")
            content = file.read(most + 1) if size <= most else b""
        if size > most or len(content) > most:
            raise WorldError(f"{path} has {max(size, len(content)):,} bytes; such a file has {most:,} at most")
        return content.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        raise WorldError(f"{path} is not text (byte {error.start} is not UTF-8); give a maze text file") from error
    except (OSError, ValueError) as error:
        if isinstance(error, WorldError):
            raise
        why = getattr(error, "strerror", None) or error
        raise WorldError(f"{path} cannot be read: {why}; give a maze text file") from error


def parse_maze(text: str, *, name: str, source: str | None = None) -> Maze:
    """The maze written in `text`.

    The labels are whole numbers if all of them are decimal, otherwise all of them are words. Blank lines
    before and after are ignored. Positions count from the first row of labels.

    Args:
        text: rows of labels, with walls between them as told above.
        name: what the maze is called.
        source: what errors call it; its name unless given.

    Raises:
        WorldError: empty text, ragged rows, a blank line inside, labels that are negative (other than -1)
            or not printable, walls that do not stand between rooms, `#` and commas (see `read_maze`), rooms that
            cannot be reached; with `source` and the line.
    """
    source = source or name
    lines = text.splitlines()
    full = [i for i, line in enumerate(lines) if line.strip()]
    if not full:
        raise WorldError(f"{source} is empty; write a row of labels a line")
    first, last = full[0], full[-1]
    layout = _Layout(source)
    for number, line in enumerate(lines[first : last + 1], first + 1):
        layout.read(line.split(), number)
    return build(name, source, layout.words, layout.walls, layout.numbers)


def build(name: str, source: str, words: dict[Position, str], walls: Iterable[Door], lines: Sequence[int]) -> Maze:
    """The maze of these labels, whose row r stands in line `lines[r]`.

    Raises:
        WorldError: no rooms, a number too large, rooms that cannot be reached; with `source` and the line.
    """
    if not words:
        raise WorldError(f"{source} has no rooms; write a label where there is one")
    labels = _labels(words, source, lines)
    real = frozenset(wall for wall in walls if wall[0] in words and wall[1] in words)
    try:
        return Maze(name, labels, real)
    except UnreachableError as error:
        raise UnreachableError(f"{source}, line {lines[error.rooms[0][0]]}", error.rooms) from error


def format_maze(maze: Maze) -> str:
    """The text that `parse_maze` reads back as the same maze, columns aligned.

    Raises:
        WorldError: the labels would be read back as something else.
    """
    words = {room: str(label) for room, label in maze.sights.items()}
    _check_writable(maze, words.values())
    rows, columns = maze.shape
    width = max(2 if maze.walls else 1, *map(len, words.values()))
    lines: list[str] = []
    for row in range(rows):
        above = ["-" * width if ((row - 1, column), (row, column)) in maze.walls else "." for column in range(columns)]
        if set(above) != {"."}:
            lines.append((" " * 3).join(word.rjust(width) for word in above))
        line = words.get((row, 0), ".").rjust(width)
        for column in range(1, columns):
            between = " | " if ((row, column - 1), (row, column)) in maze.walls else " " * (3 if maze.walls else 1)
            line += between + words.get((row, column), ".").rjust(width)
        lines.append(line)
    return "\n".join(lines) + "\n"


class _Layout:
    """The labels and walls read so far, and the line of each row of labels."""

    def __init__(self, source: str) -> None:
        self._source = source
        self._above: list[bool] = []  # walls that the last line has put above the next row
        self._known: set[str] = set()  # labels that were looked at
        self.words: dict[Position, str] = {}
        self.walls: list[Door] = []
        self.numbers: list[int] = []
        self._width = 0

    def read(self, tokens: list[str], line: int) -> None:
        where = f"{self._source}, line {line}"
        if not tokens:
            raise WorldError(f"{where} is blank; write `.` where there is no room")
        dashes = [bool(_DASHES.fullmatch(token)) for token in tokens] if "--" in tokens[0] or tokens[0] == "." else []
        if any(dashes) and all(wall or token == "." for wall, token in zip(dashes, tokens, strict=True)):
            self._read_walls(dashes, where)
        else:
            self._read_labels(tokens, where)
            self.numbers.append(line)

    def _read_walls(self, walls: list[bool], where: str) -> None:
        if self._above:
            raise WorldError(f"{where} has walls below a line of walls; write a row of labels between them")
        self._check_width(len(walls), where, "walls")
        self._above = walls

    def _read_labels(self, tokens: list[str], where: str) -> None:
        row = len(self.numbers)
        if "|" in tokens:
            tokens = self._read_bars(tokens, row, where)
        for label in set(tokens) - self._known:
            check_label(label, where)
            self._known.add(label)
        self._check_width(len(tokens), where, "labels")
        self.walls += [((row - 1, column), (row, column)) for column, wall in enumerate(self._above) if wall]
        self._above = []
        self.words.update(((row, column), word) for column, word in enumerate(tokens) if word not in EMPTY)

    def _read_bars(self, tokens: list[str], row: int, where: str) -> list[str]:
        labels: list[str] = []
        for before, token in zip([None, *tokens], tokens, strict=False):
            if token != "|":
                labels.append(token)
            elif before == "|":
                raise WorldError(f"{where}: `| |` has no room in between; write `.` where there is none")
            else:
                self.walls.append(((row, len(labels) - 1), (row, len(labels))))
        return labels

    def _check_width(self, width: int, where: str, what: str) -> None:
        self._width = self._width or width
        if width != self._width:
            raise WorldError(
                f"{where} has {width} {what}, the first row has {self._width}; write `.` where there is no room"
            )


def check_label(label: str, where: str) -> None:
    """Refuse a label that means something else, or cannot be printed. Raises WorldError: it is one."""
    if _NEGATIVE.fullmatch(label) and label != "-1":
        raise WorldError(f"{where}: label {label} is negative; labels count from 0, -1 means no room")
    if not label.isprintable():
        raise WorldError(f"{where}: label {label!r} cannot be printed; is this a text file?")
    if why := _foreign(label):
        raise WorldError(f"{where}: {why}")


def _foreign(label: str) -> str:
    """What is wrong with a label that other ways to write mazes use; empty if nothing is."""
    if _HASHES.fullmatch(label):
        return f"{label:.20} looks like walls of an ASCII maze; read it with format='ascii', or write a label a room"
    if "," in label:
        return f"{label:.20} has commas; read it with format='commas', or put blanks between labels"
    if label == "|" or _DASHES.fullmatch(label):
        return f"{label:.20} marks walls: `|` between two labels, dashes in a line of their own"
    return ""


def _labels(words: dict[Position, str], source: str, lines: Sequence[int]) -> dict[Position, Label]:
    distinct = set(words.values())
    if not all(map(_NUMBER.fullmatch, distinct)):
        return dict(words)
    large = {word for word in distinct if len(word.lstrip("0")) > len(str(LARGEST_LABEL)) or int(word) > LARGEST_LABEL}
    for (row, _), word in words.items() if large else ():
        if word in large:
            raise WorldError(f"{source}, line {lines[row]}: label {word:.20} is over {LARGEST_LABEL}")
    number = {word: int(word) for word in distinct}
    return {room: number[word] for room, word in words.items()}


def _check_writable(maze: Maze, words: Iterable[str]) -> None:
    if isinstance(maze.sights[maze.rooms[0]], int):
        return
    distinct = set(words)
    for word in sorted(distinct):
        if word in EMPTY or _NEGATIVE.fullmatch(word) or _foreign(word):
            raise WorldError(f"maze {maze.name!r}: label {word!r} cannot be written; it would mean something else")
    if all(map(_NUMBER.fullmatch, distinct)):
        raise WorldError(f"maze {maze.name!r}: the labels are decimal words; use whole numbers or other words")
