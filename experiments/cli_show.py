"""A walk as text in a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from rich.cells import cell_len, set_cell_size
from rich.console import Console
from rich.markup import escape
from rich.style import Style
from rich.table import Table
from rich.text import Text

from ..agent import Agent
from ..model import BLOCKED, OPEN, CognitiveMap
from ..views import sight_colour
from ..views.colours import ink_on
from ..worlds import GRID, Maze, Position
from .cli_spark import sparkline
from .cli_table import console, count
from .knowledge import BELIEVED, Truth

if TYPE_CHECKING:
    from .exploring import Walk

MOST_MOVES = 400  # of a path written out
_ARROWS = {"up": "↑", "down": "↓", "left": "←", "right": "→", "stay": "·"}


def show_walk(maze: Maze, walk: Walk, *, agent: str) -> None:
    """The maze, the path, the map learned, and F and G over time."""
    to = console()
    run = walk.run
    to.print(
        f"[bold]{escape(maze.name)}[/bold]: {count(len(maze.rooms), 'room')}, agent {agent}, seed {run.seed}",
        highlight=False,
    )
    to.print(_maze(maze, walk.path, to.width))
    to.print(_path(walk.path, unicode=_unicode(to)), soft_wrap=False)
    table = _facts()
    for name, steps in (
        ("every room visited after", run.steps_to_visit_all),
        ("every transition learned after", run.steps_to_learn),
        ("complete after", run.steps_to_complete),
        ("shortest possible (oracle)", run.oracle_steps),
        ("nearest-frontier search", run.frontier_steps),
    ):
        if steps is not None or name != "nearest-frontier search":
            table.add_row(name, "-" if steps is None else count(steps, "step"))
    table.add_row("time", f"{run.seconds:.2f} s")
    if isinstance(walk.walker, Agent):
        _add_map(table, walk.walker.map)
        table.add_row("least believed transition", _belief(maze, walk, walk.walker))
        _add_energies(table, walk.walker, to)
    to.print(table)


def _facts() -> Table:
    table = Table(show_header=False, box=None, pad_edge=False)
    table.add_column(style="dim")
    table.add_column()
    return table


def _maze(maze: Maze, path: Sequence[Position], width: int) -> Text:
    """Every room in its colour, with its label and the step of the first visit."""
    first: dict[Position, int] = {}
    for step, room in enumerate(path):
        first.setdefault(room, step)
    rows, columns = maze.shape
    words = [str(word) for word in (*maze.sights.values(), *first.values())]
    cell = min(max(map(cell_len, words)) + 2, 10)
    if columns * cell > width:
        return Text(f"(too wide to draw here: {columns} columns; see the picture)", style="dim")
    text = Text(no_wrap=True)
    for row in range(rows):
        for line in range(2):
            for column in range(columns):
                text.append(*_cell(maze, (row, column), first, cell, line))
            text.append("\n")
    text.append("(in each room its label, and the step of the first visit)", style="dim")
    return text


def _cell(maze: Maze, room: Position, first: dict[Position, int], width: int, line: int) -> tuple[str, Style]:
    if room not in maze.sights:
        return " " * width, Style()
    label = maze.sights[room]
    colour = sight_colour(label)
    background = "#" + "".join(f"{round(255 * part):02x}" for part in colour)
    ink = "#000000" if ink_on(colour) == "black" else "#ffffff"
    step = str(first.get(room, "")).rjust(width - 2)
    content = set_cell_size(str(label) if line == 0 else step, width - 2)
    return f" {content} ", Style(color=ink, bgcolor=background, bold=line == 0)


def _path(path: Sequence[Position], *, unicode: bool) -> Text:
    names = dict(zip(GRID.displacements, GRID.names, strict=True))
    moves = [names[b[0] - a[0], b[1] - a[1]] for a, b in pairwise(path)]
    signs = "".join(_ARROWS[move] if unicode else move[0] for move in moves[:MOST_MOVES])
    more = f" and {len(moves) - MOST_MOVES} more" if len(moves) > MOST_MOVES else ""
    return Text(f"path from {path[0]}: {signs or 'none'}{more}", overflow="fold")


def _add_map(table: Table, map_: CognitiveMap) -> None:
    visited = int(map_.visited.sum())
    ways = [action for action in range(len(map_.motions)) if action != map_.motions.stay]
    sensed, walked = map_.sensed[:, ways], map_.walked[:, ways]
    counts = {
        "walked": (walked & (sensed != BLOCKED)).sum(),
        "imagined": (~walked & (sensed == OPEN)).sum(),
        "blocked": (sensed == BLOCKED).sum(),
        "unknown": (~walked & (sensed != OPEN) & (sensed != BLOCKED)).sum(),
    }
    table.add_row("map", f"{count(len(map_.places), 'place')} ({visited} visited), {count(len(map_.sights), 'sight')}")
    table.add_row("transitions", ", ".join(f"{count} {name}" for name, count in counts.items()))


def _belief(maze: Maze, walk: Walk, agent: Agent) -> str:
    return f"{Truth(maze, walk.run.start).least(agent.map):.3f} (learned from {BELIEVED})"


def _add_energies(table: Table, agent: Agent, to: Console) -> None:
    width = min(max(to.width - 56, 8), 60)  # beside the names and the range
    for name, values in (
        ("free energy F", [record.free_energy for record in agent.trace]),
        ("expected free energy G", [record.G["G"] for record in agent.trace]),
        ("certainty", [record.certainty for record in agent.trace]),
    ):
        unit = "" if name == "certainty" else " nats"
        line = Text(sparkline(values, width=width, unicode=_unicode(to)))
        low, high = (round(value, 2) + 0.0 for value in (min(values), max(values)))  # + 0.0: no -0.00
        line.append(f" {low:.2f} to {high:.2f}{unit}", style="dim")
        table.add_row(name, line)


def _unicode(to: Console) -> bool:
    return to.encoding.lower().startswith("utf")
