"""XMLBIF, read and written: a `TABLE` lists P(child | parents) with the child fastest, then the last parent."""

from __future__ import annotations

from dataclasses import dataclass, field
from html import escape
from typing import NoReturn
from xml.parsers import expat

import numpy as np

from ..factor_graph import FactorGraph
from .network import Conditional, check_shape, conditionals_of, failed, network, texts

_HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<BIF VERSION="0.3">
<NETWORK>
<NAME>cogmap</NAME>"""


DEEPEST = 50  # elements within one another


@dataclass(slots=True)
class _Element:
    """An element of the text: its tag in capitals, its first line, its text, and what stands in it."""

    tag: str
    line: int
    parts: list[str] = field(default_factory=list[str])
    inside: list[_Element] = field(default_factory=list["_Element"])

    @property
    def text(self) -> str:
        return "".join(self.parts)

    def all(self, *tags: str) -> list[_Element]:
        return [each for each in self.inside if each.tag in tags]


def read_xmlbif(text: str) -> FactorGraph:
    """The factor graph of an XMLBIF file, as `read_bif` gives it.

    Raises:
        CogmapError: the text is malformed; it names the line.
    """
    root = _parsed(text)
    networks = [root] if root.tag == "NETWORK" else root.all("NETWORK")
    if len(networks) != 1:
        _fail(root, f"{len(networks)} elements NETWORK; there must be one")
    domains: dict[str, list[str]] = {}
    lines: dict[str, int] = {}
    for each in networks[0].all("VARIABLE"):
        name, labels = _only(each, "NAME"), [label.text.strip() for label in each.all("OUTCOME", "VALUE")]
        if name in domains or not labels or len(set(labels)) < len(labels):
            _fail(each, f"variable {name!r} is there twice, or its outcomes are missing or not different")
        domains[name], lines[name] = labels, each.line
    if not domains:
        _fail(networks[0], "there are no variables; is this an XMLBIF file?")
    conditionals = [_conditional(each, domains) for each in networks[0].all("DEFINITION", "PROBABILITY")]
    return network("XMLBIF", domains, lines, conditionals)


def write_xmlbif(graph: FactorGraph) -> str:
    """The graph as XMLBIF text, with every digit; labels are written as text, evidence is not.

    Raises:
        CogmapError: it is no Bayesian network.
    """
    lines = [_HEAD]
    for name, labels in texts("XMLBIF", graph).items():
        outcomes = "".join(f"<OUTCOME>{escape(label, quote=False)}</OUTCOME>" for label in labels)
        lines.append(f'<VARIABLE TYPE="nature"><NAME>{escape(name, quote=False)}</NAME>{outcomes}</VARIABLE>')
    for factor in conditionals_of("XMLBIF", graph):
        child, *parents = [escape(variable.name, quote=False) for variable in factor.scope]
        given = "".join(f"<GIVEN>{parent}</GIVEN>" for parent in parents)
        numbers = " ".join(map(repr, np.moveaxis(factor.dense(), 0, -1).ravel().tolist()))
        lines.append(f"<DEFINITION><FOR>{child}</FOR>{given}<TABLE>{numbers}</TABLE></DEFINITION>")
    return "\n".join([*lines, "</NETWORK>", "</BIF>"]) + "\n"


def _conditional(element: _Element, domains: dict[str, list[str]]) -> Conditional:
    child, parents = _only(element, "FOR"), [each.text.strip() for each in element.all("GIVEN")]
    scope = [child, *parents]
    if unknown := [name for name in scope if name not in domains]:
        _fail(element, f"unknown variable {unknown[0]!r}; declare it")
    if len(set(scope)) < len(scope):
        _fail(element, f"a variable is named twice in the table of {child!r}")
    words = _only(element, "TABLE").split()
    shape = [len(domains[name]) for name in scope]
    check_shape("XMLBIF", element.line, shape)
    try:
        values = np.array([float(word) for word in words]).reshape([*shape[1:], shape[0]])
    except ValueError as error:
        _fail(element.all("TABLE")[0], f"the table of {child!r} ({len(words)} words) does not fit {shape}: {error}")
    return Conditional(child, parents, np.moveaxis(values, -1, 0), element.line)


def _only(element: _Element, tag: str) -> str:
    found = element.all(tag)
    if len(found) != 1:
        _fail(element, f"{len(found)} elements {tag} in a {element.tag}; there must be one")
    return found[0].text.strip()


def _parsed(text: str) -> _Element:
    top = _Element("", 1)
    path = [top]
    parser = expat.ParserCreate(encoding="UTF-8")  # the text is decoded already, whatever it declares

    def begin(tag: str, _: object) -> None:
        if len(path) > DEEPEST:
            raise failed("XMLBIF", parser.CurrentLineNumber, "elements are nested too deeply; mend it")
        path.append(_Element(tag.upper(), parser.CurrentLineNumber))
        path[-2].inside.append(path[-1])

    def entity(name: str, *_: object) -> None:
        raise failed(
            "XMLBIF", parser.CurrentLineNumber, f"it declares an entity {name[:40]!r}; write out what it means"
        )

    def end(_: str) -> None:
        path.pop()

    def characters(data: str) -> None:
        path[-1].parts.append(data)

    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = begin, end, characters
    parser.EntityDeclHandler = entity  # a few that speak of one another can stand for any length
    try:
        parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        raise failed("XMLBIF", error.lineno, f"no XML ({expat.ErrorString(error.code)}); mend it") from error
    return top.inside[0]


def _fail(element: _Element, why: str) -> NoReturn:
    raise failed("XMLBIF", element.line, why)
