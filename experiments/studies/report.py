"""Reports: Markdown, and the same as one HTML file that needs nothing else."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Mapping, Sequence
from html import escape as html_escape
from pathlib import Path
from typing import Any

from .tables import Table, Value

NONE = "–"
LARGEST = 1_000_000  # bytes of a drawing (SVG) above which a page holds the picture (PNG) instead
STYLE = Path(__file__).with_name("report.css")


def markdown(title: str, text: str, sections: Mapping[str, Sequence[str]]) -> str:
    """A document (CommonMark with tables); sections in which nothing stands are left out."""
    parts = [f"# {escape(title)}", escape(text)]
    for head, body in sections.items():
        parts += [f"## {head}", *filter(None, body)] if any(body) else []
    return "\n\n".join(parts) + "\n"


def bullets(lines: Sequence[str]) -> str:
    """A list of plain text."""
    return "\n".join(f"- {escape(line)}" for line in lines)


def code(lines: Sequence[str]) -> str:
    """Lines as they are."""
    return "\n".join(["```text", *(line.replace("```", "'''") for line in lines), "```"])


def table_markdown(table: Table) -> str:
    """A table under its caption; columns that hold numbers only are set to the right."""
    numbers = [bool(table.rows) and all(_is_number(row[i]) for row in table.rows) for i in range(len(table.columns))]
    lines = [
        [escape(name) for name in table.columns],
        ["---:" if right else "---" for right in numbers],
        *([escape(shown(value)) for value in row] for row in table.rows),
    ]
    return "\n".join(
        [*([escape(table.caption), ""] if table.caption else []), *(f"| {' | '.join(x)} |" for x in lines)]
    )


def shown(value: Value) -> str:
    """A value for people: yes and no, a dash for none, four digits of what is no whole number."""
    if value is None or isinstance(value, bool):
        return {None: NONE, True: "yes", False: "no"}[value]
    if isinstance(value, float):
        return f"{value:.4g}" if abs(value) < 1000.0 else f"{value:.0f}"
    return str(value)


def escape(text: str) -> str:
    """Text that Markdown shows as it is, on one line."""
    text = re.sub(r"[\\`*<&|]|(?<!\w)_|_(?!\w)", lambda sign: f"\\{sign[0]}", text)
    return " ".join(text.replace("](", "]\\(").split())


def html_page(text: str, folder: Path) -> str:
    """The page without scripts, the pictures that the Markdown links inside.

    Args:
        text: CommonMark with tables; HTML in it is shown, not obeyed.
        folder: that links are relative to. A picture that is not there is left a link.
    """
    from markdown_it import MarkdownIt

    reader = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = reader.parse(text)
    for token in _all(tokens):
        if token.type == "image":
            token.attrs["src"] = _inside(folder, str(token.attrs["src"]))
        elif token.type == "link_open":  # a page leads to pages
            token.attrs["href"] = re.sub(r"\.md$", ".html", str(token.attrs["href"]))
    heading = next(token for token in tokens if token.type == "inline")
    title = html_escape("".join(part.content for part in heading.children or ()))
    body = reader.renderer.render(tokens, reader.options, {})
    body = body.replace("<table>", '<div class="wide"><table>').replace("</table>", "</table></div>")
    return (
        f'<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{title}</title>\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<style>\n{STYLE.read_text('utf-8')}</style>\n</head>\n<body>\n{body}</body>\n</html>\n"
    )


def _is_number(value: Value) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))


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
