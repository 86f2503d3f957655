"""A walk as text in a terminal."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from rich.cells import cell_len, set_cell_size
from rich.console import Console
from rich.markup import escape
from rich.style import Style
from rich.text import Text

from ...agent import Agent
from ...views import hexed, ink_on, sight_colour
from ...worlds import Chart, Maze, Place
from ..exploring import ExploreRun, Walk
from ..judging import BELIEVED
from ..text import Screen, count, show_facts
from .inspect_facts import ways_known

MOST_MOVES = 400  # of a path written out
_ARROWS = {"up": "↑", "down": "↓", "left": "←", "right": "→", "stay": "·"}
_BLOCKS, _ASCII = "▁▂▃▄▅▆▇█", "_.-=*#"


def show_walk(chart: Chart, walk: Walk, *, agent: str) -> None:
    """The maze, the path, the map learned, and F and G over time."""
    to, run, rooms = Screen(), walk.run, count(len(chart.places), "room")
    to.print(f"[bold]{escape(chart.name)}[/bold]: {rooms}, agent {agent}, seed {run.seed}", highlight=False)
    if isinstance(chart, Maze):
        to.print(_maze(chart, walk.path, to.width))
    to.print(_path(chart, walk.path, unicode=has_unicode(to)), soft_wrap=False)
    steps = {
        "every room visited after": run.steps_to_visit_all,
        "every transition learned after": run.steps_to_learn,
        "complete after": run.steps_to_complete,
        "shortest possible (oracle)": run.oracle_steps,
    }
    if run.frontier_steps is not None or run.not_worked_out is not None:
        steps["nearest-frontier search"] = run.frontier_steps
    facts: dict[str, Any] = {name: "-" if value is None else count(value, "step") for name, value in steps.items()}
    facts["time"] = f"{run.seconds:.2f} s"
    if isinstance(walk.walker, Agent):
        facts |= _learned(walk, walk.walker) | _energies(walk.walker, to)
    show_facts(facts)


def sparkline(values: Sequence[float], *, width: int = 60, unicode: bool = True) -> str:
    """At most `width` signs from the least to the greatest value; longer series are averaged in parts."""
    parts = np.array_split(np.asarray(values, dtype=np.float64), min(width, len(values)))
    means = np.array([part.mean() for part in parts])
    signs = _BLOCKS if unicode else _ASCII
    low, span = means.min(), np.ptp(means)
    if span < 1e-9:
        return signs[len(signs) // 2] * len(means)
    return "".join(signs[round(level)] for level in ((means - low) / span * (len(signs) - 1)).tolist())


def _maze(maze: Maze, path: Sequence[Place], width: int) -> Text:
    """Every room in its colour, with its label and the step of the first visit."""
    first = {room: step for step, room in reversed(list(enumerate(path)))}
    rows, columns = maze.shape
    few = 3 * columns <= width  # a cell takes three signs or more
    words = [str(word) for word in (*maze.sights.values(), *first.values())] if few else []
    cell = min(max(map(cell_len, words), default=1) + 2, 10)
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


def _cell(maze: Maze, room: Place, first: dict[Place, int], width: int, line: int) -> tuple[str, Style]:
    if room not in maze.sights:
        return " " * width, Style()
    label = maze.sights[room]
    colour = sight_colour(label)
    ink = "#000000" if ink_on(colour) == "black" else "#ffffff"
    content = set_cell_size(str(label) if line == 0 else str(first.get(room, "")).rjust(width - 2), width - 2)
    return f" {content} ", Style(color=ink, bgcolor=hexed(colour), bold=line == 0)


def _path(chart: Chart, path: Sequence[Place], *, unicode: bool) -> Text:
    def sign(a: Place, b: Place) -> str:
        ways = (str(way) for way, place in chart.successors(a).items() if place == b)
        move = "stay" if a == b else next(ways, "!")  # put elsewhere
        return _ARROWS.get(move, f"{move} ") if unicode else move[0]

    signs = "".join(sign(a, b) for a, b in pairwise(path[: MOST_MOVES + 1]))
    more = f" and {len(path) - 1 - MOST_MOVES} more" if len(path) - 1 > MOST_MOVES else ""
    return Text(f"path from {path[0]}: {signs or 'none'}{more}", overflow="fold")


def _learned(walk: Walk, agent: Agent) -> dict[str, str]:
    map_, ways = agent.map, ways_known(agent.map)
    places = f"{count(len(map_.places), 'place')} ({int(map_.visited.sum())} visited)"
    known = (f"{number} {'blocked' if name == 'refuted' else name}" for name, number in ways.items())
    least = walk.truth.least(map_)  # 0 where positions say nothing
    sure = {"least believed transition": f"{least:.3f} (learned from {BELIEVED})"} if least else {}
    return {
        "map": f"{places}, {count(len(map_.sights), 'sight')}",
        "transitions": ", ".join(known),
        "beside the truth": _worth(walk.run),
        **sure,
    }


def _worth(run: ExploreRun) -> str:
    parts = (
        count(run.places or 0, "place"),
        f"map {'right' if run.map_right else 'not right'}",
        f"{run.known or 0.0:.0%} of all transitions known",
        f"certain but wrong in {run.certain_but_wrong or 0.0:.1%} of the steps",
    )
    return ", ".join(parts)


def _energies(agent: Agent, to: Console) -> dict[str, Text]:
    width = min(max(to.width - 56, 8), 60)  # beside the names and the range
    series: dict[str, list[Any]] = {
        "free energy F": [record.free_energy for record in agent.trace],
        "expected free energy G": [record.G["G"] for record in agent.trace],
        "certainty": [record.certainty for record in agent.trace],
    }
    lines: dict[str, Text] = {}
    for name, values in series.items():
        low, high = (round(value, 2) + 0.0 for value in (min(values), max(values)))  # + 0.0: no -0.00
        lines[name] = Text(sparkline(values, width=width, unicode=has_unicode(to)))
        unit = "" if name == "certainty" else " nats"
        lines[name].append(f" {low:.2f} to {high:.2f}{unit}", style="dim")
    return lines


def has_unicode(to: Console) -> bool:
    """Whether a terminal can show more than ASCII."""
    return to.encoding.lower().startswith("utf")
