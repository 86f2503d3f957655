"""The forward pass: each bucket multiplies the tables that wait at it, eliminates its node, and hands on a message.

Eliminating x_i multiplies the tables that hold it and sums it out; the message over its separator S_i goes to the
bucket of the next node to leave. What is known is sliced out of the tables first, so that one order serves whatever
is observed, and a second pass makes anew only what hangs on tables that have changed.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...model import FloatArray
from ..errors import ImpossibleEvidence, impossible
from .ordering import Elimination
from .problem import Problem
from .tables import Table, eliminated, product

Shape = tuple[int, ...]


class Input(NamedTuple):
    """A table as a bucket takes it.

    Attributes:
        table: number of the table in the problem.
        axes: order of its axes; None where they are in order.
        known: nodes of the axes that are sliced out, None for those that stay; None where all stay.
        shape: what it is reshaped to, so that it broadcasts over the bucket; None where it has that shape.
    """

    table: int
    axes: Shape | None
    known: Sequence[int | None] | None
    shape: Shape | None


@dataclass(frozen=True, slots=True)
class Buckets:
    """Buckets in order of elimination; made once for an order and the nodes that are known."""

    problem: Problem  # the tables
    scopes: Sequence[Shape]  # for each bucket its nodes, the eliminated one first, then its separator by order
    shapes: Sequence[Shape]  # number of labels of each of these
    place: Mapping[int, int]  # bucket of each node; nodes that are kept come after all others
    inputs: Sequence[Sequence[Input]]  # for each bucket the tables that wait at it
    # for each bucket the buckets whose messages wait at it, with what these are reshaped to
    children: Sequence[Sequence[tuple[int, Shape | None]]]
    loose: Sequence[Input]  # tables over known nodes only, and over kept ones

    def parent(self, at: int) -> int | None:
        """The bucket that the message of this one goes to; None where it has no separator."""
        return self.place[self.scopes[at][1]] if len(self.scopes[at]) > 1 else None


def buckets(problem: Problem, plan: Elimination, *, known: Collection[int] = (), keep: Sequence[int] = ()) -> Buckets:
    """The buckets of a plan; nodes that are known are not in it.

    Nodes that are kept share one last bucket, from which nothing is eliminated: its message is the joint over them.
    """
    order = plan.order
    place = {i: at for at, i in enumerate([*order, *keep])}
    key = place.__getitem__
    cards = problem.cards
    scopes: list[Shape] = []
    scopes += [(i, *sorted(around, key=key)) for i, around in zip(order, plan.around, strict=True)]
    if keep:
        scopes.append(tuple(keep))
        place.update(dict.fromkeys(keep, len(order)))
    inputs: list[list[Input]] = [[] for _ in scopes]
    loose: list[Input] = []
    rank = {**place, **{i: len(order) + at for at, i in enumerate(keep)}}.__getitem__
    for number, scope in enumerate(problem.scopes):
        free = [i for i in scope if i in place] if known else scope
        members = sorted(free, key=rank)
        sliced = [None if i in place else i for i in scope] if len(free) < len(scope) else None
        axes = None if list(free) == members else tuple([free.index(i) for i in members])
        if not members:
            loose.append(Input(number, None, sliced, None))
            continue
        at = place[members[0]]
        shape = tuple([cards[i] if i in members else 1 for i in scopes[at]]) if len(members) < len(scopes[at]) else None
        inputs[at].append(Input(number, axes, sliced, shape))
    children: list[list[tuple[int, Shape | None]]] = [[] for _ in scopes]
    for at, scope in enumerate(scopes[: len(order)]):
        if len(scope) > 1:
            into = place[scope[1]]
            same = len(scope) - 1 == len(scopes[into])
            shape = None if same else tuple([cards[i] if i in scope else 1 for i in scopes[into]])
            children[into].append((at, shape))
    shapes = [tuple([cards[i] for i in scope]) for scope in scopes]
    return Buckets(problem, scopes, shapes, place, inputs, children, loose)


@dataclass(frozen=True, slots=True)
class Pass:
    """What a forward pass leaves behind."""

    buckets: Buckets  # the buckets
    given: Mapping[int, int]  # index of each known node
    tables: Sequence[Table]  # the tables of the problem, as they were
    # for each bucket, one axis a node; over / by is P(x_i | S_i, evidence so far), or its maximum is
    over: Sequence[FloatArray]
    by: Sequence[FloatArray]  # for each bucket the sum (or maximum) of `over` over x_i
    messages: Sequence[Table]  # the message of each bucket
    # log of the sum (or maximum) of the whole product; with kept nodes, what the last message is to be
    # multiplied by
    log_scale: float


def forward(
    plan: Buckets,
    tables: Sequence[Table],
    *,
    given: Mapping[int, int] | None = None,
    maximum: Collection[int] | bool = False,
    keep: int = 0,
    before: Pass | None = None,
) -> Pass:
    """Eliminate bucket after bucket.

    Args:
        plan: the buckets.
        tables: the tables of the problem.
        given: index of each known node.
        maximum: whether to maximise instead of summing; or which nodes to maximise over.
        keep: number of nodes kept: these are not eliminated from the last bucket.
        before: an earlier pass over the same buckets; what has not changed is taken from there.

    Raises:
        ImpossibleEvidence: the whole product is 0 everywhere.
    """
    given = given or {}
    changed = _changed(plan, tables, given, before)
    count = len(plan.scopes)
    over: list[FloatArray] = [_NOTHING] * count if before is None else list(before.over)
    by: list[FloatArray] = [_NOTHING] * count if before is None else list(before.by)
    messages: list[Table] = [_ONE] * count if before is None else list(before.messages)
    log_scale = plan.problem.log_scale
    for at, scope in enumerate(plan.scopes):
        if changed is None or changed[at]:
            waiting = [_input(each, tables, given) for each in plan.inputs[at]]
            for child, shape in plan.children[at]:
                message = messages[child]
                waiting.append(message if shape is None else message.holding(message.values.reshape(shape)))
            whole = product(waiting, plan.shapes[at])
            if keep and at == count - 1:
                over[at], by[at], messages[at] = whole.values, _NOTHING, whole.refined()
                continue
            most = maximum if isinstance(maximum, bool) else scope[0] in maximum
            over[at], by[at], messages[at] = eliminated(whole, maximum=most)
        if len(scope) == 1 and not (keep and at == count - 1):
            log_scale += _log(messages[at])
    for each in plan.loose:
        log_scale += _log(_input(each, tables, given))
    if log_scale == -math.inf or (keep and not _positive(messages[-1])):
        raise _impossible(plan, tables, given, over)
    return Pass(plan, given, tables, over, by, messages, log_scale)


_NOTHING = np.ones(())
_ONE = Table(_NOTHING)


def _changed(
    plan: Buckets, tables: Sequence[Table], given: Mapping[int, int], before: Pass | None
) -> list[bool] | None:
    """Which buckets must be made anew: those with other inputs, and all that their messages reach; None for all."""
    if before is None:
        return None
    changed = [False] * len(plan.scopes)
    moved = {i for i, index in given.items() if before.given.get(i) != index}
    for at, inputs in enumerate(plan.inputs):
        for each in inputs:
            if tables[each.table] is not before.tables[each.table] or (
                each.known is not None and moved and not moved.isdisjoint(each.known)
            ):
                changed[at] = True
    for at, scope in enumerate(plan.scopes):
        if changed[at] and len(scope) > 1:
            changed[plan.place[scope[1]]] = True
    return changed


def _input(each: Input, tables: Sequence[Table], given: Mapping[int, int]) -> Table:
    table = tables[each.table]
    if each.known is None and each.axes is None and each.shape is None:
        return table
    values = table.values
    if each.known is not None:
        values = values[tuple([slice(None) if i is None else given[i] for i in each.known])]
    if each.axes is not None:
        values = values.transpose(each.axes)
    return table.holding(values if each.shape is None else values.reshape(each.shape))


def _log(scalar: Table) -> float:
    """Log of a table without axes."""
    value = float(scalar.values)
    if scalar.logs:
        return value + scalar.offset
    return math.log(value) + scalar.offset if value > 0 else -math.inf


def _positive(table: Table) -> bool:
    return bool((table.values > (-math.inf if table.logs else 0.0)).any())


def _impossible(
    plan: Buckets, tables: Sequence[Table], given: Mapping[int, int], over: Sequence[FloatArray]
) -> ImpossibleEvidence:
    """The error, with the nodes of the first bucket that came out as zeros."""
    problem = plan.problem
    nodes = next((scope for scope, each in zip(plan.scopes, over, strict=True) if not each.any()), None)
    if nodes is None:
        zero = next((each for each in plan.loose if _log(_input(each, tables, given)) == -math.inf), None)
        nodes = () if zero is None else problem.scopes[zero.table]
    return impossible(problem.graph, problem.given.labels, [problem.names[i] for i in nodes])
