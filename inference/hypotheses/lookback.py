"""Looking back: what was passed over while nothing seemed in doubt is weighed again when something is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from .branches import Alternative, apart, branches
from .chances import Chances
from .extending import extend
from .hypothesis import Hypothesis
from .replaying import History

BACK = 32
"""Steps that are looked back on, at most."""


class Past(NamedTuple):
    """One step of late.

    Attributes:
        time: of the step.
        parent: the best hypothesis before it.
        marks: its marks then.
        labels: number of labels of each sensor at that step.
        norm: log of what the weights of this step were divided by.
    """

    time: int
    parent: Hypothesis
    marks: tuple[int, int, int]
    labels: tuple[int, ...]
    norm: float


def passed_over(
    past: Sequence[Past], history: History, *, narrow: float, wide: float, floor: float
) -> Iterator[Hypothesis]:
    """Hypotheses that began with a branch that was not followed, as they are after the last step of `past`.

    Args:
        past: steps, one after another, the last of them that of now, with a norm of zero.
        history: the percepts.
        narrow, wide: branches that are less probable than the best one by this many nats were not followed now, and
            are not looked at; those that are only `apart` from it were not followed either.
        floor: log weight, on the scale of the last step, below which a hypothesis is let go.
    """
    for first in range(len(past) - 1, -1, -1):
        step = past[first]
        parent = step.parent.as_of(step.marks)
        if parent is not None:
            parent.awake = past[-1].parent.awake
        if parent is None or step.time < history.start:
            return
        parent.chances = Chances(parent.counts, step.labels, size=parent.size)
        found = list(branches(parent, history[step.time], drop=wide))
        best = max(found, key=lambda branch: branch.weight)
        for branch in found:
            below = best.weight - branch.weight
            now = first == len(past) - 1
            if branch is not best and below < wide and (not now or below >= narrow or apart(branch, best)):
                h = _followed(branch, past[first:], history, floor)
                if h is not None:
                    yield h


def _followed(branch: Alternative, past: Sequence[Past], history: History, floor: float) -> Hypothesis | None:
    """A hypothesis from a branch on, one probable branch after another; what cannot reach the floor is let go."""
    h = branch.parent.fork()
    for k, step in enumerate(past):
        if k:
            h.chances = Chances(h.counts, step.labels, size=h.size)
            branch = max(branches(h, history[step.time], drop=0.5), key=lambda branch: branch.weight)
        extend(h, branch, history[step.time], step.time)
        h.weight -= step.norm
        if h.weight < floor:
            return None
    return h
