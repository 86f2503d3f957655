"""A small weighted set of hypotheses about the map, one step after another."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from heapq import nlargest
from math import exp, inf, log
from typing import Any

from ...model import CogmapError
from .afresh import first_told, is_known, is_odd, lay_over, tries_until
from .attempts import CONTRADICTED, NEVER, Attempt, Tried, attempt
from .branches import Alternative, apart, branches
from .calm import calm_branches
from .chances import Chances
from .evidence import log_predictive
from .extending import begin, extend
from .folding import pairs, union
from .forgetting import forget_fragments
from .hypothesis import Hypothesis, awake_ways, settle_alike
from .logs import log_sum
from .lookback import BACK, Past, passed_over
from .options import Change, Checkpoint, TrackerOptions
from .pruning import merged, normalised
from .rates import ELSEWHERE
from .reading import together, whereabouts
from .recharting import recharted
from .records import NOWHERE
from .replaying import OFTEN, History, doubted, replayed, without
from .scheme import Sensed, WayScheme
from .storing import Arrays, Parts, restored, stored
from .straightening import straightened
from .surveying import surveyed

QUIET = 4
"""Steps without doubt after which what is improbable is let go."""

PATIENCE = 8
"""Doubts in a row, as far as may be looked back, that came to nothing, after which the next one of their kind waits."""

NEAR = log(100.0)
"""Hypotheses with a new place in which look-alikes are tried to be united are at most so far below the best one."""

SHARED = 16
"""Steps after which several hypotheses share what they have in common."""

IN_VAIN = -1e6
"""Nats that are gained where something is not worth trying again for long."""

DECIDED = 256
"""Steps after which what was open and is improbable is let go: what hypotheses differ in grows as long as they do."""

CLANS = 4
"""Hypotheses of that time that may still be open."""

DOUBTED = 4
"""Places that are looked at a step where the agent is moved often."""

SURVEYS = (32, 64, 128, 256, 480)
"""Steps at which the whole walk is surveyed, where something is in doubt then; later ones would not know all of it."""

MANY = 4096
"""Foldings that are remembered."""


class Tracker:
    """Weighted hypotheses about the map and about the agent's place in it.

    Attributes:
        scheme: what is known of ways beforehand.
        options: how many hypotheses are kept.
        hypotheses: with log weights whose exponentials add up to one, the most probable first.
        time: steps taken in so far.
        evidence: log P(last step | those before), of all hypotheses, in nats.
        change: how the best hypothesis follows from the one before.
        history: the last percepts.
    """

    def __init__(self, scheme: WayScheme, options: TrackerOptions | None = None) -> None:
        self.scheme = scheme
        self.options = options or TrackerOptions()
        self.hypotheses: list[Hypothesis] = []
        self.time = 0
        self.evidence = 0.0
        self.change = Change("revised")
        self.history = History()
        self.labels: tuple[int, ...] = ()
        self.awake = awake_ways(scheme)
        self._settled = -1
        self._doubts: Sequence[int] = ()
        self._doubted = 0
        self._tried: dict[Attempt, Tried] = {}
        self._overwritten: list[tuple[Attempt, Tried | None]] = []
        self._clear, self._quiet = True, 0
        self._past: tuple[Past, ...] = ()
        self._tries, self._partly = 0, False
        self._in_a_row = self._cleared = 0  # doubts that came to nothing, and when the last of them was over

    @property
    def best(self) -> Hypothesis:
        """The most probable hypothesis.

        Raises:
            CogmapError: nothing was sensed yet.
        """
        if not self.hypotheses:
            raise CogmapError("tracker: it has sensed nothing yet; call step(sensed, labels) first")
        return self.hypotheses[0]

    def step(self, sensed: Sensed, labels: Sequence[int]) -> float:
        """Take in one step.

        Args:
            sensed: what it brings.
            labels: number of labels that each sensor has shown so far, this step included.

        Returns:
            log P(sensed | the steps before), of all hypotheses that are kept, in nats.

        Raises:
            CogmapError: what was sensed does not fit the scheme, or there is not one number of labels a sensor.
        """
        sensed.check(self.scheme)
        if len(labels) != self.scheme.sensors:
            raise CogmapError(f"tracker: labels are {labels}; give how many each of {self.scheme.sensors} sensors has")
        self._overwritten = []
        if len(self._tried) > MANY:
            self._tried = {}
        self.history.add(sensed, self.time)
        self._partly = self._partly or sensed.others is not None
        self.labels, self.awake = tuple(n + 1 for n in labels), awake_ways(self.scheme, self.awake, sensed)
        for h in self.hypotheses:
            h.wake(self.awake)
        if self.hypotheses:
            self.hypotheses = self._afresh(self._advanced(sensed))
        else:
            self.hypotheses = [self._first(sensed)]
        for h in self.hypotheses:
            h.chances = Chances(h.counts, self.labels, size=h.size)
        self.time += 1
        return self.evidence

    def certainty(self) -> float:
        """Probability of the hypotheses that agree with the best one on where the agent is."""
        best = self.best
        total = 0.0
        for h in self.hypotheses:
            if h.crowd is not None or best.crowd is not None:
                total += exp(h.weight) * whereabouts(h).get(best.here, 0.0)
            else:
                total += exp(h.weight) * together(h, best)
        return min(total, 1.0)

    def labels_used(self, sensor: int) -> set[int]:
        """Numbers of the labels that hypotheses, or the last percepts, still speak of."""
        hypotheses = [*self.hypotheses, *(step.parent for step in self._past)]
        layers = {id(layer): layer for h in hypotheses for layer in h.places.layers}
        used = {
            label for layer in layers.values() for place in layer.values() if place for label in place.sights[sensor]
        }
        for _, sensed in self.history:
            reading = sensed.sights[sensor] if sensed.sights else None
            used.update([reading] if isinstance(reading, int) else reading or ())
        return used

    # -- going back, and files ----------------------------------------------------------------------------

    def checkpoint(self) -> Checkpoint:
        """What `rollback` needs to undo the next step; it costs as much as there are hypotheses."""
        self._overwritten = []  # what the step before has overwritten is not to be put back
        kept = self.labels, self.evidence, self.change, self._doubts, self._doubted, self._tried
        kept += self._clear, self._quiet, self._past, self.awake, self._tries, self._partly
        kept += self._in_a_row, self._cleared
        return Checkpoint(self.time, tuple(self.hypotheses), tuple(h.weight for h in self.hypotheses), kept)

    def rollback(self, checkpoint: Checkpoint) -> None:
        """Be as at a checkpoint, whether the step since was finished or broken off anywhere.

        Raises:
            CogmapError: more than one step was taken since.
        """
        if self._settled > checkpoint.time or self.time > checkpoint.time + 1:
            raise CogmapError(
                f"tracker: the checkpoint is of time {checkpoint.time} and it is {self.time} now; "
                "only the last step can be undone, so take a checkpoint before each"
            )
        self.time, self.hypotheses = checkpoint.time, list(checkpoint.hypotheses)
        self.labels, self.evidence, self.change, self._doubts, self._doubted, tried, *rest = checkpoint.kept
        self._clear, self._quiet, self._past, self.awake, self._tries, self._partly, *rest = rest
        self._in_a_row, self._cleared = rest
        for key, before in reversed(self._overwritten if tried is self._tried else ()):
            if before is None:
                tried.pop(key, None)
            else:
                tried[key] = before
        self._tried, self._overwritten = tried, []
        self.history.cut(self.time)
        for h, weight in zip(self.hypotheses, checkpoint.weights, strict=True):
            h.weight, h.awake, h.chances = weight, self.awake, Chances(h.counts, self.labels, size=h.size)

    def state(self) -> tuple[dict[str, Any], Arrays]:
        """All that `restored` needs to walk on: a header for JSON, and arrays of numbers."""
        numbers = self.time, self._doubted, self._clear, self._quiet, self._tries, self._partly
        numbers += self._in_a_row, self._cleared
        parts = Parts(
            self.hypotheses, self.history, self._tried, self._past, self.change, self._doubts, self.labels,
            self.evidence, numbers, self.awake,
        )  # fmt: skip
        return stored(self.scheme, parts)

    @classmethod
    def restored(
        cls, scheme: WayScheme, options: TrackerOptions | None, state: tuple[Mapping[str, Any], Mapping[str, Any]]
    ) -> Tracker:
        """A tracker that walks on exactly as the one whose `state()` this is.

        Raises:
            CogmapError: the state is none, is damaged, or is of other ways or sensors.
        """
        tracker, parts = cls(scheme, options), restored(scheme, state)
        tracker.hypotheses, tracker.history, tracker.labels = parts.hypotheses, parts.history, parts.labels
        tracker.evidence, tracker.change, tracker._tried = parts.evidence, parts.change, parts.tried
        tracker._past, tracker._doubts = parts.past, parts.doubts
        tracker.time, tracker._doubted, tracker._clear, tracker._quiet, *rest = parts.numbers
        tracker._tries, tracker._partly, tracker._in_a_row, tracker._cleared = rest
        tracker.awake = parts.awake
        for h in tracker.hypotheses:
            h.awake, h.chances = tracker.awake, Chances(h.counts, tracker.labels, size=h.size)
        return tracker

    # -- one step ------------------------------------------------------------------------------------------

    def _first(self, sensed: Sensed) -> Hypothesis:
        first = Hypothesis(self.scheme)
        first.awake = self.awake
        first.chances = Chances(first.counts, self.labels)
        self.evidence = log_predictive(first, sensed, None, None, NOWHERE)
        self.change = Change("revised")
        self.history.weigh(self.evidence)
        begin(first, sensed, self.time)
        return first

    def _advanced(self, sensed: Sensed) -> list[Hypothesis]:
        self._settle()
        previous, wide = self.hypotheses[0], -log(self.options.least)
        drop = min(-log(self.options.doubt), wide) if self._clear else wide
        for h in self.hypotheses:
            h.origin = None  # what went before is not kept
            if h.chances.labels != self.labels:
                h.chances = Chances(h.counts, self.labels, size=h.size)
        happened = self._happened(sensed, drop)
        self.evidence = log_sum([branch.weight for branch in happened])
        if self._clear:
            likeliest = max(happened, key=lambda branch: branch.weight)
            happened = [branch for branch in happened if not apart(branch, likeliest)]
        children = [self._extended(branch, sensed) for branch in happened]
        best = max(children, key=lambda h: h.weight)
        proposed = [*self._folded(children, drop), *self._without(best, drop), *self._surveyed(best, sensed, drop)]
        found = merged(children, proposed)
        found = self._decided([h for h in found if h.weight > found[0].weight - drop])
        found = self._doubted_or_clear(found, previous, sensed, drop)
        best = found[0]
        self.change = Change("extended", tuple(best.touched)) if best.origin is previous else Change("revised")
        return found

    def _afresh(self, found: list[Hypothesis]) -> list[Hypothesis]:
        """Those that a tracker finds which is told the later steps alone, where they explain all steps better."""
        tries = self._tries
        if self._clear or self._partly or not is_odd(found[0], tries) or tries_until(self.time) <= tries:
            return found
        history, first = self.history, first_told(self.history.start, self.time, tries)
        self._tries = max(tries_until(self.time), tries_until(3 * self.time // 2) - 1)  # later and later, if in vain
        if not is_known(found[0], history.start):
            return found
        other = Tracker(self.scheme, replace(self.options, most=max(self.options.most // 2, 1)))
        other.time, other.awake, other._partly = first, self.awake, True
        for time in range(first, self.time + 1):
            other.step(history[time], [n - 1 for n in self.labels])
        among = [*other.best.places]
        earlier = replayed(other.best, history, history.start, first - 1, skip=(), start_without=(), among=among)[0]
        gain = other.history.norm(first) + earlier - history.norm(history.start + 1)
        if other.best.weight + gain <= found[0].weight:
            return found
        if self.scheme.displacements is not None:
            lay_over(other.hypotheses, first, found[0].places[found[0].here])
        history.revalue(gain)
        self._tries = tries_until(self.time)
        self._tried, self._past, self._doubted, self._quiet = {}, (), 0, 0
        self.change = Change("revised")
        return other.hypotheses

    def _decided(self, found: list[Hypothesis]) -> list[Hypothesis]:
        """Now and then those alone that go back to the few hypotheses of some time ago that nearly all go back to.

        And what was left behind long ago for good is forgotten.
        """
        if self.time % DECIDED:
            return found
        best, mass = found[0].weight, dict[int, float]()
        for h in found:
            mass[h.clan] = mass.get(h.clan, 0.0) + exp(h.weight - best)
        least = self.options.doubt * sum(mass.values())
        kept = {clan for clan in nlargest(CLANS, mass, key=mass.__getitem__) if mass[clan] > least}
        found = [h for h in found if h.clan in kept]
        for number, h in enumerate(found):
            h.clan = number
            if forget_fragments(h, self.options.fragments):
                h.origin = None  # it does more than extend it
        return found

    def _doubted_or_clear(
        self, found: list[Hypothesis], previous: Hypothesis, sensed: Sensed, drop: float
    ) -> list[Hypothesis]:
        """What is kept: while nothing is in doubt the best one alone, or else all, with what was passed over before."""
        step, wide = Past(self.time, previous, previous.marks, self.labels, 0.0), -log(self.options.least)
        if found[0].origin is not previous:
            self._in_a_row = 0
        if self._clear and len(found) > 1 and self._waits(found):
            found = found[:1]
        if self._clear and len(found) > 1:
            floor = found[0].weight - wide
            over = passed_over((*self._past, step), self.history, sensed, narrow=drop, wide=wide, floor=floor)
            again = nlargest(self.options.most, over, key=lambda h: h.weight)
            folds = (fold for h in again if h.crowd is None for fold in self._folds(h, floor))
            found = merged(found, [*again, *folds])
            self._clear, self._quiet = False, 0
            self._in_a_row = self._in_a_row + 1 if self.time - self._cleared <= 2 * BACK else 1
        found, norm = normalised(found, drop=wide, most=self.options.most)
        self._past = (*self._past, step._replace(norm=norm))[-BACK:]
        self.history.weigh(norm)
        if not self._clear:
            self._quiet = 0 if self._open_question(found) else self._quiet + 1
            if self._quiet > QUIET:
                self._clear, found = True, normalised(found, drop=wide, most=1)[0]
                self._cleared = self.time
                found[0].apart = False
        return found

    def _waits(self, found: Sequence[Hypothesis]) -> bool:
        """Whether a doubt waits: of the kind that came to nothing again and again.

        Nothing is lost by that but time: what is passed over meanwhile is looked back on, so it waits no longer than
        for the steps that are.
        """
        wait = min(2 ** min(self._in_a_row - PATIENCE, 10), BACK) if self._in_a_row >= PATIENCE else 0
        return self.time < self._cleared + wait and not self._open_question(found)

    def _open_question(self, found: Sequence[Hypothesis]) -> bool:
        """Whether another hypothesis says more than that a place is not where the pose says."""
        doubt = log(self.options.doubt)
        return any(h.weight > doubt and (found[0].apart or not h.apart) for h in found[1:])

    def _settle(self) -> None:
        """Share what the last step added, once it cannot be undone any more: nobody reads it differently by this."""
        self._settled = self.time
        if len(self.hypotheses) == 1:
            self.hypotheses[0].settle()
        elif self.time % SHARED == 0:
            settle_alike(self.hypotheses)

    def _happened(self, sensed: Sensed, drop: float) -> list[Alternative]:
        """The branches that may survive."""
        if self.options.calm and len(self.hypotheses) == 1 and self.hypotheses[0].crowd is None:
            alone = calm_branches(self.hypotheses[0], sensed, drop=drop)
            if alone:
                return alone
        happened: list[Alternative] = []
        floor = -inf
        for h in self.hypotheses:
            for branch in branches(h, sensed, drop=drop, floor=floor):
                floor = max(floor, branch.weight - drop)
                happened.append(branch)
        happened = [branch for branch in happened if branch.weight > floor]
        return nlargest(3 * self.options.most, happened, key=lambda branch: branch.weight)

    def _extended(self, branch: Alternative, sensed: Sensed) -> Hypothesis:
        h = branch.parent.fork()
        h.origin = branch.parent
        extend(h, branch, sensed, self.time)
        return h

    def _folded(self, children: Sequence[Hypothesis], drop: float) -> list[Hypothesis]:
        top = max(h.weight for h in children)
        tried = sorted(children, key=lambda h: -h.weight)
        results: list[Hypothesis] = []
        for rank, h in enumerate(tried):
            if h.crowd is not None:
                continue
            if rank < self.options.folded or (h.here == self.time and h.weight > top - NEAR):
                results.extend(self._folds(h, max([top, *(r.weight for r in results)]) - drop))
        return results

    def _without(self, h: Hypothesis, drop: float) -> Iterator[Hypothesis]:
        """The most probable hypothesis without some place that it may only have imagined.

        One is looked at a step; where the agent is moved often, and so many are in doubt, a few.
        """
        if h.crowd is not None:
            return
        for _ in range(DOUBTED if h.chances.moved > OFTEN else 1):
            yield from self._without_one(h, h.weight - drop)

    def _without_one(self, h: Hypothesis, floor: float) -> Iterator[Hypothesis]:
        if self._doubted == 0:
            self._doubts = list(h.places)
            self._doubted = len(self._doubts)
        self._doubted -= 1
        number = self._doubts[self._doubted]
        place = h.places.get(number)
        for one in {number, h.here} if place is not None else {h.here}:
            yield from self._rethought(h, one, floor)
        key = (number, number, False, 0)
        if place is None or self._tried.get(key, NEVER).blocks(h, self.time, floor):
            return
        if numbers := doubted(h, number, self.history):
            other = without(h, numbers, self.history, floor=floor)
            if other is not None:
                yield other
            else:
                self._in_vain(key, h, IN_VAIN)

    def _surveyed(self, best: Hypothesis, sensed: Sensed, drop: float) -> Iterator[Hypothesis]:
        """Now and then, while something is in doubt, the map in which each label is one place."""
        if self.time not in SURVEYS or self._clear or self.history.start or self.history.end > self.time + 1:
            return
        if self.scheme.displacements is None or sensed.others is not None or not (self.scheme.sensors and self.awake):
            return
        total = self.history.norm(0)
        found = surveyed(best, self.history, floor=total + best.weight - drop)
        if found is not None:
            found.weight -= total
            yield found

    def _folds(self, h: Hypothesis, floor: float) -> Iterator[Hypothesis]:
        """The foldings that are probable enough."""
        for one, other, period in pairs(h):
            key = attempt(h, one, other, period=period)
            if self._tried.get(key, NEVER).blocks(h, self.time, floor):
                continue
            united = union(h, one, other, period=period, floor=floor)
            if isinstance(united, Hypothesis):
                yield united
                yield from self._rethought(united, united.here, floor)
            else:
                self._in_vain(key, h, united)

    def _rethought(self, h: Hypothesis, number: int, floor: float) -> Iterator[Hypothesis]:
        """Hypotheses in which ways of a place, or the loops that they close, lead elsewhere."""
        key: Attempt = (number, number, True, 0)
        if self._tried.get(key, NEVER).blocks(h, self.time, floor):
            return
        if (straight := straightened(h, number, floor=floor)) is not None:
            yield straight
        if h.counts.yes[ELSEWHERE] >= 0.5:
            yield from recharted(h, number, floor=floor)
            self._in_vain(key, h, CONTRADICTED)

    def _in_vain(self, key: Attempt, h: Hypothesis, worth: float) -> None:
        before = self._tried.get(key)
        self._overwritten.append((key, before))
        self._tried[key] = (before or NEVER).again(h, self.time, worth)
