"""Which place is which: hypotheses about the map, and the map as the most probable one has it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import exp
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..inference import Belief, Hypothesis, Message, RateOf, Tracker, TrackerOptions, rates_of, tracker_knowing
from ..model import CognitiveMap, Growth, Percept
from .knowing import records_of
from .mirror import Mirror
from .sensing import Sensing

Arrays = dict[str, NDArray[Any]]


class Recognition:
    """Weighs hypotheses about the map, and has the map say what the most probable one says.

    Attributes:
        sensing: percepts in the words of hypotheses.
        tracker: the hypotheses.
        mirror: the places of the most probable one in the map.
        moved: whether the most probable one has the agent moved by someone else in the last step.
    """

    def __init__(self, map_: CognitiveMap, growth: Growth, options: TrackerOptions) -> None:
        self._map = map_
        self.sensing = Sensing(map_)
        self.tracker = Tracker(self.sensing.scheme, options)
        self.mirror = Mirror(map_, growth, self.sensing.actions)
        self.moved = False

    @property
    def best(self) -> Hypothesis:
        """The most probable hypothesis."""
        return self.tracker.best

    @property
    def rates(self) -> list[RateOf]:
        """What is learned of how this world is, as the most probable hypothesis has it."""
        return rates_of(self.best) if self.tracker.hypotheses else []

    def take_in(self, percept: Percept, *, certain: bool) -> None:
        """Weigh the hypotheses by what a step brought; the map stays as it is."""
        sensed = self.sensing.sensed(percept, certain=certain, place=self.mirror.places.get)
        before = self.best.here if self.tracker.hypotheses else None
        self.tracker.step(sensed, self.sensing.labels())
        self.moved = self._moved(before)

    def _moved(self, before: int | None) -> bool:
        """Whether the agent was moved, as the most probable hypothesis has it."""
        best = self.best
        if before in (None, best.here) or best.places.get(before) is None:
            return False
        return all(source != before for source, _ in best.places[best.here].into)

    def agrees(self, belief: Belief) -> bool:
        """Whether the most probable hypothesis only adds this step to the map, and is where `belief` is."""
        change, mirror = self.tracker.change, self.mirror
        return change.kind == "extended" and mirror.current and mirror.grows(self.best, belief.place)

    @property
    def place(self) -> int:
        """The place of the map where the most probable hypothesis has the agent."""
        return self.mirror.places[self.best.here]

    @property
    def doors(self) -> tuple[bool | None, ...]:
        """For each action whether its way is believed open here; None where nothing is known of it."""
        return self.mirror.doors(self.best, self.best.here)

    def open(self, percept: Percept) -> tuple[bool, ...]:
        """For each action whether its way may be open now: neither sensed nor believed shut."""
        sensed = percept.open or (True,) * len(self._map.motions)
        return tuple(is_open and door is not False for is_open, door in zip(sensed, self.doors, strict=True))

    def missed(self) -> None:
        """The map was not taught the last step."""
        self.mirror.current = False

    def grown(self, place: int) -> bool:
        """The map was taught the last step, in this place; whether it is what the hypothesis says."""
        self.mirror.grown(self.best, place, self.tracker.change.places)
        return not self.mirror.shut_out(self.best)

    def follow(self, *, step: int) -> dict[int, int] | None:
        """Have the map say what the most probable hypothesis says; see `Mirror.follow`."""
        return self.mirror.follow(self.best, step=step)

    def weighed(self, belief: Belief) -> Belief:
        """The belief with the probability of the hypotheses in which the agent is elsewhere than it says."""
        if len(self.tracker.hypotheses) == 1:
            return belief
        mass, elsewhere = self.mirror.belief(self._weights(), here=belief.place)
        held = belief.places
        lost = elsewhere + sum(p for place, p in mass.items() if place not in held)
        return replace(belief, doubt=min(lost, 1.0))

    def believed(self, percept: Percept) -> Belief:
        """The belief that the hypotheses amount to, over the places of the map."""
        map_, none = self._map, np.zeros(0, dtype=np.int64)
        mass, elsewhere = self.mirror.belief(self._weights(), here=self.mirror.places[self.best.here])
        places = np.array(sorted(mass), dtype=np.int64)
        q = np.array([mass[place] for place in places.tolist()])
        return Belief(
            message=Message(places, map_.pose.of(places), q / q.sum()),
            evidence=self.tracker.evidence,
            log_likelihood=map_.log_likelihood(places, percept),
            moved=float(self.moved),
            dropped=0.0,
            examined=True,
            pairwise=(none, none, np.zeros(0)),
            doubt=elsewhere,
            likelihoods=map_.likelihoods(places, percept),
        )

    # -- files ---------------------------------------------------------------------------------------------

    def state(self, arrays: Arrays) -> dict[str, Any]:
        """All that the next steps depend on: plain JSON values; arrays go into `arrays`."""
        tracker, mirror = self.tracker.state(), self.mirror
        arrays |= {f"tracker.{name}": values for name, values in tracker[1].items()}
        places = [[number, place] for number, place in mirror.places.items()]
        return {"tracker": tracker[0], "places": places, "current": mirror.current, "moved": self.moved}

    def restore(self, state: Mapping[str, Any], arrays: Arrays) -> None:
        """Take over what `state` gave.

        Raises:
            CogmapError: it is damaged, or of another map.
        """
        prefix = "tracker."
        own = {name.removeprefix(prefix): values for name, values in arrays.items() if name.startswith(prefix)}
        self.tracker = Tracker.restored(self.sensing.scheme, self.tracker.options, (state["tracker"], own))
        places = {int(number): int(place) for number, place in state["places"]}
        self.mirror.restore(self.best, places, current=bool(state["current"]))
        self.moved = bool(state["moved"])

    def know(self, here: int, *, step: int) -> None:
        """Begin with what the map says, the agent being in `here`."""
        sensing, (records, places) = self.sensing, records_of(self._map, self.sensing)
        number = {place: number for number, place in places.items()}
        self.tracker = tracker_knowing(
            sensing.scheme,
            records,
            here=number[here],
            time=max(step, len(records)),
            labels=sensing.labels(),
            options=self.tracker.options,
        )
        self.mirror.restore(self.best, places, current=True)

    def _weights(self) -> list[tuple[Hypothesis, float]]:
        return [(h, exp(h.weight)) for h in self.tracker.hypotheses]
