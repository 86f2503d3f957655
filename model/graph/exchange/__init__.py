"""Factor graphs in the files of other programs: BIF, XMLBIF, UAI, GraphML."""

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import TypeVar

from ...errors import CogmapError
from ...files import write_whole
from ...reading import read_file
from ..factor_graph import FactorGraph
from .bif import read_bif, write_bif
from .graphml import write_graphml
from .uai import read_uai, read_uai_evidence, write_uai, write_uai_evidence
from .xmlbif import read_xmlbif, write_xmlbif

__all__ = [
    "load_graph", "read_bif", "read_uai", "read_uai_evidence", "read_xmlbif", "save_graph", "write_bif",
    "write_graphml", "write_uai", "write_uai_evidence", "write_xmlbif",
]  # fmt: skip

T = TypeVar("T")

LARGEST = 64 * 2**20
"""Bytes of the largest file of a graph that is read."""

_READ: dict[str, Callable[[str], FactorGraph]] = {
    ".bif": read_bif,
    ".xmlbif": read_xmlbif,
    ".bifxml": read_xmlbif,
    ".xml": read_xmlbif,
    ".uai": read_uai,
    ".json": FactorGraph.from_json,
}
_WRITE: dict[str, Callable[[FactorGraph], str]] = {
    ".bif": write_bif,
    ".xmlbif": write_xmlbif,
    ".bifxml": write_xmlbif,
    ".xml": write_xmlbif,
    ".uai": write_uai,
    ".json": FactorGraph.to_json,
    ".graphml": write_graphml,
    ".dot": FactorGraph.to_dot,
}


def load_graph(path: str | PathLike[str], *, evidence: str | PathLike[str] | None = None) -> FactorGraph:
    """The factor graph of a file, by its suffix: `.bif`, `.xmlbif` (`.bifxml`, `.xml`), `.uai`, `.json`.

    Args:
        path: the file.
        evidence: a UAI file of evidence about it, which the graph then has.

    Raises:
        CogmapError: the suffix is unknown, the file cannot be read, or is malformed; it names file and line.
    """
    read = _by_suffix(_READ, Path(path))
    graph = _of(Path(path), read)
    if evidence is not None:
        graph = graph.observe_all(_of(Path(evidence), lambda text: read_uai_evidence(text, graph)))
    return graph


def save_graph(graph: FactorGraph, path: str | PathLike[str]) -> None:
    """Write the graph to a file, by its suffix: those of `load_graph`, `.graphml` and `.dot`.

    Raises:
        CogmapError: the suffix is unknown, the format cannot hold the graph, or the file cannot be written.
    """
    text = _by_suffix(_WRITE, Path(path))(graph)
    try:
        write_whole(Path(path), text.encode())
    except UnicodeEncodeError as error:
        raise CogmapError(f"{path}: a name or label is no text ({error.reason}); rename it") from error


def _by_suffix(known: dict[str, T], path: Path) -> T:
    if path.suffix.lower() not in known:
        raise CogmapError(f"{path}: unknown suffix {path.suffix!r}; choose one of {', '.join(known)}")
    return known[path.suffix.lower()]


def _of(path: Path, read: Callable[[str], T]) -> T:
    try:
        return read(read_file(path, most=LARGEST).decode("utf-8"))
    except CogmapError as error:
        raise error if str(error).startswith(str(path)) else CogmapError(f"{path}: {error}") from error
    except (OSError, UnicodeDecodeError) as error:
        raise CogmapError(f"{path}: cannot be read ({error}); give a text file") from error
    except (ArithmeticError, LookupError, MemoryError, RecursionError, TypeError, ValueError) as error:
        why = " ".join(f"{type(error).__name__}: {error}".split())[:300]
        raise CogmapError(f"{path}: cannot be understood ({why}); export it again") from error
