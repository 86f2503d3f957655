"""The slices of eq. 1 in the language of factor graphs, over the support of the belief."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import Floats, Ints
from .distinct import distinct
from .factors import Successors, Support, Table
from .generative import GenerativeModel
from .graph import FactorGraph
from .percept import Percept


@dataclass(frozen=True, slots=True, eq=False)
class Slice:
    """One time step of the window: domains over the support, and the factors as they were at that step."""

    step: int  # the time step t
    percept: Percept  # what it brought
    places: Ints  # `[n]` domain of s_t, by number
    positions: Ints  # `[m]` domain of p_t, by number
    joint: Floats  # `[n, m]` filtered Q(s_t, p_t)
    tables: tuple[Table, ...]  # the factors of the step; in what they stand for nothing differs from `FactorGraph`


def take_slice(
    model: GenerativeModel,
    before: Slice | None,
    pairs: tuple[Ints, Ints, Floats],
    likelihoods: Floats,
    *,
    step: int,
    percept: Percept,
    examined: bool,
    ahead: Successors | None,
) -> Slice:
    """A snapshot of the factors over the support of the filtered joint.

    Args:
        model: the model as it is now.
        before: the slice of the step before.
        pairs: places, positions and masses of its `k` pairs.
        likelihoods: `[k, F]` P(reading | s) of each sensor that sensed something, as it was filtered with.
        step: the time step.
        percept: what it brought.
        examined: whether the filter looked at displacement.
        ahead: where the action may have led from each place of the step before, as the filter had it.
    """
    (places, place_at), (positions, position_at) = distinct(pairs[0]), distinct(pairs[1])
    joint, told = np.zeros((len(places), len(positions))), np.empty((len(places), likelihoods.shape[1]))
    joint[place_at, position_at], told[place_at] = pairs[2], likelihoods
    support = Support(
        step=step,
        percept=percept,
        places=places,
        positions=positions,
        before=None if before is None else (before.places, before.positions),
        likelihoods=dict(zip(percept.readings, told.T, strict=True)),
        arrival=None if model.displacement is None else model.displacement.arrival(places),
        examined=examined,
        ahead=None if before is None else ahead,
    )
    tables = tuple(table for factor in model.factors for table in factor.tables(support))
    return Slice(step, percept, places, positions, joint, tables)


def window_graph(model: GenerativeModel, window: Sequence[Slice]) -> FactorGraph:
    """The factor graph of a window of consecutive slices (eq. 1); the first gives the prior its filtered joint.

    Variables, for each step t: `s{t}` (places), `p{t}` (positions, where places have them), and, but for the first,
    `moved{t}`, and one observed variable a sensor, such as `o{t}` (sight) and `c{t}` (doors).
    """
    graph = FactorGraph()
    for at, slice_ in enumerate(window):
        t = slice_.step
        graph.variable(f"s{t}", slice_.places.tolist(), time=t)
        if len(model.pose.positions):
            graph.variable(f"p{t}", [model.pose.positions[i] for i in slice_.positions.tolist()], time=t)
        if at == 0:
            _prior(graph, slice_)
            _emit(graph, slice_, [table for table in slice_.tables if table.domain])
        else:
            _emit(graph, slice_, slice_.tables)
    return graph


def _prior(graph: FactorGraph, slice_: Slice) -> None:
    scope = [variable.name for variable in graph.variables]
    values = slice_.joint if len(scope) > 1 else slice_.joint[:, 0]
    names = ", ".join(name[0] for name in scope)
    equation = f"Q({names}) of the step that left the window"
    graph.factor("Q", scope, values, kind="prior", equation=equation)


def _emit(graph: FactorGraph, slice_: Slice, tables: Sequence[Table]) -> None:
    for table in tables:
        if table.domain:
            graph.variable(table.scope[0], table.domain, time=slice_.step)
        if table.kind == "displacement":
            graph.variable(table.scope[0], (False, True), time=slice_.step)
        for label in table.observed:
            graph.variable(table.scope[0], (label,), time=slice_.step, observed=True)
    for table in tables:
        graph.factor(table.name, table.scope, table.array, kind=table.kind, equation=table.equation)
