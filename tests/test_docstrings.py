"""What is public says which errors it raises."""

from __future__ import annotations

import ast
import importlib
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
HOUSE = ("worlds", "model", "inference", "planning", "body", "agent", "views", "baselines", "experiments")
OURS = ("CogmapError", "WorldError")


def raising(package: str) -> Iterator[tuple[str, str]]:
    """Public functions and methods that raise an error of ours themselves, and their docstrings."""
    public = set(importlib.import_module(f"cogmap.{package}").__all__)
    for file in (ROOT / package).rglob("*.py"):
        for node in ast.parse(file.read_text("utf-8")).body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef) and node.name in public:
                whole = ast.get_docstring(node) or ""
                for part in [node] if isinstance(node, ast.FunctionDef) else node.body:
                    if not isinstance(part, ast.FunctionDef) or not _raises(part):
                        continue
                    if part.name in ("__init__", "__post_init__"):
                        yield f"{file}: {node.name}", whole
                    elif not part.name.startswith("_"):
                        yield f"{file}: {node.name}.{part.name}", ast.get_docstring(part) or ""


def _raises(function: ast.FunctionDef) -> bool:
    raised = (node.exc for node in ast.walk(function) if isinstance(node, ast.Raise))
    called = (exc.func for exc in raised if isinstance(exc, ast.Call))
    return any(isinstance(func, ast.Name) and func.id in OURS for func in called)


@pytest.mark.parametrize("package", HOUSE)
def test_docstrings_say_what_is_raised(package: str) -> None:
    found = dict(raising(package))
    words = ("Raises:", "raises", "refuse", "Error")
    assert not [name for name, text in found.items() if not any(word in text for word in words)]
