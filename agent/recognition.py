"""Which place is which: hypotheses about the map, and the map as the most probable one has it."""

from collections.abc import Mapping
from dataclasses import replace
from math import exp
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..inference import (
    NOWHERE,
    Belief,
    Hypothesis,
    Message,
    Place,
    RateOf,
    Tracker,
    TrackerOptions,
    open_probability,
    rates_of,
    together,
    tracker_knowing,
    ways_misread,
)
from ..model import CognitiveMap, FactorGraph, Growth, Percept
from .checks import check_recognition
from .doors import Doors, passable
from .hypotheses import MapHypothesis, compared
from .knowing import records_of
from .mirror import Mirror
from .question import with_question
from .sensing import Sensing
from .structure import OpenQuestion

Arrays = dict[str, NDArray[Any]]

HARDLY = 1.5  # Ways that were misread so far, as is expected, up to which the last look at one is believed
FAR = 512  # Places within which another one that was never seen is within reach
DECIDED = 0.8  # Probability from which on another hypothesis than the one that is followed changes the map
SURER = 0.98  # Share of what hypotheses hold of a place from which on the filter need not be overruled

SLIPPERY = 0.05
"""Share of actions that go astray from which on the map says where they lead by what else may be carried out."""

RULED_OUT, UNSEEN = 0.01, 0.3
"""Odds beside the most probable hypothesis down to which the one that is followed may be followed on; and where no way
was looked at: the filter, which names the one to follow, cannot tell there a bump from a place that looks the same."""


class Recognition:
    """Weighs hypotheses about the map, and has the map say what the most probable one says.

    Attributes:
        sensing: percepts in the words of hypotheses.
        tracker: the hypotheses.
        mirror: the places of the followed one in the map.
        followed: the one that the map says; None before the first step.
        moved: whether it has the agent moved by someone else in the last step.
        looked: what the last percept said of the ways.
    """

    def __init__(self, map_: CognitiveMap, growth: Growth, options: TrackerOptions | None) -> None:
        self._map = map_
        self.sensing = Sensing(map_)
        self.tracker = Tracker(self.sensing.scheme, options)
        self.mirror = Mirror(map_, growth, self.sensing.actions)
        self.followed: Hypothesis | None = None
        self.moved = False
        self.looked: tuple[bool | float | None, ...] | None = None
        map_.transitions.carried_out = self.carried_out

    @property
    def rates(self) -> list[RateOf]:
        """What is learned of how this world is, as the hypothesis that is followed has it."""
        return [] if self.followed is None else rates_of(self.followed)

    def carried_out(self, action: int) -> NDArray[np.float64] | None:
        """`[K]` P(action carried out | `action` is given); None where actions hardly ever go astray."""
        astray = 0.0 if self.followed is None else self._now.chances.astray
        if astray < SLIPPERY:
            return None
        ways, motions, stays = self.sensing.ways, self._map.motions, NOWHERE
        given = ways.get(action, stays)
        slips = [astray * self._now.slip(given, ways.get(taken, stays)) for taken in range(len(motions))]
        slips[action] = 0.0
        slips[action] = 1.0 - sum(slips)
        return np.array(slips)

    @property
    def _now(self) -> Hypothesis:
        assert self.followed is not None
        return self.followed

    def take_in(self, percept: Percept, *, step: int) -> None:
        """Weigh the hypotheses by what a step brought; of the map no more than in which context it is seen changes."""
        self.mirror.counterparts.turn(self.mirror.places, percept, step=step)
        sensed = self.sensing.sensed(percept, place=self.mirror.places.get)
        self.looked = percept.open
        self.tracker.step(sensed, self.sensing.labels())

    def choose(self, belief: Belief) -> bool:
        """Follow the hypothesis that goes on from the one followed, and has the agent where `belief` has it.

        Only what is `DECIDED` changes the map's mind, or else it would change to and fro while a question is open.

        Returns:
            Whether there is one; if not, the most probable one is followed from now on.
        """
        before, best = self.followed, self.tracker.best
        candidates = [h for h in self.tracker.hypotheses if self._goes_on(h, belief.place)]
        agreed = bool(candidates) and self._may_go_on(candidates[0], best)
        self.followed = candidates[0] if agreed else best
        self.moved = self._moved(before)
        return agreed

    def _may_go_on(self, h: Hypothesis, best: Hypothesis) -> bool:
        """Whether a hypothesis is followed on: the best one is not decided, nor is this one as good as ruled out."""
        least = UNSEEN if self.looked is None else RULED_OUT
        return h is best or (exp(best.weight) < DECIDED and exp(h.weight - best.weight) > least)

    def _goes_on(self, h: Hypothesis, place: int) -> bool:
        if h.origin is not self.followed or self.mirror.missed:
            return False
        return self.mirror.holds(h, place) if h.crowd else self.mirror.grows(h, place)

    @property
    def lost(self) -> bool:
        """Whether it is open where in its map the followed hypothesis has the agent; it learns nothing then."""
        return bool(self._now.crowd)

    def _moved(self, before: Hypothesis | None) -> bool:
        """Whether the agent was moved, as the hypothesis that is followed has it."""
        now = self._now
        if before is None or before.here == now.here or now.places.get(before.here) is None:
            return False
        return all(source != before.here for source, _ in now.places[now.here].into)

    @property
    def place(self) -> int:
        """The place of the map where the followed hypothesis has the agent."""
        return self.mirror.places[self._now.here]

    @property
    def doors(self) -> Doors:
        """For each action whether its way is believed open here, or how much so; None where nothing is known of it.

        Where ways are hardly ever misread the last look says it: a door that closes is not taken for a wrong reading.
        """
        looked = () if ways_misread(self._now) > HARDLY else self.looked or ()
        if looked and all(look in (0, 1) for look in looked):
            return tuple(map(bool, looked))
        doors = self.mirror.doors(self._now, self._now.here)
        if not looked:
            return doors
        return tuple(bool(look) if look in (0, 1) else door for look, door in zip(looked, doors, strict=True))

    @property
    def one_way(self) -> tuple[int, ...]:
        """The actions whose ways from there are believed open on one side alone."""
        return self.mirror.one_way(self._now, self._now.here)

    def open(self, percept: Percept) -> tuple[bool, ...]:
        """For each action whether its way may be open now: neither sensed nor believed shut."""
        sensed = percept.passable or (True,) * len(self._map.motions)
        if self.followed is None:
            return sensed
        place = self.mirror.places.get(self._now.here)
        doors = self.doors if place is None else self.mirror.counterparts.corrected(place, self.doors)
        return tuple(is_open and door for is_open, door in zip(sensed, passable(doors), strict=True))

    def compared(self) -> tuple[MapHypothesis, ...]:
        """Every hypothesis, the most probable first, beside the one that is followed."""
        hypotheses = self.tracker.hypotheses
        return compared(self._now, hypotheses, self.mirror) if hypotheses else ()

    @property
    def question(self) -> OpenQuestion | None:
        """What is worth telling apart; None where nothing is, or new places are within reach, which tell as well.

        Those are the hypotheses, and, where ways are misread now and then, whether the doors were read right.
        """
        hypotheses, now = self.tracker.hypotheses, self.followed
        misread = now is not None and ways_misread(now) > HARDLY
        if now is None or (len(hypotheses) < 2 and not misread):
            return None
        if not (self._map.visited.all() or _enclosed(now)):
            return None
        tries = all(look is None for look in self.looked or ()) and _tried(now)
        return OpenQuestion(hypotheses, self.sensing.ways, doors_of=now if misread else None, tries=tries)

    def asked(self, graph: FactorGraph, *, step: int) -> FactorGraph:
        """The graph of the window with the question which hypothesis is right, if that is open."""
        hypotheses = self.tracker.hypotheses
        if len(hypotheses) < 2:
            return graph
        weights = [exp(h.weight) for h in hypotheses]
        places = [self.mirror.place(self._now if together(h, self._now) else h) for h in hypotheses]
        return with_question(graph, weights, places, followed=hypotheses.index(self._now), step=step)

    def missed(self) -> None:
        """The map was not taught the last step."""
        self.mirror.miss(self._now, self._now.touched)

    def grown(self, place: int) -> bool:
        """The map was taught the last step, in this place; whether it is what the hypothesis says."""
        self.mirror.grown(self._now, place, self._now.touched)
        return not self.mirror.outdated(self._now)

    def follow(self, *, step: int) -> dict[int, int] | None:
        """Have the map say what the most probable hypothesis says; see `Mirror.follow`."""
        return self.mirror.follow(self._now, step=step)

    def weighed(self, belief: Belief, percept: Percept) -> Belief:
        """The belief with the probability of the hypotheses in which the agent is elsewhere than it says.

        Where they are surer than it they are believed instead: that moves fail, or go astray, the filter does not know.
        """
        if len(self.tracker.hypotheses) == 1:
            return belief if self.lost or belief.message.certainty > SURER else self.believed(percept, belief.place)
        mass, elsewhere = self.mirror.belief(self._weights(), here=belief.place)
        if not self.lost and belief.message.certainty < SURER * mass.get(belief.place, 0.0):
            return self.believed(percept, belief.place)
        held = belief.places
        lost = elsewhere + sum(p for place, p in mass.items() if place not in held)
        return replace(belief, doubt=min(lost, 1.0))

    def believed(self, percept: Percept, here: int) -> Belief:
        """The belief that hypotheses amount to, over the places of the map; the followed one has the agent `here`."""
        map_, none = self._map, np.zeros(0, dtype=np.int64)
        mass, elsewhere = self.mirror.belief(self._weights(), here=here)
        places = np.array(sorted(mass), dtype=np.int64)
        q = np.array([mass[place] for place in places.tolist()])
        told, q = map_.log_likelihood(places, percept), q / q.sum()
        return Belief(
            message=Message(places, map_.pose.of(places), q),
            evidence=-float(np.log(q @ np.exp(-told))),  # over these places: 1 / P(o) = E_Q[1 / P(o | s)]
            log_likelihood=told,
            moved=float(self.moved),
            dropped=0.0,
            examined=True,
            pairwise=(none, none, np.zeros(0)),
            doubt=elsewhere,
            likelihoods=map_.likelihoods(places, percept),
        )

    # -- going back ----------------------------------------------------------------------------------------

    def savepoint(self) -> tuple[Any, ...]:
        """What `go_back` needs to undo the next step."""
        return self.tracker, self.tracker.checkpoint(), self.followed, self.moved, self.looked, self.mirror.savepoint()

    def go_back(self, point: tuple[Any, ...]) -> None:
        """Be as it was before that step, wherever it was broken off."""
        self.tracker, checkpoint, self.followed, self.moved, self.looked, mirror = point
        self.tracker.rollback(checkpoint)
        self.mirror.go_back(mirror)

    # -- files ---------------------------------------------------------------------------------------------

    def state(self, arrays: Arrays) -> dict[str, Any]:
        """All that the next steps depend on: plain JSON values; arrays go into `arrays`."""
        tracker, mirror = self.tracker.state(), self.mirror
        arrays |= {f"tracker.{name}": values for name, values in tracker[1].items()}
        places = [[number, place] for number, place in mirror.places.items()]
        followed = next((k for k, h in enumerate(self.tracker.hypotheses) if h is self.followed), None)
        own = {"places": places, "missed": sorted(mirror.missed), "followed": followed, "moved": self.moved}
        return {"tracker": tracker[0], **own}

    def restore(self, state: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> None:
        """Take over what `state` gave. Raises CogmapError: it is damaged, or of another map."""
        prefix = "tracker."
        own = {name.removeprefix(prefix): arrays[name] for name in arrays if name.startswith(prefix)}
        self.tracker = Tracker.restored(self.sensing.scheme, self.tracker.options, (state["tracker"], own))
        places: dict[Any, Any] = dict(state["places"])
        followed, missed = state["followed"], state["missed"]
        check_recognition(places, missed, followed, state["moved"], self._map, self.tracker.hypotheses)
        self.followed = None if followed is None else self.tracker.hypotheses[followed]
        if self.followed is not None:
            self.mirror.restore(self.followed, places, missed=missed)
        self.moved = state["moved"]

    def forget(self) -> None:
        """Have no hypotheses."""
        self.tracker = Tracker(self.sensing.scheme, self.tracker.options)
        self.mirror.places, self.followed, self.moved = {}, None, False

    @property
    def start(self) -> Message | None:
        """Where an agent that begins with a map is thought to be until it has seen something; None without a map."""
        if self.followed is None:
            return None
        return Message.sure(self.place, int(self._map.pose.of(np.array([self.place]))[0]))

    def begin_with(self, records: Mapping[int, Place]) -> None:
        """Begin with places that are known beforehand; the map says what they say."""
        self._begin(records, here=0, time=len(records))
        self.follow(step=0)

    def know(self, here: int, *, step: int) -> None:
        """Begin with what the map says, the agent being in `here`."""
        records, places = records_of(self._map, self.sensing)
        number = {place: number for number, place in places.items()}
        self._begin(records, here=number[here], time=max(step, len(records)))
        self.mirror.restore(self._now, places)

    def _begin(self, records: Mapping[int, Place], *, here: int, time: int) -> None:
        labels, options = self.sensing.labels(), self.tracker.options
        self.tracker = tracker_knowing(
            self.sensing.scheme, records, here=here, time=time, labels=labels, options=options
        )
        self.followed = self.tracker.best

    def _weights(self) -> list[tuple[Hypothesis, float]]:
        others = [h for h in self.tracker.hypotheses if h is not self.followed]
        return [(h, exp(h.weight)) for h in (self._now, *others)]


def _tried(h: Hypothesis) -> bool:
    """Whether every way was looked at or tried, or is known from elsewhere."""
    records = (h.places[number] for number in h.places)
    return all(
        known.net or h.neighbour(record, way) != NOWHERE for record in records for way, known in enumerate(record.ways)
    )


def _enclosed(h: Hypothesis) -> bool:
    """Whether no open way leads from where the agent is to a place never seen, but for places that are far away."""
    found = {h.here}
    queue = [h.here]
    for number in queue:
        if len(found) > FAR:
            break
        record = h.places[number]
        for way in h.awake:
            if open_probability(h, number, way) > 0.5:
                to = h.neighbour(record, way)
                if to == NOWHERE:
                    return False
                if to not in found:
                    found.add(to)
                    queue.append(to)
    return True
