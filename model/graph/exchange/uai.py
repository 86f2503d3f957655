"""The format of the UAI competitions, read and written: any factors, over variables that have numbers.

Tables list the last variable of a scope fastest; in a network of type BAYES that is the child.
"""

import math
import re
from collections.abc import Hashable, Mapping
from typing import NoReturn

import numpy as np

from ...errors import CogmapError
from ..factor_graph import FactorGraph
from ..factors import FloatArray
from .network import LARGEST, MOST, check_shape, conditionals_of, failed

MOST_LABELS = 100_000  # labels of all variables together, besides one for each word of the file


def read_uai(text: str, evidence: str | None = None) -> FactorGraph:
    """The factor graph of a UAI file: variables `x0`, `x1`, … with labels 0, 1, …, and factors `f0`, `f1`, ….

    Args:
        text: the file; the children of a network of type BAYES come first in the scopes of the graph.
        evidence: text of a file of evidence, which the graph then has.

    Raises:
        CogmapError: a text is malformed; it names the line.
    """
    words = _Words("UAI", text)
    kind = words.word("'MARKOV' or 'BAYES'").upper()
    if kind not in ("MARKOV", "BAYES"):
        words.fail(f"the network is of type {kind[:40]!r}; expected 'MARKOV' or 'BAYES'")
    graph = FactorGraph()
    labels = 0
    for i in range(words.integer("the number of variables", 1)):
        count = words.integer(f"the number of labels of variable {i}", 1)
        labels += count
        if labels > MOST_LABELS + len(words.words):
            words.fail(f"its variables have {labels:,} labels and more; no table could tell of so many")
        graph.variable(f"x{i}", range(count))
    variables = graph.variables
    scopes: list[list[int]] = []
    for at in range(words.integer("the number of factors", 0)):
        size = words.integer(f"the size of factor {at}", 0)
        scopes.append([words.integer(f"a variable of factor {at}", 0, len(variables)) for _ in range(size)])
        if len(set(scopes[-1])) < size:
            words.fail(f"factor {at} has a variable twice; name each once")
    for at, scope in enumerate(scopes):
        shape = [variables[i].cardinality for i in scope]
        if len(shape) > MOST or math.prod(shape) > LARGEST:
            check_shape("UAI", words.line, shape)
        count = words.integer(f"the number of entries of factor {at}", 0)
        if count != math.prod(shape):
            words.fail(f"factor {at} has {count} entries; its variables need {math.prod(shape)}")
        values = words.numbers(f"factor {at}", count).reshape(shape)
        if kind == "BAYES" and scope:
            scope, values = [scope[-1], *scope[:-1]], np.moveaxis(values, -1, 0)
        if not scope:  # a plain number: hung on a variable, since factors have one at least
            scope, values = [0], np.full(variables[0].cardinality, values)
        graph.factor(f"f{at}", [variables[i] for i in scope], values)
    words.end()
    return graph if evidence is None else graph.observe_all(read_uai_evidence(evidence, graph))


def read_uai_evidence(text: str, graph: FactorGraph) -> dict[str, Hashable]:
    """Evidence by name, from a UAI file of evidence about the variables of a graph, by number.

    Both layouts are read: `n variable label …`, and that with the number of samples, 1, before it.

    Raises:
        CogmapError: the text is malformed; it names the line.
    """
    words = _Words("UAI evidence", text)
    if not words.words:
        return {}
    first = words.integer("the number of observed variables", 0)
    if len(words.words) % 2 == 0:  # the number of samples comes first
        if first > 1:
            words.fail(f"{first} samples of evidence; give a file for each")
        first = words.integer("the number of observed variables", 0) if first else 0
    evidence: dict[str, Hashable] = {}
    for _ in range(first):
        variable = graph.variables[words.integer("a variable", 0, len(graph.variables))]
        evidence[variable.name] = variable.domain[words.integer(f"a label of {variable.name}", 0, variable.cardinality)]
    words.end()
    return evidence


def write_uai(graph: FactorGraph, *, bayes: bool = False) -> str:
    """The graph as UAI text, with every digit: variables and labels by number; evidence is a file of its own.

    Args:
        graph: the graph.
        bayes: write a network of type BAYES, which it must be; else of type MARKOV.

    Raises:
        CogmapError: a sparse factor is too large to write out, or it is no Bayesian network.
    """
    factors = conditionals_of("UAI", graph) if bayes else graph.factors
    number = graph.wiring.number
    lines = ["BAYES" if bayes else "MARKOV", str(len(graph.variables))]
    lines += [" ".join(str(variable.cardinality) for variable in graph.variables), str(len(factors))]
    tables: list[str] = []
    for factor in factors:
        scope, values = [number[variable.name] for variable in factor.scope], factor.dense()
        if bayes:
            scope, values = [*scope[1:], scope[0]], np.moveaxis(values, 0, -1)
        lines.append(" ".join(map(str, [len(scope), *scope])))
        tables += ["", str(values.size), " ".join(map(repr, values.ravel().tolist()))]
    return "\n".join([*lines, *tables]) + "\n"


def write_uai_evidence(graph: FactorGraph, evidence: Mapping[str, Hashable] | None = None) -> str:
    """The evidence of the graph, or that given, as UAI text: `n variable label …` by number.

    Raises:
        CogmapError: the graph has soft evidence, which the format cannot hold, or a name or label is unknown.
    """
    observed = graph.observe_all(evidence or {})
    if observed.likelihoods:
        raise CogmapError("UAI evidence: soft evidence cannot be written; take it back with without_evidence")
    number = graph.wiring.number
    pairs = [(number[name], graph.variable_named(name).index(label)) for name, label in observed.evidence.items()]
    return " ".join(map(str, [len(pairs), *(part for pair in pairs for part in pair)])) + "\n"


class _Words:
    """The words of a text, read one after the other."""

    def __init__(self, what: str, text: str) -> None:
        text = re.sub("#[^\n]*", "", text)  # some programs write comments
        self.what, self.text, self.words, self.at = what, text, text.split(), 0

    def word(self, expected: str) -> str:
        if self.at >= len(self.words):
            self.fail(f"the file ends where {expected} should be")
        self.at += 1
        return self.words[self.at - 1]

    def integer(self, expected: str, least: int, end: int | None = None) -> int:
        word = self.word(expected)
        if not word.isdecimal() or len(word) > 18 or int(word) < least or (end is not None and int(word) >= end):
            self.fail(f"{word[:40]!r} where {expected} should be, {least} or more" + (f", below {end}" if end else ""))
        return int(word)

    def numbers(self, expected: str, count: int) -> FloatArray:
        words = self.words[self.at : self.at + count]
        values = np.array([_entry(word) for word in words])
        wrong = np.flatnonzero(~(values >= 0))
        self.at += int(wrong[0]) + 1 if len(wrong) else len(words)
        if len(wrong):
            self.fail(f"{words[wrong[0]][:40]!r} is no entry of {expected}; give finite numbers, 0 or more")
        if len(words) < count:
            self.fail(f"the file ends within the entries of {expected}; {count} are needed")
        return values

    def end(self) -> None:
        if self.at < len(self.words):
            self.at += 1
            self.fail(f"{self.words[self.at - 1][:40]!r} after the end; check the number of factors")

    @property
    def line(self) -> int:
        """Of the word that was read last."""
        seen = 0
        lines = self.text.splitlines() or [""]
        for line, text in enumerate(lines, start=1):
            seen += len(text.split())
            if seen >= self.at > 0:
                return line
        return len(lines) if self.at else 1

    def fail(self, why: str) -> NoReturn:
        """The error, with the line of the word that was read last."""
        raise failed(self.what, self.line, why)


def _entry(word: str) -> float:
    """The number; NaN where it is none, or not finite."""
    try:
        value = float(word)
    except ValueError:
        return math.nan
    return value if math.isfinite(value) else math.nan
