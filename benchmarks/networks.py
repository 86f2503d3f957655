"""Published networks: what queries cost, beside pyAgrum where it is installed, in pairs within one run.

    python benchmarks/networks.py FOLDER
    python benchmarks/networks.py FOLDER --only alarm munin2 --runs 9 --json networks.json

FOLDER holds BIF, XMLBIF or UAI files (with evidence in a file of the same name and `.evid`). Three questions are timed,
in milliseconds: `all`, every marginal from nothing; `one`, one target from nothing, over --targets variables; `again`,
every marginal after the labels of a few observed variables have changed, compiled once. Both sides use one thread. The
marginals of all answers are compared, and those of a competition's solution (`.MAR`) where there is one.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from statistics import geometric_mean, median
from typing import Any

import numpy as np
from cogmap.inference import compile_graph, infer
from cogmap.model import CogmapError, FactorGraph, load_graph
from machine import arguments, positive, write_json

SUFFIXES = (".bif", ".xmlbif", ".bifxml", ".uai")
QUESTIONS = ("all", "one", "again")
Marginals = dict[str, Any]


class Ours:
    """Our side."""

    name = "cogmap"

    def __init__(self, graph: FactorGraph, memory: float) -> None:
        self.graph, self.memory = graph, memory
        self.names = [variable.name for variable in graph.variables]

    def all(self) -> Marginals:
        """Every marginal."""
        posterior = infer(self.graph, memory=self.memory)
        return {name: posterior.marginal(name) for name in self.names}

    def one(self, name: str) -> Marginals:
        """The marginal of one target."""
        return {name: infer(self.graph, targets=[name], memory=self.memory).marginal(name)}

    def compile(self, _: dict[str, Any]) -> None:
        """Get ready for `again`."""
        self.compiled = compile_graph(self.graph, memory=self.memory)

    def again(self, evidence: dict[str, Any]) -> Marginals:
        """Every marginal, given other evidence than before."""
        posterior = self.compiled.infer(evidence)
        return {name: posterior.marginal(name) for name in self.names}


class PyAgrum:
    """The same questions to pyAgrum, which is given the very numbers that we have (its reader of BIF rounds)."""

    name = "pyagrum"

    def __init__(self, graph: FactorGraph) -> None:
        import pyagrum

        pyagrum.setNumberOfThreads(1)
        self.graph = graph
        self.names = [variable.name for variable in graph.variables]
        self.called = {name: f"v{i}" for i, name in enumerate(self.names)}
        directed = graph.wiring.own is not None
        self.model = pyagrum.BayesNet() if directed else pyagrum.MarkovRandomField()
        for variable in graph.variables:
            self.model.add(pyagrum.LabelizedVariable(self.called[variable.name], "", variable.cardinality))
        self.engine = pyagrum.LazyPropagation if directed else pyagrum.ShaferShenoyMRFInference
        if directed:
            for factor in graph.factors:
                for parent in factor.scope[1:]:
                    self.model.addArc(self.called[parent.name], self.called[factor.scope[0].name])
        merged: dict[frozenset[str], list[Any]] = {}
        for factor in graph.factors:  # pyAgrum holds one factor a set of variables
            merged.setdefault(frozenset(v.name for v in factor.scope), []).append(factor)
        for factors in merged.values():
            self._fill(factors, directed)

    def _fill(self, factors: Sequence[Any], directed: bool) -> None:
        names = [self.called[variable.name] for variable in factors[0].scope]
        table = self.model.cpt(names[0]) if directed else self.model.addFactor(names)
        order = list(reversed(table.names))
        values = np.ones(())
        for factor in factors:
            own = [self.called[variable.name] for variable in factor.scope]
            values = values * factor.dense().transpose([own.index(name) for name in order])
        table.fillWith(values.ravel().tolist())

    def _marginals(self, engine: Any, names: Sequence[str]) -> Marginals:
        engine.makeInference()
        return {name: engine.posterior(self.called[name]).toarray() for name in names}

    def _asked(self) -> Any:
        engine = self.engine(self.model)
        for name, label in self.graph.evidence.items():
            engine.addEvidence(self.called[name], self.graph.variable_named(name).index(label))
        return engine

    def all(self) -> Marginals:
        """Every marginal."""
        return self._marginals(self._asked(), self.names)

    def one(self, name: str) -> Marginals:
        """The marginal of one target."""
        engine = self._asked()
        engine.addTarget(self.called[name])
        return self._marginals(engine, [name])

    def compile(self, evidence: dict[str, Any]) -> None:
        """Get ready for `again` with evidence about the same variables."""
        self.compiled = self._asked()
        for name in evidence:
            self.compiled.addEvidence(self.called[name], 0)

    def again(self, evidence: dict[str, Any]) -> Marginals:
        """Every marginal, given other evidence than before."""
        for name, label in evidence.items():
            self.compiled.chgEvidence(self.called[name], self.graph.variable_named(name).index(label))
        return self._marginals(self.compiled, self.names)


def measured(graph: FactorGraph, sides: Sequence[Any], asked: argparse.Namespace, targets: int) -> dict[str, Any]:
    """Median milliseconds by question and side, the sides in turn, and how far their marginals differ."""
    rng = np.random.default_rng(asked.seed)
    latent = [variable.name for variable in graph.variables if variable.name not in graph.evidence]
    wanted = [latent[i] for i in rng.permutation(len(latent))[:targets]]
    seen = [latent[i] for i in rng.permutation(len(latent))[: min(4, len(latent) // 2)]]
    drawn = infer(graph, memory=asked.memory).sample(asked.runs + 2, rng=rng)
    for side in sides:
        side.compile({name: drawn[name][0] for name in seen})
    spent: dict[tuple[str, str], list[float]] = {}
    worst = 0.0
    for run in range(asked.runs + 2):
        evidence = {name: drawn[name][run] for name in seen}
        worst = max(worst, _turn("again", sides, lambda side, e=evidence: side.again(e), spent, keep=run >= 2))
        if run < asked.runs:
            worst = max(worst, _turn("all", sides, lambda side: side.all(), spent))
            for name in wanted:
                worst = max(worst, _turn("one", sides, lambda side, n=name: side.one(n), spent))
    times = {question: {side.name: median(spent[question, side.name]) for side in sides} for question in QUESTIONS}
    return {"milliseconds": times, "difference": worst}


def _turn(
    question: str,
    sides: Sequence[Any],
    ask: Callable[[Any], Marginals],
    spent: dict[tuple[str, str], list[float]],
    *,
    keep: bool = True,
) -> float:
    answers: list[Marginals] = []
    for side in sides:
        begin = time.perf_counter()
        answers.append(ask(side))
        if keep:
            spent.setdefault((question, side.name), []).append(1e3 * (time.perf_counter() - begin))
    return max((_apart(answers[0], other) for other in answers[1:]), default=0.0)


def _apart(one: Marginals, other: Marginals) -> float:
    return max(float(abs(one[name] - other[name]).max()) for name in one)


def solved(graph: FactorGraph, path: Path, memory: float) -> float | None:
    """How far the marginals are from a competition's solution, which has six digits."""
    file = path.with_name(path.name + ".MAR")
    if not file.exists():
        return None
    words, at, worst = file.read_text().split(), 2, 0.0
    posterior = infer(graph, memory=memory)
    for variable in graph.variables:
        count = int(words[at])
        right = np.array(words[at + 1 : at + 1 + count], dtype=float)
        worst, at = max(worst, float(abs(posterior.marginal(variable) - right).max())), at + 1 + count
    return worst


def row_of(path: Path, asked: argparse.Namespace) -> dict[str, Any]:
    """One line of the table."""
    begin = time.perf_counter()
    evidence = path.with_name(path.name + ".evid")
    graph = load_graph(path, evidence=evidence if evidence.exists() else None)
    row: dict[str, Any] = {"network": path.stem, "variables": len(graph.variables), "load": time.perf_counter() - begin}
    try:
        size = compile_graph(graph, memory=math.inf).bytes
        row["bytes"] = size
        sides: list[Any] = [Ours(graph, asked.memory)]
        infer(graph, memory=asked.memory)
        if asked.peer and size <= asked.peer_below:
            sides.append(PyAgrum(graph))
        row |= measured(graph, sides, asked, asked.targets) | {"solution": solved(graph, path, asked.memory)}
    except CogmapError as error:
        row["refused"] = str(error)
    return row


def shown(row: dict[str, Any]) -> str:
    """The row as text."""
    text = f"{row['network']:20} {row['variables']:5} "
    if "refused" in row:
        return text + row["refused"]
    for question in QUESTIONS:
        times = row["milliseconds"][question]
        text += f" {question} {times['cogmap']:9.2f}"
        text += f" / {times['pyagrum']:9.2f} = {times['cogmap'] / times['pyagrum']:5.2f}" if "pyagrum" in times else ""
    text += f"  differ by {row['difference']:.0e}" if "pyagrum" in row["milliseconds"]["all"] else ""
    return text + (f"  from the solution {row['solution']:.0e}" if row["solution"] is not None else "")


def summary(rows: Sequence[dict[str, Any]]) -> dict[str, float]:
    """Geometric means over the networks of our time over pyAgrum's, by question."""
    pairs = [row["milliseconds"] for row in rows if "pyagrum" in row.get("milliseconds", {}).get("all", {})]
    if not pairs:
        return {}
    return {q: geometric_mean(times[q]["cogmap"] / times[q]["pyagrum"] for times in pairs) for q in QUESTIONS}


def _arguments(given: Sequence[str] | None) -> argparse.Namespace:
    parser = arguments(__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="+", help="names of the files, without suffix")
    parser.add_argument("--runs", type=positive, default=5)
    parser.add_argument("--targets", type=positive, default=8)
    parser.add_argument("--memory", type=float, default=8e9, help="bytes that a query may take")
    parser.add_argument("--peer-below", type=float, default=3e8, help="pyAgrum is asked where we need no more bytes")
    parser.add_argument("--no-peer", dest="peer", action="store_false")
    parser.add_argument("--seed", type=int, default=0)
    return parser.parse_args(given)


def main(given: Sequence[str] | None = None) -> None:
    """Measure and print."""
    asked = _arguments(given)
    if asked.peer:
        try:
            import pyagrum  # noqa: F401
        except ImportError:
            print("pyAgrum is not installed: our times alone")
            asked.peer = False
    files = sorted(path for path in asked.folder.iterdir() if path.suffix in SUFFIXES)
    rows: list[dict[str, Any]] = []
    print("milliseconds, median of", asked.runs, "(cogmap / pyagrum = ratio)" if asked.peer else "")
    for path in files:
        if asked.only is None or path.stem in asked.only:
            rows.append(row_of(path, asked))
            print(shown(rows[-1]), flush=True)
    means = summary(rows)
    print("geometric means of the ratios:", {q: round(mean, 2) for q, mean in means.items()}) if means else None
    write_json(asked.json, {"runs": asked.runs, "rows": rows, "means": means})


if __name__ == "__main__":
    main()
