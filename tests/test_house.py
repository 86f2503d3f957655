"""Imports of the library run one way: folders meet at their faces, and there are no circles, not even in functions."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import networkx as nx
import pytest

ROOT = Path(__file__).resolve().parents[1]
HOUSE = ("worlds", "model", "inference", "planning", "body", "agent", "views", "baselines", "behaviour", "experiments")


def module_of(file: Path, root: Path) -> str:
    return ".".join(file.relative_to(root).with_suffix("").parts).removesuffix(".__init__")


def imports(file: Path, root: Path, modules: set[str]) -> Iterator[str]:
    """The modules of ours that a file names anywhere: at its top, in functions, and for type checking."""
    name = module_of(file, root)
    package = name if file.name == "__init__.py" else name.rpartition(".")[0]
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name.removeprefix("cogmap.") for alias in node.names if alias.name.startswith("cogmap."))
        if not isinstance(node, ast.ImportFrom) or not (node.level or (node.module or "").startswith("cogmap.")):
            continue
        base = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
        home = ".".join([*base, *(node.module or "").removeprefix("cogmap.").split(".")]).strip(".")
        face = exported(root / home.replace(".", "/") / "__init__.py")
        for alias in node.names:
            inner = f"{home}.{alias.name}".strip(".")
            yield inner if inner in modules and alias.name not in face else home


def exported(face: Path) -> set[str]:
    """The names in `__all__`: one of them may be that of a module as well."""
    nodes = ast.walk(ast.parse(face.read_text("utf-8"))) if face.exists() else ()
    lists = (
        node.value for node in nodes if isinstance(node, ast.Assign) and "__all__" in map(ast.unparse, node.targets)
    )
    return {name for listed in lists for name in ast.literal_eval(listed)}


def graph_of(root: Path) -> nx.DiGraph:
    files = {module_of(file, root): file for top in HOUSE for file in sorted((root / top).rglob("*.py"))}
    graph = nx.DiGraph()
    for name, file in files.items():
        graph.add_edges_from((name, to) for to in imports(file, root, set(files)) if to != name)
    return graph


def past_faces(graph: nx.DiGraph) -> list[tuple[str, str]]:
    return [(a, b) for a, b in graph.edges if a.split(".")[0] != b.split(".")[0] and "." in b]


def circles(graph: nx.DiGraph) -> list[set[str]]:
    return [part for part in nx.strongly_connected_components(graph) if len(part) > 1]


@pytest.fixture(scope="module")
def house() -> nx.DiGraph:
    return graph_of(ROOT)


def test_folders_import_each_other_through_their_faces(house: nx.DiGraph) -> None:
    assert len(house) > 100
    assert past_faces(house) == []


def test_there_are_no_circles(house: nx.DiGraph) -> None:
    assert circles(house) == []


def test_what_is_looked_for_is_found(tmp_path: Path) -> None:
    for top in HOUSE:
        (tmp_path / top).mkdir()
        (tmp_path / top / "__init__.py").touch()
    (tmp_path / "model" / "one.py").write_text("def f():\n    from .two import g\n", "utf-8")
    (tmp_path / "model" / "two.py").write_text("if TYPE_CHECKING:\n    from . import one\n", "utf-8")
    (tmp_path / "agent" / "deep.py").write_text("from ..model.one import f\nfrom ..model import one\n", "utf-8")
    graph = graph_of(tmp_path)
    assert circles(graph) == [{"model.one", "model.two"}]
    assert past_faces(graph) == [("agent.deep", "model.one")]
