"""A small weighted set of hypotheses about the map, one step after another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from heapq import nlargest
from math import exp, log

from ...model import CogmapError
from .branches import Alternative, branches
from .chances import Chances
from .extending import begin, extend
from .folding import pairs, union
from .hypothesis import Hypothesis
from .pruning import merged, normalised
from .replaying import History, doubted, without
from .scheme import Sensed, WayScheme

Try = tuple[int, int, bool, int, int]

AGAIN = 16
"""Steps after which a folding that was too improbable is tried again, in a map that has not changed since."""

MANY = 4096
"""Foldings that are remembered."""


@dataclass(frozen=True, slots=True)
class TrackerOptions:
    """How many hypotheses are kept.

    Attributes:
        most: at most so many.
        least: those less probable than this, beside the most probable one, are dropped.
        folded: hypotheses in which look-alikes are tried to be united, besides those that found a new place.

    Raises:
        CogmapError: a number is out of range.
    """

    most: int = 32
    least: float = 1e-5
    folded: int = 2

    def __post_init__(self) -> None:
        if not (self.most >= 1 and 0.0 < self.least < 1.0 and self.folded >= 0):
            raise CogmapError(f"tracker: {self} cannot work; give most >= 1, 0 < least < 1, folded >= 0")


class Tracker:
    """Where the agent is, and in what map: hypotheses with weights that add up to one, the most probable first."""

    def __init__(self, scheme: WayScheme, options: TrackerOptions | None = None) -> None:
        self.scheme = scheme
        self.options = options or TrackerOptions()
        self.hypotheses: list[Hypothesis] = []
        self.time = 0
        self.history = History()
        self._doubts: list[int] = []
        self._tried: dict[Try, int] = {}

    @property
    def best(self) -> Hypothesis:
        """The most probable hypothesis.

        Raises:
            CogmapError: nothing was sensed yet.
        """
        if not self.hypotheses:
            raise CogmapError("tracker: it has sensed nothing yet; call step(sensed, labels) first")
        return self.hypotheses[0]

    def step(self, sensed: Sensed, labels: Sequence[int]) -> None:
        """Take in one step.

        Args:
            sensed: what it brings.
            labels: number of labels that each sensor has shown so far, this step included.

        Raises:
            CogmapError: what was sensed does not fit the scheme, or there is not one number of labels a sensor.
        """
        sensed.check(self.scheme)
        if len(labels) != self.scheme.sensors:
            raise CogmapError(f"tracker: labels are {labels}; give how many each of {self.scheme.sensors} sensors has")
        self.history.add(sensed)
        if not self.hypotheses:
            first = Hypothesis(self.scheme)
            first.chances = Chances(first.counts, [n + 1 for n in labels])
            begin(first, sensed, self.time)
            self.hypotheses = [first]
        else:
            self._advance(sensed, [n + 1 for n in labels])
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

    def _advance(self, sensed: Sensed, labels: Sequence[int]) -> None:
        drop = -log(self.options.least)
        happened: list[Alternative] = []
        for h in self.hypotheses:
            h.chances = Chances(h.counts, labels, size=h.size)
            happened.extend(branches(h, sensed, drop=drop))
        top = max(branch.weight for branch in happened)
        happened = [branch for branch in happened if branch.weight > top - drop]
        happened = nlargest(3 * self.options.most, happened, key=lambda branch: branch.weight)
        children = self._extended(happened, sensed)
        proposed = [*self._folded(children, drop), *self._without(max(children, key=lambda h: h.weight), drop)]
        found = merged(children, proposed)
        self.hypotheses = normalised(found, drop=drop, most=self.options.most)
        if len(self.hypotheses) == 1:
            self.hypotheses[0].settle()

    def _extended(self, found: Sequence[Alternative], sensed: Sensed) -> list[Hypothesis]:
        left: dict[int, int] = {}
        for branch in found:
            left[id(branch.parent)] = left.get(id(branch.parent), 0) + 1
        children: list[Hypothesis] = []
        for branch in found:
            left[id(branch.parent)] -= 1
            h = branch.parent.fork() if left[id(branch.parent)] else branch.parent  # the last child is the parent
            h.chances = branch.parent.chances
            children.append(h)
            extend(h, branch, sensed, self.time)
        return children

    def _folded(self, children: Sequence[Hypothesis], drop: float) -> list[Hypothesis]:
        top = max(h.weight for h in children)
        tried = sorted(children, key=lambda h: -h.weight)
        results: list[Hypothesis] = []
        for rank, h in enumerate(tried):
            if rank < self.options.folded or h.here == self.time:
                results.extend(self._folds(h, max([top, *(r.weight for r in results)]) - drop))
        return results

    def _without(self, h: Hypothesis, drop: float) -> Iterator[Hypothesis]:
        """The most probable hypothesis without some place that it may only have imagined; one is looked at a step."""
        if not self._doubts:
            self._doubts = list(h.places)
        number = self._doubts.pop()
        if h.places.get(number) is not None and (numbers := doubted(h, number, self.history)):
            other = without(h, numbers, self.history, floor=h.weight - drop)
            if other is not None:
                yield other

    def _folds(self, h: Hypothesis, floor: float) -> Iterator[Hypothesis]:
        """The foldings that are probable enough; what failed is tried again when the map has changed, or later."""
        for one, other, period in pairs(h):
            key = (one, other, period, h.size, h.links)
            if self.time < self._tried.get(key, 0):
                continue
            united = union(h, one, other, period=period, floor=floor)
            if united is None:
                self._tried[key] = self.time + AGAIN
            else:
                yield united
        if len(self._tried) > MANY:
            self._tried.clear()
