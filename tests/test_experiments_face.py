"""The face of `cogmap.experiments` imports a module when it is asked for one of its names."""

from __future__ import annotations

import ast
from importlib import import_module
from pathlib import Path

import cogmap.experiments as face


def declared() -> dict[str, str]:
    """Where type checkers are told that each name comes from."""
    tree = ast.parse(Path(str(face.__file__)).read_text("utf-8"))
    block = next(node for node in tree.body if isinstance(node, ast.If))
    return {alias.name: str(node.module) for node in block.body for alias in node.names}  # type: ignore[attr-defined]


def test_every_name_is_the_one_that_type_checkers_see() -> None:
    assert sorted(declared()) == sorted(face.__all__)
    for name, module in declared().items():
        assert getattr(face, name) is getattr(import_module(f"cogmap.experiments.{module}"), name), name
