"""The report of a study: as Markdown, and as one HTML file that needs nothing else."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape as html_escape
from pathlib import Path
from typing import Any

from .tables import Table, Value

NONE = "–"
LARGEST = 1_000_000
"""Bytes of a drawing (SVG) above which a page holds the picture (PNG) instead."""
STYLE = Path(__file__).with_name("report.css")


@dataclass(frozen=True, slots=True)
class Report:
    """What a report says, in this order; parts that are empty are left out, but for `failed`.

    Attributes:
        title: of the report.
        question: what the study asks, and how it goes about it.
        links: files and what they are, for an index.
        lines: what the terminal showed.
        figures: file and what it shows.
        tables: of the study.
        failed: what did not get there, one line each.
        notes: where the figures differ from the published ones, and why.
        command: that runs it again.
        facts: seed, versions, machine, settings.
    """

    title: str
    question: str
    links: Sequence[tuple[str, str]] = ()
    lines: Sequence[str] = ()
    figures: Sequence[tuple[str, str]] = ()
    tables: Sequence[Table] = ()
    failed: Sequence[str] = ()
    notes: Sequence[str] = ()
    command: str = ""
    facts: Sequence[tuple[str, Value]] = ()

    def markdown(self) -> str:
        """The report as Markdown (CommonMark with tables); pictures are linked."""
        pictures = [f"![{escape(text)}](<{path}>)" for path, text in self.figures]
        shown_ = [
            f"{escape(table.caption)}\n\n{table_markdown(table.columns, table.rows)}".strip()
            for table in self.tables
            if table.shown
        ]
        sections = {
            "Parts": [_bullets(f"[{escape(text)}](<{path}>)" for path, text in self.links)],
            "What came of it": [_code(self.lines), *pictures, *shown_],
            "What failed": [_bullets(escape(line) for line in self.failed or ("Nothing.",))],
            "Notes": [_bullets(escape(note) for note in self.notes)],
            "Run it again": [_code([self.command] if self.command else []), _facts(self.facts)],
            "Tables as CSV": [_bullets(_named(table) for table in self.tables)],
        }
        parts = [f"# {escape(self.title)}", escape(self.question)]
        for title, body in sections.items():
            parts += [f"## {title}", *filter(None, body)] if any(body) else []
        return "\n\n".join(parts) + "\n"


def table_markdown(columns: Sequence[str], rows: Sequence[Sequence[Value]]) -> str:
    """A table; columns that hold numbers only are set to the right."""
    numbers = [bool(rows) and all(_is_number(row[i]) for row in rows) for i in range(len(columns))]
    lines = [
        [escape(name) for name in columns],
        ["---:" if right else "---" for right in numbers],
        *([escape(shown(value)) for value in row] for row in rows),
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


def html_page(markdown: str, folder: Path) -> str:
    """The page without scripts, the pictures that the Markdown links inside.

    Args:
        markdown: CommonMark with tables; HTML in it is shown, not obeyed.
        folder: that links are relative to. A picture that is not there is left a link.
    """
    from markdown_it import MarkdownIt

    reader = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = reader.parse(markdown)
    for token in _all(tokens):
        if token.type == "image":
            token.attrs["src"] = _inside(folder, str(token.attrs["src"]))
        elif token.type == "link_open":  # a page leads to pages
            token.attrs["href"] = re.sub(r"\.md$", ".html", str(token.attrs["href"]))
    heading = next(token for token in tokens if token.type == "inline")
    title = "".join(part.content for part in heading.children or ())
    body = reader.renderer.render(tokens, reader.options, {})
    body = body.replace("<table>", '<div class="wide"><table>').replace("</table>", "</table></div>")
    return (
        f'<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{html_escape(title)}</title>\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<style>{STYLE.read_text('utf-8')}</style>\n</head>\n<body>\n{body}</body>\n</html>\n"
    )


def _is_number(value: Value) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))


def _facts(facts: Sequence[tuple[str, Value]]) -> str:
    return table_markdown(("what", "value"), facts) if facts else ""


def _bullets(lines: Iterable[str]) -> str:
    return "\n".join(f"- {line}" for line in lines)


def _code(lines: Sequence[str]) -> str:
    return "\n".join(["```text", *(line.replace("```", "'''") for line in lines), "```"]) if lines else ""


def _named(table: Table) -> str:
    return f"`{table.name}.csv`" + (f": {escape(table.caption)}" if table.caption else "")


def _all(tokens: Sequence[Any]) -> list[Any]:
    return [part for token in tokens for part in (token, *_all(token.children or ()))]


def _inside(folder: Path, name: str) -> str:
    """The picture as a data URI, drawn if the drawing beside it is not too large."""
    picture = folder / name
    drawing = picture.with_suffix(".svg")
    if drawing.is_file() and drawing.stat().st_size <= LARGEST:
        picture = drawing
    kind = "svg+xml" if picture.suffix == ".svg" else "png"
    return f"data:image/{kind};base64,{b64encode(picture.read_bytes()).decode()}" if picture.is_file() else name
