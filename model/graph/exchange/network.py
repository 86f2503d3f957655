"""What files of Bayesian networks have in common: conditionals one a variable, and errors with the line."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import prod

import numpy as np

from ...errors import CogmapError
from ...labels import plain
from ..factor_graph import FactorGraph
from ..factors import Factor, FloatArray
from ..wiring import acyclic

ROUNDED = 1e-3  # how far a column of a file may be from 1: files hold rounded numbers
LARGEST = 10_000_000  # entries of a table that a file may speak of
MOST = 32  # variables of a table


def check_shape(what: str, line: int, shape: Sequence[int]) -> None:
    """Refuse, before there is room made for it, a table that no file could fill.

    Raises:
        CogmapError: it has more than `LARGEST` entries, or is over more than `MOST` variables.
    """
    if len(shape) > MOST or prod(shape) > LARGEST:
        size = f"{len(shape)} variables and {prod(shape):.3g} entries"
        raise failed(what, line, f"a table has {size}; {MOST} and {LARGEST:,} are read at most")


def failed(what: str, line: int, why: str) -> CogmapError:
    """The error of a malformed file: format, line, reason and remedy."""
    return CogmapError(f"{what}, line {line}: {why if len(why) < 500 else why[:400] + ' …'}")


@dataclass(frozen=True, slots=True)
class Conditional:
    """P(child | parents) of a file; `values [child, *parents]`, NaN where the file has none; `line` of the file."""

    child: str
    parents: Sequence[str]
    values: FloatArray
    line: int


def network(
    what: str, domains: Mapping[str, Sequence[str]], lines: Mapping[str, int], conditionals: Sequence[Conditional]
) -> FactorGraph:
    """The graph of a file's variables, declared on these lines, and conditionals; columns scaled to sum to 1.

    Raises:
        CogmapError: a value is missing, negative or not finite; a column does not sum to 1 within `ROUNDED`; a
            variable has no conditional or two.
    """
    graph = FactorGraph()
    for name, domain in domains.items():
        graph.variable(name, tuple(domain))
    seen: set[str] = set()
    for each in conditionals:
        if each.child in seen:
            raise failed(what, each.line, f"a second table of {each.child!r}; keep one")
        seen.add(each.child)
        if not (np.isfinite(each.values).all() and (each.values >= 0).all()):
            raise failed(what, each.line, f"a value of {each.child!r} is missing or negative; mend the table")
        sums = each.values.sum(axis=0)
        if not (abs(sums - 1.0) <= ROUNDED).all():
            worst = float(sums.ravel()[int(abs(sums - 1.0).argmax())])
            raise failed(what, each.line, f"a column of {each.child!r} sums to {worst:.6g}, not to 1; mend the table")
        graph.factor("P", [each.child, *each.parents], each.values / sums, kind="conditional")
    if missing := [name for name in domains if name not in seen]:
        raise failed(what, lines[missing[0]], f"variable {missing[0]!r} has no table; add its probabilities")
    return graph


def conditionals_of(what: str, graph: FactorGraph) -> list[Factor]:
    """The factors of a Bayesian network, in the order of the variables.

    Raises:
        CogmapError: the graph is none: then UAI can hold it.
    """
    remedy = "write UAI, which holds any factors"
    found = {factor.scope[0].name: factor for factor in graph.factors}
    if len(found) < len(graph.factors) or len(found) < len(graph.variables):
        wrong = next((v.name for v in graph.variables if v.name not in found), None)
        why = f"{wrong!r} has no conditional" if wrong else "a variable has two factors that begin with it"
        raise CogmapError(f"{what}: {why}, so this is no Bayesian network; {remedy}")
    for factor in graph.factors:
        factor.check_normalised(tolerance=ROUNDED)
    if not acyclic([tuple(graph.wiring.number[v.name] for v in factor.scope) for factor in graph.factors]):
        raise CogmapError(f"{what}: the conditionals form a cycle, so this is no Bayesian network; {remedy}")
    return [found[variable.name] for variable in graph.variables]


def texts(what: str, graph: FactorGraph) -> dict[str, list[str]]:
    """The labels of each variable as text; files of networks know no other.

    Raises:
        CogmapError: two labels of a variable read the same.
    """
    result: dict[str, list[str]] = {}
    for variable in graph.variables:
        labels = [str(plain(label)) for label in variable.domain]
        if len(set(labels)) < len(labels):
            raise CogmapError(f"{what}: two labels of {variable.name!r} read the same as text; rename one")
        result[variable.name] = labels
    return result
