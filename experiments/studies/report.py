"""The report of a study as a document: what was asked, what came of it, what failed, and how to run it again."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from io import StringIO

Value = str | int | float | bool | None
"""What stands in a table."""

NONE = "–"


@dataclass(frozen=True, slots=True)
class Table:
    """A table of a study, kept as CSV.

    Attributes:
        name: stem of its file.
        columns: their heads.
        rows: one value a column.
        caption: what it shows, one sentence.
        shown: whether the report shows it; those that are long, or for machines only, are named there.
    """

    name: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Value, ...], ...]
    caption: str = ""
    shown: bool = True

    def csv(self) -> str:
        """The table as CSV with a line of heads; an empty field stands for none."""
        text = StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows([["" if value is None else value for value in row] for row in self.rows])
        return text.getvalue()


@dataclass(frozen=True, slots=True)
class Report:
    """What a report says, in this order; parts that are empty are left out, but for `failed`.

    Attributes:
        title: of the report.
        asked: what the study asks, and how it goes about it.
        lines: what the terminal showed.
        figures: file and what it shows.
        tables: of the study.
        failed: what did not get there, one line each.
        notes: where the figures differ from the published ones, and why.
        links: files and what they are, for an index.
        command: that runs it again.
        facts: seed, versions, machine, settings.
    """

    title: str
    asked: str
    lines: tuple[str, ...] = ()
    figures: tuple[tuple[str, str], ...] = ()
    tables: tuple[Table, ...] = ()
    failed: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    links: tuple[tuple[str, str], ...] = ()
    command: str = ""
    facts: tuple[tuple[str, Value], ...] = ()

    def markdown(self) -> str:
        """The report as Markdown (CommonMark with tables); pictures are linked."""
        found = [
            _code(self.lines),
            *(f"![{escape(text)}](<{path}>)" for path, text in self.figures),
            *(_shown(table) for table in self.tables if table.shown),
        ]
        repeat = [_code([self.command] if self.command else []), _facts(self.facts)]
        parts = [
            f"# {escape(self.title)}",
            escape(self.asked),
            *_section("Parts", _bullets([f"[{escape(text)}](<{path}>)" for path, text in self.links])),
            *_section("What came of it", *found),
            *_section("What failed", _bullets([escape(line) for line in self.failed or ("Nothing.",)])),
            *_section("Notes", _bullets([escape(note) for note in self.notes])),
            *_section("Run it again", *repeat),
            *_section("Tables as CSV", _bullets([_named(table) for table in self.tables])),
        ]
        return "\n\n".join(part for part in parts if part) + "\n"


def table_markdown(columns: Sequence[str], rows: Iterable[Sequence[Value]]) -> str:
    """A table; columns that hold numbers only are set to the right."""
    body = [list(row) for row in rows]
    numbers = [all(_is_number(row[i]) for row in body) and bool(body) for i in range(len(columns))]
    lines = [
        [escape(name) for name in columns],
        ["---:" if right else "---" for right in numbers],
        *([escape(shown(value)) for value in row] for row in body),
    ]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def shown(value: Value) -> str:
    """A value for people: yes and no, a dash for none, four digits of what is no whole number."""
    if value is None:
        return NONE
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.4g}" if abs(value) < 1000.0 else f"{value:.0f}"
    return str(value)


def escape(text: str) -> str:
    """Text that Markdown shows as it is, on one line."""
    text = re.sub(r"[\\`*<&|]|(?<!\w)_|_(?!\w)", lambda sign: f"\\{sign[0]}", text)
    return " ".join(text.replace("](", "]\\(").split())


def _is_number(value: Value) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))


def _section(title: str, *parts: str) -> list[str]:
    body = [part for part in parts if part]
    return [f"## {title}", *body] if body else []


def _facts(facts: Sequence[tuple[str, Value]]) -> str:
    return table_markdown(("what", "value"), facts) if facts else ""


def _bullets(lines: Sequence[str]) -> str:
    return "\n".join(f"- {line}" for line in lines)


def _code(lines: Sequence[str]) -> str:
    return "\n".join(["```text", *(line.replace("```", "'''") for line in lines), "```"]) if lines else ""


def _shown(table: Table) -> str:
    return f"{escape(table.caption)}\n\n{table_markdown(table.columns, table.rows)}".strip()


def _named(table: Table) -> str:
    return f"`{table.name}.csv`: {escape(table.caption)}" if table.caption else f"`{table.name}.csv`"
