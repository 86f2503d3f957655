"""Figures as text, and text and tables in a terminal."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.box import SIMPLE_HEAD, Box
from rich.console import Console, ConsoleOptions, RenderableType
from rich.markup import escape
from rich.segment import Segment
from rich.table import Table
from rich.text import Text


def number(value: float | None, *, digits: int = 1) -> str:
    """A number as text, or a dash for none."""
    return "-" if value is None else f"{value:.{digits}f}"


def spread(summary: dict[str, Any], name: str) -> str:
    """Mean ± standard deviation of a figure in a summary, as text."""
    mean, std = summary[f"mean_{name}"], summary[f"std_{name}"]
    return "-" if mean is None else f"{mean:.1f} ± {std:.1f}"


def count(number: int, what: str) -> str:
    """`1 step`, `2 steps`."""
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


def seeds_of(result: dict[str, Any], condition: Callable[[dict[str, Any]], bool], *, most: int = 20) -> str:
    """The seeds of the runs of which the condition holds, as text."""
    seeds = [str(run["seed"]) for run in result["runs"] if condition(run)]
    return ", ".join(seeds[:most]) + (" ..." if len(seeds) > most else "")


def place_text(place: Any) -> str:
    """A place as results have it: a room as a pair."""
    return str(tuple(place) if isinstance(place, list) else place)  # pyright: ignore[reportUnknownArgumentType]


class Screen(Console):
    """A terminal that shows what cannot be printed as Python writes it, so that no name or label can command it."""

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """The segments of what is printed."""
        for segment in super().render(renderable, options):
            yield segment if segment.control else Segment(printable(segment.text), segment.style)


def printable(text: str) -> str:
    """The text with every sign but line breaks that cannot be printed, or that a terminal would obey, written out."""
    if text.isprintable():
        return text
    return "".join(sign if sign.isprintable() or sign == "\n" else repr(sign)[1:-1] for sign in text)


def say(*lines: object, title: str | None = None, style: str | None = None, markup: bool = False) -> None:
    """A title and a few lines of plain text."""
    to = Screen()
    if title is not None:
        to.print(title, style="bold", markup=False, highlight=False)
    for line in lines:
        to.print(str(line), style=style, markup=markup, highlight=False, soft_wrap=True)


def say_saved(**files: Path | None) -> None:
    """Where what was asked for is kept, by what it is."""
    say(*(f"{what} saved: {path}" for what, path in files.items() if path is not None))


def show_table(
    headings: Sequence[str],
    rows: Sequence[Sequence[object]],
    *,
    title: str | None = None,
    most: int | None = None,
    box: Box = SIMPLE_HEAD,
) -> None:
    """A table of `most` rows; a heading that begins with > is set right."""
    table = Table(box=box, pad_edge=box is not SIMPLE_HEAD)
    for heading in headings:
        table.add_column(heading.removeprefix(">"), justify="right" if heading.startswith(">") else "left")
    for row in rows[:most]:
        table.add_row(*(escape(str(cell)) for cell in row))
    say(title=title)
    Screen().print(table)
    if most is not None and len(rows) > most:
        more = f"… {len(rows) - most} more; show them with --limit {len(rows)}"
        Screen().print(more, style="dim", highlight=False)


def show_facts(facts: Mapping[str, str | Text]) -> None:
    """A line a fact, its name before it."""
    table = Table(show_header=False, box=None, pad_edge=False)
    table.add_column(style="dim")
    table.add_column(overflow="fold")
    for name, text in facts.items():
        table.add_row(name, escape(text) if isinstance(text, str) else text)
    Screen().print(table)
