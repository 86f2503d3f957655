"""A report in Markdown as one HTML file that needs nothing else: pictures inside, no scripts."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Sequence
from html import escape
from itertools import pairwise
from pathlib import Path
from typing import Any

LARGEST = 1_000_000
"""Bytes of a drawing (SVG) above which the picture (PNG) is taken instead."""

_STYLE = """
:root { color-scheme: light dark; --ink: #1b1b1b; --paper: #ffffff; --line: #d0d0d0; --soft: #f4f4f4; --link: #0072b2 }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e6e6; --paper: #17191c; --line: #3c4046; --soft: #22262b; --link: #56b4e9 }
}
body { margin: 0 auto; max-width: 64rem; padding: 1rem; background: var(--paper); color: var(--ink);
  font: 1rem/1.5 system-ui, sans-serif; overflow-wrap: break-word }
h1, h2 { line-height: 1.2 }
a { color: var(--link) }
p:has(> img) { overflow-x: auto }
img { display: block; width: 100%; min-width: 38rem; height: auto; background: #ffffff; border-radius: 4px }
.wide { overflow-x: auto; margin: 1rem 0 }
table { border-collapse: collapse; font-size: 0.875rem }
th, td { padding: 0.25rem 0.6rem; border-bottom: 1px solid var(--line); text-align: left; white-space: nowrap;
  font-variant-numeric: tabular-nums }
td:nth-child(2):last-child { white-space: normal; min-width: 7rem }
code, pre { font-size: 0.85rem; background: var(--soft); border-radius: 4px }
pre { padding: 0.75rem; overflow-x: auto }
"""


def html_page(markdown: str, folder: Path) -> str:
    """The page, with the pictures that the Markdown links taken from `folder`.

    Args:
        markdown: CommonMark with tables; HTML in it is shown, not obeyed.
        folder: that links are relative to. A picture that is not there is left a link.
    """
    from markdown_it import MarkdownIt

    reader = MarkdownIt("commonmark", {"html": False}).enable("table")
    reader.add_render_rule("table_open", _table_open)
    reader.add_render_rule("table_close", _table_close)
    tokens = reader.parse(markdown)
    for token in _all(tokens):
        if token.type == "image":
            token.attrs["src"] = _inside(folder, str(token.attrs["src"]))
        elif token.type == "link_open":  # a page leads to pages
            token.attrs["href"] = re.sub(r"\.md$", ".html", str(token.attrs["href"]))
    return _page(_title(tokens), reader.renderer.render(tokens, reader.options, {}))


def _page(title: str, body: str) -> str:
    return (
        f'<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(title)}</title>\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n<style>{_STYLE}</style>\n'
        f"</head>\n<body>\n{body}</body>\n</html>\n"
    )


def _title(tokens: Sequence[Any]) -> str:
    """The text of the first heading."""
    for heading, inline in pairwise(tokens):
        if heading.type == "heading_open":
            return "".join(part.content for part in inline.children)
    return "cogmap"


def _table_open(renderer: Any, tokens: Sequence[Any], at: int, options: Any, env: Any) -> str:
    return '<div class="wide"><table>\n'


def _table_close(renderer: Any, tokens: Sequence[Any], at: int, options: Any, env: Any) -> str:
    return "</table></div>\n"


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
