"""Looking back: what was passed over while nothing seemed in doubt is weighed again when something is."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from .branches import Alternative, apart, branches
from .chances import Chances
from .extending import extend
from .hypothesis import Hypothesis
from .replaying import History
from .scheme import Sensed

BACK = 32  # steps that are looked back on, at most


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
    past: Sequence[Past], history: History, now: Sensed, *, narrow: float, wide: float, floor: float
) -> Iterator[Hypothesis]:
    """Hypotheses that began with a branch that was not followed, as they are after the last step of `past`.

    Args:
        past: steps, one after another, the last of them that of now, with a norm of zero.
        history: the percepts.
        now: the last one, with what further sensors read.
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
        last = first == len(past) - 1
        found = list(branches(parent, now if last else history[step.time], drop=wide))
        best = max(found, key=lambda branch: branch.weight)
        for branch in found:
            below = best.weight - branch.weight
            if branch is not best and below < wide and (not last or below >= narrow or apart(branch, best)):
                yield from _followed(branch, past[first:], history, now, floor)


def _followed(
    branch: Alternative, past: Sequence[Past], history: History, now: Sensed, floor: float
) -> Iterator[Hypothesis]:
    """Hypotheses from a branch on, one probable branch after another, and all there are at the last step.

    What cannot reach the floor is let go.
    """
    h, first, last = branch.parent.fork(), past[0], past[-1]
    _carry_out(h, branch, first, now if first is last else history[first.time])
    for step in past[1:]:
        if h.weight < floor:
            return
        h.chances = Chances(h.counts, step.labels, size=h.size)
        if step is last:
            for one in branches(h, now, drop=h.weight - floor):
                yield _carry_out(h.fork(), one, step, now)
            return
        sensed = history[step.time]
        _carry_out(h, max(branches(h, sensed, drop=0.5), key=lambda one: one.weight), step, sensed)
    if h.weight >= floor:
        yield h


def _carry_out(h: Hypothesis, branch: Alternative, step: Past, sensed: Sensed) -> Hypothesis:
    extend(h, branch, sensed, step.time)
    h.weight -= step.norm
    return h
