"""The Interchange Format of Bayesian networks (BIF), read and written.

A `table` lists P(child | parents) with the last parent fastest; a row `(labels of the parents)` lists one column.
"""

import re
from bisect import bisect_left
from collections.abc import Sequence
from typing import NoReturn

import numpy as np

from ...errors import CogmapError
from ..factor_graph import FactorGraph
from ..factors import FloatArray
from .network import Conditional, check_shape, conditionals_of, failed, network, texts

_TEXT = r"\"[^\"]*\""
_COMMENT = re.compile(rf"({_TEXT})|/\*.*?\*/|(?<![^\s;{{}}])//[^\n]*", re.S)
_HEAD = re.compile(rf"\s*(network|variable|probability)\b((?:{_TEXT}|[^{{\"])*)\{{")
_TYPE = re.compile(rf"\s*type\s+discrete\s*\[\s*(\d+)\s*\]\s*\{{((?:{_TEXT}|[^}}\"])*)\}}\s*;")
_PROPERTY = re.compile(rf"\s*property\b(?:{_TEXT}|[^;\"])*;")
_ROW = re.compile(rf"\s*(?:(table|default)\b|\(((?:{_TEXT}|[^)\"])*)\))([^;]*);")
_BRACE = re.compile(rf"{_TEXT}|[{{}}]")
_WORD = re.compile(r"\"([^\"]*)\"|([^\s,|\"]+)")
_PLAIN = re.compile(r"[^\s,;|(){}\[\]\"]+")


def read_bif(text: str) -> FactorGraph:
    """The factor graph of a BIF file: a variable with labels of text, and a conditional `P`, for each variable.

    Columns are scaled to sum to 1 to the last digit, as files hold rounded numbers.

    Raises:
        CogmapError: the text is malformed; it names the line.
    """
    return _Reader(_COMMENT.sub(lambda found: found[1] or _blank(found), text)).graph()


def write_bif(graph: FactorGraph) -> str:
    """The graph as BIF text, with every digit; labels are written as text, evidence is not.

    Raises:
        CogmapError: it is no Bayesian network, or a name or label cannot be written.
    """
    labels = texts("BIF", graph)
    lines = ["network cogmap {", "}"]
    for name, domain in labels.items():
        listed = ", ".join(map(_quoted, domain))
        lines += [f"variable {_quoted(name)} {{", f"  type discrete [ {len(domain)} ] {{ {listed} }};", "}"]
    for factor in conditionals_of("BIF", graph):
        child, *parents = [variable.name for variable in factor.scope]
        given = f" | {', '.join(map(_quoted, parents))}" if parents else ""
        lines.append(f"probability ( {_quoted(child)}{given} ) {{")
        values = factor.dense()
        for at in np.ndindex(*values.shape[1:]):
            row = ", ".join(_quoted(labels[parent][i]) for parent, i in zip(parents, at, strict=True))
            numbers = ", ".join(map(repr, values[(slice(None), *at)].tolist()))
            lines.append(f"  {f'({row})' if parents else 'table'} {numbers};")
        lines.append("}")
    return "\n".join(lines) + "\n"


def _quoted(text: str) -> str:
    if _PLAIN.fullmatch(text) and "//" not in text:
        return text
    if '"' in text or "\n" in text or not text:
        raise CogmapError(f"BIF: cannot write {text!r}; rename it, without quotation marks and line breaks")
    return f'"{text}"'


class _Reader:
    """Blocks of the text one after the other, then their graph."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.breaks = [found.start() for found in re.finditer("\n", text)]
        self.domains: dict[str, Sequence[str]] = {}
        self.lines: dict[str, int] = {}
        self.conditionals: list[Conditional] = []

    def graph(self) -> FactorGraph:
        at = 0
        while found := _HEAD.match(self.text, at):
            end = self._end(found.end())
            words = _words(found[2].strip().removeprefix("(").removesuffix(")"))
            if found[1] == "variable":
                self._variable(words, found.end(), end)
            elif found[1] == "probability":
                self._probability(words, found.end(), end)
            at = end + 1
        if self.text[at:].strip():
            self._fail(
                len(self.text) - len(self.text[at:].lstrip()), "expected 'variable' or 'probability' and a block"
            )
        if not self.domains:
            self._fail(0, "there are no variables; is this a BIF file?")
        return network("BIF", self.domains, self.lines, self.conditionals)

    def _variable(self, words: Sequence[str], begin: int, end: int) -> None:
        found, at = None, begin
        while True:
            part = _TYPE.match(self.text, at, end) or _PROPERTY.match(self.text, at, end)
            if part is None:
                break
            found = part if part.re is _TYPE else found
            at = part.end()
        if len(words) != 1 or found is None or self.text[at:end].strip():
            self._fail(begin, "expected 'variable NAME { type discrete [ n ] { labels }; }'")
        labels = _words(found[2])
        if words[0] in self.domains:
            self._fail(begin, f"a second variable {words[0]!r}; rename it")
        if str(len(labels)) != found[1].lstrip("0") or len(set(labels)) < len(labels):
            self._fail(found.start(1), f"{words[0]!r} has {len(set(labels))} labels, not {found[1]}")
        self.domains[words[0]], self.lines[words[0]] = labels, self._line(begin)

    def _probability(self, words: Sequence[str], begin: int, end: int) -> None:
        if unknown := [word for word in words if word not in self.domains]:
            self._fail(begin, f"unknown variable {unknown[0]!r}; declare it before its table")
        if not words or len(set(words)) < len(words):
            self._fail(begin, "expected 'probability ( CHILD | PARENTS )', each variable once")
        child, *parents = words
        index = [{label: i for i, label in enumerate(self.domains[parent])} for parent in parents]
        shape = [len(self.domains[word]) for word in words]
        check_shape("BIF", self._line(begin), shape)
        values = np.full(shape, np.nan)
        at = begin
        while found := _ROW.match(self.text, at, end) or _PROPERTY.match(self.text, at, end):
            if found.re is _ROW:
                self._row(found, values, index)
            at = found.end()
        rest = self.text[at:end].lstrip()
        if rest:
            self._fail(end - len(rest), "expected 'table', 'default' or '(labels)' with numbers, and a semicolon")
        self.conditionals.append(Conditional(child, parents, values, self._line(begin)))

    def _row(self, found: re.Match[str], values: FloatArray, index: Sequence[dict[str, int]]) -> None:
        """Fill in one entry of a block: a table, the default of what is not listed, or one column."""
        numbers = self._numbers(found)
        try:
            if found[1] == "table":
                values[...] = np.reshape(numbers, values.shape)
            elif found[1] == "default":
                column = np.reshape(numbers, (len(values), *[1] * len(index)))
                values[...] = np.where(np.isnan(values), column, values)
            else:
                labels = _words(found[2])
                at = tuple([own[label] for own, label in zip(index, labels, strict=True)])
                values[(slice(None), *at)] = numbers
        except (KeyError, ValueError):
            self._fail(
                found.start(3),
                f"{len(numbers)} numbers{f' for ({found[2]})' if found[2] else ''} do not fit a "
                f"table of {' x '.join(map(str, values.shape))}, or a label is unknown",
            )

    def _numbers(self, found: re.Match[str]) -> list[float]:
        try:
            return [float(word) for word in found[3].replace(",", " ").split()]
        except ValueError as error:
            self._fail(found.start(3), f"{error}; give numbers")

    def _end(self, begin: int) -> int:
        """Where the block that begins there ends."""
        depth, at = 1, begin
        for found in _BRACE.finditer(self.text, begin):
            depth += {"{": 1, "}": -1}.get(found[0], 0)
            at = found.start()
            if depth == 0:
                return at
        self._fail(begin, "the block that begins here does not end; add '}'")

    def _line(self, at: int) -> int:
        return bisect_left(self.breaks, at) + 1

    def _fail(self, at: int, why: str) -> NoReturn:
        raise failed("BIF", self._line(at), why)


def _words(text: str) -> list[str]:
    return [quoted or word for quoted, word in _WORD.findall(text)]


def _blank(found: re.Match[str]) -> str:
    """As many spaces and line breaks: what follows stays where it is."""
    return re.sub(r"[^\n]", " ", found[0])
