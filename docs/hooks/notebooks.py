"""Notebooks of the repository as pages: every cell is run by the build, and shown with what it prints and draws.

The last value of a cell is shown as Jupyter shows it, by its HTML, its SVG, its figure or its text. Nothing of Jupyter
is needed for that.
"""

from __future__ import annotations

import ast
import contextlib
import io
import json
import os
import tempfile
import traceback
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import running
from mkdocs.exceptions import PluginError

os.environ["MPLBACKEND"] = "Agg"


@dataclass(slots=True)
class Cell:
    """A cell after it was run.

    Attributes:
        kind: markdown or code.
        source: its text.
        printed: what it printed.
        shown: HTML or SVG of its last value, on one line.
        text: its last value as text, where it has no HTML.
        figure: its last value as PNG, where it is a figure or axes.
    """

    kind: str
    source: str
    printed: str = ""
    shown: str = ""
    text: str = ""
    figure: bytes = b""


@dataclass(slots=True)
class Page:
    """Markdown of a notebook, and its pictures by file name."""

    markdown: str
    pictures: dict[str, bytes] = field(default_factory=dict[str, bytes])


def run_notebook(path: Path, *, dark: bool = False) -> list[Cell]:
    """Run the code of a notebook in an empty folder, cell after cell in one namespace; `dark` draws for the dark theme.

    Raises:
        PluginError: a cell failed.
    """
    namespace: dict[str, Any] = {"__name__": "__main__"}
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), running.drawn(dark=dark):
        return [_run(cell, namespace, path.name) for cell in _cells(path)]


def notebook_page(path: Path) -> Page:
    """The page of a notebook, its cells run.

    Raises:
        PluginError: a cell failed.
    """
    lines, pictures = list[str](), dict[str, bytes]()
    cells = run_notebook(path)
    drawing = any(cell.figure or "<svg" in cell.shown for cell in cells)
    twins = run_notebook(path, dark=True) if drawing else cells
    for number, (cell, other) in enumerate(zip(cells, twins, strict=True)):
        if cell.kind == "markdown":
            lines += [cell.source, ""]
            continue
        lines += [f"```python\n{cell.source}\n```", ""]
        if said := "\n".join(part for part in (cell.printed.rstrip(), cell.text) if part):
            lines += [f"``` {{ .text .output }}\n{said}\n```", ""]
        if cell.shown:
            both = "<svg" in cell.shown and other is not cell
            lines += [f'<div class="shown{" only-light" * both}">{cell.shown}</div>', ""]
            lines += [f'<div class="shown only-dark">{other.shown}</div>', ""] if both else []
        if cell.figure:
            name = f"cell-{number}.png"
            pictures |= {name: cell.figure, running.twin(name): other.figure}
            lines += [*running.images("", f"../drawn/examples/{path.stem}/{name}", both=True), ""]
    lines += [f"This page is the notebook [{path.name}]({path.name}), run when it was built.", ""]
    return Page("\n".join(lines), pictures)


def _cells(path: Path) -> Iterator[Cell]:
    for cell in json.loads(path.read_text("utf-8"))["cells"]:
        yield Cell(cell["cell_type"], "".join(cell["source"]))


def _run(cell: Cell, namespace: dict[str, Any], name: str) -> Cell:
    if cell.kind != "code":
        return cell
    printed = io.StringIO()
    try:
        tree = ast.parse(cell.source)
        last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
        with contextlib.redirect_stdout(printed):
            exec(compile(tree, name, "exec"), namespace)
            value = eval(compile(ast.Expression(last.value), name, "eval"), namespace) if last else None
    except Exception as error:
        raise PluginError(f"{name}: a cell fails:\n{cell.source}\n{traceback.format_exc()}") from error
    cell.printed = printed.getvalue()
    _show(cell, value)
    return cell


def _show(cell: Cell, value: Any) -> None:
    """What Jupyter would show of a value."""
    if value is None:
        return
    figure = getattr(value, "figure", None) or value
    if hasattr(figure, "savefig"):
        buffer = io.BytesIO()
        figure.savefig(buffer, format="png")
        cell.figure = buffer.getvalue()
        return
    pages = (getattr(value, name, lambda: None)() for name in ("_repr_html_", "_repr_svg_"))
    found = next((page for page in pages if page), None)
    if found is None:
        cell.text = repr(value)
    else:
        cell.shown = " ".join(found.split("\n"))
