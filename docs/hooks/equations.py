"""Equations: ```math blocks of LaTeX become MathML, which browsers typeset by themselves; nothing is fetched."""

from __future__ import annotations

import html
import re

from latex2mathml.converter import convert
from mkdocs.exceptions import PluginError

BLOCK = re.compile(r"^```math\n(.*?)^```\n", re.M | re.S)


def with_equations(markdown: str, uri: str) -> str:
    """The page with its equations as MathML, each in a box that scrolls where it is wider than the page.

    Raises:
        PluginError: an equation cannot be read.
    """

    def typeset(found: re.Match[str]) -> str:
        source = " ".join(found[1].split())
        latex = source.replace("{aligned}", "{align*}")  # the converter knows it by this name
        try:
            made = convert(latex, display="block")
        except Exception as error:  # whatever the converter makes of what is no LaTeX
            raise PluginError(f"{uri}: equation {source!r} cannot be read ({type(error).__name__}: {error})") from error
        label = html.escape(source, quote=True)
        return f'<div class="equation" role="math" tabindex="0" aria-label="{label}">{made}</div>\n'

    return BLOCK.sub(typeset, markdown)
