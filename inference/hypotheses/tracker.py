"""A small weighted set of hypotheses about the map, one step after another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from heapq import nlargest
from math import exp, log

from .branches import Branch, branches
from .chances import Chances
from .extending import begin, extend
from .folding import folds
from .hypothesis import Hypothesis
from .pruning import merged, normalised
from .scheme import Percept, WayScheme


@dataclass(frozen=True, slots=True)
class TrackerOptions:
    """How many hypotheses are kept.

    Attributes:
        most: at most so many.
        least: those less probable than this, beside the most probable one, are dropped.
        folded: hypotheses in which look-alikes are tried to be united, besides those that found a new place.
    """

    most: int = 32
    least: float = 1e-6
    folded: int = 2


class Tracker:
    """Where the agent is, and in what map: hypotheses with weights that add up to one, the most probable first."""

    def __init__(self, scheme: WayScheme, options: TrackerOptions | None = None) -> None:
        self.scheme = scheme
        self.options = options or TrackerOptions()
        self.hypotheses: list[Hypothesis] = []
        self.time = 0
        self.surprise = 0.0

    @property
    def best(self) -> Hypothesis:
        """The most probable hypothesis."""
        return self.hypotheses[0]

    def step(self, percept: Percept, labels: Sequence[int]) -> None:
        """Take in one step.

        Args:
            percept: what it brings.
            labels: number of labels that each sensor has shown so far, this step included.
        """
        if not self.hypotheses:
            first = Hypothesis(self.scheme)
            first.chances = Chances(first.counts, [n + 1 for n in labels])
            begin(first, percept, self.time)
            self.hypotheses = [first]
        else:
            self._advance(percept, [n + 1 for n in labels])
        self.time += 1

    def certainty(self) -> float:
        """Probability of the hypotheses that agree with the best one on where the agent is."""
        best = self.best
        recent = best.places[best.here].recent
        before = recent[-2] if len(recent) > 1 else None
        total = 0.0
        for h in self.hypotheses:
            other = h.places[h.here].recent
            same = h.here == best.here or (other[-2] if len(other) > 1 else None) == before
            total += exp(h.weight) * same
        return min(total, 1.0)

    def _advance(self, percept: Percept, labels: Sequence[int]) -> None:
        drop = -log(self.options.least)
        found: list[Branch] = []
        for h in self.hypotheses:
            h.chances = Chances(h.counts, labels)
            found.extend(branches(h, percept, drop=drop))
        top = max(branch.weight for branch in found)
        found = [branch for branch in found if branch.weight > top - drop]
        found = nlargest(3 * self.options.most, found, key=lambda branch: branch.weight)
        children = self._extended(found, percept)
        children.extend(self._folded(children, drop))
        self.surprise = -max(h.weight for h in children)
        if len(children) > 1:
            children = merged(children)
        self.hypotheses = normalised(children, drop=drop, most=self.options.most)
        if len(self.hypotheses) == 1:
            self.hypotheses[0].settle()

    def _extended(self, found: Sequence[Branch], percept: Percept) -> list[Hypothesis]:
        left: dict[int, int] = {}
        for branch in found:
            left[id(branch.parent)] = left.get(id(branch.parent), 0) + 1
        children: list[Hypothesis] = []
        for branch in found:
            left[id(branch.parent)] -= 1
            h = branch.parent.fork() if left[id(branch.parent)] else branch.parent  # the last child is the parent
            h.chances = branch.parent.chances
            children.append(h)
            extend(h, branch, percept, self.time)
        return children

    def _folded(self, children: Sequence[Hypothesis], drop: float) -> list[Hypothesis]:
        top = max(h.weight for h in children)
        tried = sorted(children, key=lambda h: -h.weight)
        results: list[Hypothesis] = []
        for rank, h in enumerate(tried):
            if rank < self.options.folded or h.here == self.time:
                results.extend(folds(h, floor=max([top, *(r.weight for r in results)]) - drop))
        return results
