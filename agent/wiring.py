"""What an agent is wired of, and what it says of itself."""

import sys
from collections import deque
from collections.abc import Hashable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ..inference import Belief, RateOf
from ..model import (
    CogmapError,
    CognitiveMap,
    Contexts,
    FactorGraph,
    Growth,
    Motions,
    MotionSpec,
    Pose,
    PredictedGrowth,
    Sensor,
    Slice,
    is_whole,
    safe,
    updates,
    window_graph,
)
from ..planning import LocalCache, Plan, Planner
from .expecting import expected_at
from .hypotheses import MapHypothesis
from .mapper import Mapper
from .parts import parts_of
from .recognition import Recognition
from .settings import Settings
from .state import GivenPreferences, State
from .trace import StepRecord

Seed = int | np.random.SeedSequence | None


class Wired:
    """The parts of an agent, joined, and what can be asked of it without anything happening.

    Attributes:
        map: what it believes the world to be.
        growth: its growth rule.
        planner: its planner.
        rng: the generator.
        trace: one record a step that was answered; see `keep`.
    """

    def _assemble(
        self,
        motions: MotionSpec | Mapping[str, Sequence[int]],
        sensors: Iterable[Sensor] | None,
        pose: Pose | None,
        growth: Growth | None,
        planner: Planner | None,
        settings: Settings,
        seed: Seed,
    ) -> None:
        """Put the parts together; the map is empty yet."""
        sensors = None if sensors is None else list(sensors)
        parts: list[tuple[str, object, type, str]] = [
            *[("a sensor", sensor, Sensor, "sensors=[Sight(), Ways()]") for sensor in sensors or ()],
            ("pose", pose, Pose, "pose=NoPose()"),
            ("growth", growth, Growth, "growth=PredictedGrowth()"),
            ("planner", planner, Planner, "planner=Planner(policies=MapGuided())"),
            ("settings", settings, Settings, "settings=Settings(look_ahead=6)"),
        ]
        for name, part, kind, example in parts:
            if part is not None and not isinstance(part, kind):
                raise CogmapError(f"agent: {name} is {part!r}; give an object, such as {example}")
        self._settings = settings
        self.growth = growth or PredictedGrowth()
        self.planner = planner or Planner()
        self.map = CognitiveMap(
            Motions.of(motions),
            sensors=sensors,
            pose=pose,
            priors=settings.priors,
            rates=settings.rates,
            displacement=settings.filter.displacement,
            slip=settings.filter.slip,
        )
        self.rng = _generator(seed)
        self.trace: list[StepRecord] = []
        self._recognising = settings.hypotheses is not None and not self.map.pose.settles
        self._recognition = Recognition(self.map, self.growth, settings.hypotheses)
        mirror = self._recognition.mirror
        self._mapper = Mapper(self.map, self.growth, mirror.ways, mirror.counterparts, settings)
        self._cache = LocalCache(self.map, settings.look_ahead)
        self._plan: Plan | None = None
        self._torn: str | None = None
        self.planner.check(self.map.motions, settings.look_ahead)
        self._state = State(deque[Slice](maxlen=settings.window + 1))

    @property
    def settings(self) -> Settings:
        """Its settings; they never change."""
        return self._settings

    @property
    def keep(self) -> int | None:
        """Steps of which trace and log of growth keep everything; may be set at any time, and is not saved."""
        return self._keep

    @keep.setter
    def keep(self, steps: int | None) -> None:
        if steps is not None and not is_whole(steps, 1, sys.maxsize):
            raise CogmapError(f"agent: keep is {steps!r}; give a positive whole number of steps, or None")
        self._keep = self.map.growth.keep = steps

    @property
    def steps(self) -> int:
        """Observations taken in so far."""
        return self._state.steps

    @property
    def cost(self) -> float:
        """What its moves have cost so far, as percepts said (`cost`); 0 where none did."""
        return sum(total for _, total in self._state.costs.values())

    @property
    def belief(self) -> Belief:
        """What it believes about where it is, after the last observation."""
        if self._state.belief is None:
            raise CogmapError("agent: it has seen nothing yet; call step(observation) first")
        return self._state.belief

    @property
    def hypotheses(self) -> tuple[MapHypothesis, ...]:
        """What it holds possible of the map and of where it is in it, the most probable first; `map` is that one."""
        return self._recognition.compared()

    @property
    def learned_rates(self) -> tuple[RateOf, ...]:
        """What it has learned of how reliable its sensors, its moves and the ways of this world are."""
        return tuple(self._recognition.rates)

    @property
    def contexts(self) -> dict[Hashable, float]:
        """Probability of each context, as it believes now; empty where its map knows of none."""
        found = [sensor for sensor in self.map.sensors.values() if isinstance(sensor, Contexts)]
        return found[0].belief(self.belief.places) if found else {}

    def steps_in(self, place: int) -> tuple[int, ...]:
        """The last steps, a handful at most, at which it was in a place of its map, as it believes now.

        Raises:
            CogmapError: the map has no such place.
        """
        self.map.check_place(place)
        return self._recognition.mirror.steps_in(place) if self._recognising else self.map.pose.steps_in(place)

    @property
    def certain(self) -> bool:
        """Whether one place holds enough of the belief to learn (paper's threshold: 0.7)."""
        return self.belief.certainty >= self.settings.certainty

    @property
    def preferences(self) -> GivenPreferences:
        """The preferences that are, or were, in force for `plan`."""
        self._require_plan()
        return self._state.preferences if self._state.choice is None else self._state.choice.preferences

    @property
    def window(self) -> tuple[Slice, ...]:
        """What `graph` is made of, the oldest step first."""
        return tuple(self._state.window)

    @property
    def expected(self) -> Mapping[str, Hashable]:
        """What each sensor was expected to show where the agent believes to be, before the last observation.

        Of ways, for each action whether it was; None where nothing was known. Where the map was written anew it is what
        is known now.
        """
        state = self._state
        if state.expected is None:
            learned = () if state.revised else updates(self.map.changes.since(state.begun)[0] or ())
            state.expected = expected_at(self.map, self.belief.place, learned)
        return state.expected

    @property
    def graph(self) -> FactorGraph:
        """The factor graph of the current window; while it is open which map is right, with that as a variable."""
        graph = window_graph(self.map, self.window)
        return self._recognition.asked(graph, step=self.steps - 1) if self.steps else graph

    @property
    def parts(self) -> dict[str, Any]:
        """What it is made of, as plain JSON values: the kind of each part and its options."""
        return parts_of(self.map, self.growth, self.planner)

    def _repr_html_(self) -> str:
        """Its map, and where it believes to be."""
        belief = (
            f"<p>after {self.steps} steps: {safe(self.belief)}</p>" if self.steps else "<p>it has seen nothing yet</p>"
        )
        return f"<div>{belief}{self.map._repr_html_()}</div>"  # pyright: ignore[reportPrivateUsage]

    def __repr__(self) -> str:
        return f"Agent({self.map!r}, step {self.steps})"

    def _require_plan(self) -> None:
        if not self._state.steps:
            raise CogmapError("agent: it has planned nothing yet; call step(observation) first")


def _generator(seed: Seed) -> np.random.Generator:
    try:
        return np.random.default_rng(seed)
    except (TypeError, ValueError) as error:
        raise CogmapError(f"agent: seed is {seed!r}; use a whole number of 0 or more, or None") from error
