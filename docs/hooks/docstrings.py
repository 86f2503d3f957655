"""Griffe extension: docstrings are text, in which `B[a](x, y)` is an equation and no link."""

from __future__ import annotations

import re
from typing import Any

import griffe


class PlainBrackets(griffe.Extension):
    """Escapes what Markdown would take for a link, outside of code."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Escape the docstring of one object."""
        if obj.docstring is not None:
            obj.docstring.value = escaped(obj.docstring.value)


def escaped(text: str) -> str:
    """The text with `](` made plain, but for that in backticks and of links to pages."""
    parts = re.split(r"(`[^`]*`)", text)
    parts[::2] = [re.sub(r"\]\((?!https?://)", r"]\\(", part) for part in parts[::2]]
    return "".join(parts)
