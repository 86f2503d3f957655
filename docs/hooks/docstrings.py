"""Griffe extension: what stands beside the fields of a record is in its docstring, and brackets are no links."""

from __future__ import annotations

import ast
import re
from textwrap import dedent
from typing import Any

import griffe


class PlainBrackets(griffe.Extension):
    """Escapes what Markdown would take for a link, outside of code; and tells of fields what is said beside them."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Mend the docstring of one object."""
        if obj.docstring is not None:
            told = fields_told(obj.source) if isinstance(obj, griffe.Class) else {}
            fields = "".join(f"\n    {name}: {text}." for name, text in told.items())
            own = obj.docstring.value + (f"\n\nAttributes:{fields}" if fields else "")
            obj.docstring.value = escaped(own)


def fields_told(source: str) -> dict[str, str]:
    """What the comments of a class say of its fields, each behind its field or in the lines before it."""
    lines, told = dedent(source).splitlines(), dict[str, str]()
    found = ast.parse("\n".join(lines)).body[0] if lines else None
    for part in found.body if isinstance(found, ast.ClassDef) else ():
        if isinstance(part, ast.AnnAssign) and isinstance(part.target, ast.Name):
            before = part.lineno - 1
            while lines[before - 1].lstrip().startswith("# "):
                before -= 1
            above = " ".join(line.strip().removeprefix("# ") for line in lines[before : part.lineno - 1])
            _, _, beside = lines[part.lineno - 1].partition("  # ")
            if text := (above or beside).partition("pyright:")[0].strip():
                told[part.target.id] = text
    return told


def escaped(text: str) -> str:
    """The text with `](` made plain, but for that in backticks and of links to pages."""
    parts = re.split(r"(`[^`]*`)", text)
    parts[::2] = [re.sub(r"\]\((?!https?://)", r"]\\(", part) for part in parts[::2]]
    return "".join(parts)
