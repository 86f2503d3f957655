"""The loop that joins it all: perceive, infer, learn, grow, plan, act."""

from __future__ import annotations

from collections import deque
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..inference.filter import advance, begin
from ..inference.message import Belief, Evidence
from ..inference.rivals import DECISIVE, Rivals, advance_rivals, certain_of, rivals_of
from ..model import FactorGraph
from ..model.cognitive_map import CognitiveMap
from ..model.errors import CogmapError
from ..model.growth_event import GrowthEvent
from ..model.labels import decode, encode
from ..model.map_state import map_arrays, restore_map
from ..model.motions import Motions, MotionSpec
from ..model.slices import Slice, take_slice, window_graph
from ..model.updates import updates
from ..planning import CHOICES, POLICIES, LocalCache, MapGuided, Plan, Planner, Preferences
from .mapper import Mapper
from .past import past_state, restore_past, restore_rivals, rivals_state
from .perception import perceive
from .remembered import Choice, Wishes, choice_state, restore_choice
from .settings import Settings
from .state import Arrays, belief_state, restore_belief, restore_window, window_state
from .trace import StepRecord

Seed = int | np.random.SeedSequence | None


class Agent:
    """An agent that builds its own map.

    It is given observations only (`{"sight": label, "open": truth values over the actions}`) and answers with
    actions; it starts at what it calls the origin, and never learns where that is in the world.

    Args:
        motions: names and displacements of the actions: `world.motions`, or a mapping name -> displacement.
        settings: every knob; see `Settings`.
        seed: of the generator that breaks ties and draws policies.

    Attributes:
        map: what it believes the world to be.
        settings: its settings; they never change.
        trace: one record a step.

    Raises:
        CogmapError: motions or settings that make no sense.
    """

    def __init__(
        self,
        motions: MotionSpec | Mapping[str, Sequence[int]],
        *,
        settings: Settings | None = None,
        seed: Seed = None,
    ) -> None:
        self.settings = settings or Settings()
        self.map = CognitiveMap(Motions.of(motions), priors=self.settings.priors)
        self.trace: list[StepRecord] = []
        self._rng = _generator(seed)
        self._planner = _planner(self.settings)
        self._planner.check(self.map.motions, self.settings.look_ahead)
        self._mapper, self._cache = Mapper(self.map, self.settings), LocalCache(self.map, self.settings.look_ahead)
        self._window: deque[Slice] = deque(maxlen=self.settings.window + 1)
        self._pending = 0
        self._belief: Belief | None = None
        self._plan: Plan | None = None
        self._choice: Choice | None = None
        self._steps = 0
        self._action: int | None = None
        self._open: tuple[bool, ...] = ()
        self._goals: dict[Hashable, float] = {}
        self._goal_places: dict[int, float] = {}
        self._rivals = Rivals.none(len(self.map.motions.displacements[0]))
        self._retracted: int | None = None
        self._mapper.wake()

    # -- the public face -----------------------------------------------------------------------------------

    @property
    def steps(self) -> int:
        """Observations taken in so far."""
        return self._steps

    @property
    def belief(self) -> Belief:
        """What it believes about where it is, after the last observation."""
        if self._belief is None:
            raise CogmapError("agent: it has seen nothing yet; call step(observation) first")
        return self._belief

    @property
    def certain(self) -> bool:
        """Whether one place holds enough of the belief to learn (paper's threshold: 0.7)."""
        return self.belief.certainty >= self.settings.certainty

    @property
    def plan(self) -> Plan:
        """What it considered at the last step, and what it chose; worked out again where it was loaded."""
        if self._plan is None:
            choice = self._last_choice()
            self._plan = choice.of(self._planned(self._open, choice.wishes, np.random.default_rng(0)))
        return self._plan

    @property
    def wishes(self) -> Wishes:
        """The preferences that were in force at the last choice."""
        return self._last_choice().wishes

    @property
    def window(self) -> tuple[Slice, ...]:
        """What `graph` is made of, the oldest step first."""
        return tuple(self._window)

    @property
    def graph(self) -> FactorGraph:
        """The factor graph of the current window."""
        return window_graph(self.map, self.window)

    def prefer(
        self, sights: Mapping[Hashable, float] | None = None, *, places: Mapping[int, float] | None = None
    ) -> None:
        """Set log preferences over all others, in nats (before `goal_weight`); none explores.

        Args:
            sights: by label. Labels never met are allowed: until they are, "something new" carries the hope.
            places: by number of the place in the map, such as `map.place_at(position)`.

        Raises:
            CogmapError: no mapping, a preference that is no finite number, or a place that the map does not have.
        """
        for given in (sights, places):
            if not isinstance(given, Mapping | None):  # pyright: ignore[reportUnnecessaryIsInstance]
                kind = type(given).__name__
                raise CogmapError(f"agent: preferences are a {kind}; give a mapping to log preferences in nats")
        sights, places = dict(sights or {}), dict(places or {})
        for wanted, value in (*sights.items(), *places.items()):
            if not (isinstance(value, int | float | np.number) and np.isfinite(value)):  # pyright: ignore[reportUnnecessaryIsInstance]
                raise CogmapError(
                    f"agent: preference {value!r} of {wanted!r} is not a finite number; give a log preference in nats"
                )
        for place in places:
            if place not in self.map.places:
                raise CogmapError(f"agent: no place {place!r} to prefer; places are 0 to {len(self.map.places) - 1}")
        self._goals, self._goal_places = sights, places

    def step(self, observation: Mapping[str, Any]) -> int:
        """Take in one observation and answer with the index of the next action.

        Raises:
            CogmapError: the observation lacks a key, or has a wrong number of doors.
        """
        label, open_ = perceive(observation, self.map.motions)
        cursor = len(self.map.changes)
        self.map.grow_time(step=self._steps)
        sight = self.map.new_sight(label, step=self._steps)
        evidence = self._infer(sight, open_)
        self._remember(evidence)
        self._learn(evidence)
        self._choose(open_)
        self._record(label, open_, cursor)
        self._action, self._open = self.plan.action, open_
        self._steps += 1
        return self.plan.action

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything the agent knows to an npz file (JSON header, schema version, no pickle)."""
        from .storage import save

        save(self, path)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Agent:
        """The agent that `save` wrote; it walks on exactly as that one would have.

        Raises:
            CogmapError: no such file, or it is no saved map, truncated, or from a newer schema.
        """
        from .storage import load

        return load(path)

    def state(self) -> tuple[dict[str, Any], Arrays]:
        """Everything that the next steps depend on: a JSON header and arrays (the trace is left out)."""
        belief, belief_arrays = belief_state(self._belief)
        window, window_arrays = window_state(list(self._window))
        header = {
            "motions": {"names": self.map.motions.names, "displacements": self.map.motions.displacements},
            "settings": self.settings.to_dict(),
            "sights": [encode(label) for label in self.map.sights],
            "positions": [encode(label) for label in self.map.positions],
            "goals": [[encode(label), value] for label, value in self._goals.items()],
            "goal_places": [[int(place), value] for place, value in self._goal_places.items()],
            "steps": self._steps,
            "pending": self._pending,
            "action": self._action,
            "open": self._open,
            "rng": self._rng.bit_generator.state,
            "belief": belief,
            "rivals": rivals_state(self._rivals),
            "recent": past_state(self._mapper),
            "window": window,
            "choice": choice_state(self._choice),
        }
        return header, {**map_arrays(self.map), **belief_arrays, **window_arrays}

    @classmethod
    def from_state(cls, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> Agent:
        """The agent that `state` took apart."""
        motions = dict(zip(header["motions"]["names"], header["motions"]["displacements"], strict=True))
        agent = cls(motions, settings=Settings.from_dict(header["settings"]))
        agent.map = CognitiveMap(Motions.of(motions), priors=agent.settings.priors)
        labels = ([decode(label) for label in header[name]] for name in ("sights", "positions"))
        restore_map(agent.map, arrays, *labels)
        agent._mapper, agent._cache = (
            Mapper(agent.map, agent.settings),
            LocalCache(agent.map, agent.settings.look_ahead),
        )
        agent._goals = {decode(label): value for label, value in header["goals"]}
        agent._goal_places = dict(header["goal_places"])
        agent._steps, agent._pending, agent._action = header["steps"], header["pending"], header["action"]
        agent._open = tuple(header["open"])
        agent._rng.bit_generator.state = header["rng"]
        agent._rivals = restore_rivals(header["rivals"], len(agent.map.motions.displacements[0]))
        restore_past(agent._mapper, header["recent"])
        agent._belief = restore_belief(header["belief"], arrays)
        agent._window.extend(restore_window(header["window"], arrays))
        agent._choice = restore_choice(header.get("choice"))  # files of before have none
        return agent

    def __repr__(self) -> str:
        return f"Agent({self.map!r}, step {self._steps})"

    # -- the parts of a step -------------------------------------------------------------------------------

    def _infer(self, sight: int, open_: tuple[bool, ...]) -> Evidence:
        action = self._action
        was_open = action is not None and self._open[action]
        evidence = Evidence(action=action, was_open=was_open, sight=sight, open=open_)
        self._mapper.begin(self._steps, evidence)
        if self._belief is None:
            self._belief = begin(self.map, 0, evidence)
        else:
            if action is not None and was_open and self.certain:
                self._mapper.enter(self._belief.place, action, step=self._steps)
            self._belief = advance(self.map, self._belief.message, evidence, self.settings.filter)
            self._doubt(evidence)
        return evidence

    def _doubt(self, evidence: Evidence) -> None:
        """Weigh the belief against its rivals; commit it to a new place, or take back what it taught."""
        mapper = self._mapper
        rivals = advance_rivals(
            self.map, self._rivals, self.belief, evidence, displacement=self.settings.filter.displacement
        )
        self._retracted = None
        if len(rivals):
            rivals = rivals.kept(rivals.since >= mapper.remembered)
            if len(rivals) and rivals.probability(rivals.best) >= DECISIVE:
                self._change_mind(rivals, evidence)
                return
            self._belief = replace(self.belief, doubt=rivals.doubt)
        belief = self.belief
        if self.certain and not self.map.visited[belief.place]:
            self._rivals = rivals.joined(rivals_of(self.map, belief, step=self._steps, visits=mapper.visits_before))
            self._belief = belief.committed()
        else:
            self._rivals = rivals

    def _change_mind(self, rivals: Rivals, evidence: Evidence) -> None:
        """The best of the rivals was right: relive what happened since then where it happened."""
        since, position = int(rivals.since[rivals.best]), tuple(rivals.positions[rivals.best].tolist())
        place = self._mapper.relive(since, position, step=self._steps)
        self._belief = certain_of(
            self.map, place, evidence, odds=float(rivals.odds[rivals.best]), instead_of=self.belief
        )
        self._window.clear()
        self._pending, self._retracted = 0, since
        self._rivals = rivals.kept(rivals.since < since)
        self._goal_places = {at: value for at, value in self._goal_places.items() if at in self.map.places}

    def _remember(self, evidence: Evidence) -> None:
        """Add the slice of this step to the window, with the tables as they are now."""
        message, options = self.belief.message, self.settings.filter
        self._window.append(
            take_slice(
                self.map,
                self._window[-1] if self._window else None,
                (message.places, message.positions, message.mass),
                self.belief.factors,
                step=self._steps,
                action=evidence.action,
                was_open=evidence.was_open,
                sight=evidence.sight,
                open_=evidence.open,
                slip=options.slip,
                displacement=(1.0 - options.displacement, options.displacement * self.belief.examined),
            )
        )

    def _learn(self, evidence: Evidence) -> None:
        if not self.certain:
            self._pending += 1
            return
        if self._pending:
            self._mapper.catch_up(list(self._window), self._pending, step=self._steps)
            self._pending = 0
        self._mapper.learn(self.belief, evidence, step=self._steps)

    def _choose(self, open_: tuple[bool, ...]) -> None:
        wishes = Wishes(self._goals, self._goal_places)
        self._plan = self._planned(open_, wishes, self._rng)
        self._choice = Choice(wishes, tuple(self._plan.policy.tolist()))

    def _last_choice(self) -> Choice:
        if self._choice is not None:
            return self._choice
        if self._steps:
            raise CogmapError("agent: the file has no last choice, an earlier version wrote it; call step(observation)")
        raise CogmapError("agent: it has planned nothing yet; call step(observation) first")

    def _planned(self, open_: tuple[bool, ...], wishes: Wishes, rng: np.random.Generator) -> Plan:
        settings = self.settings
        places, q = self.belief.message.by_place
        return self._planner.plan(
            self.map,
            places,
            q,
            open_=open_,
            look_ahead=settings.look_ahead,
            rng=rng,
            preferences=self._preferences(wishes),
            precision=settings.precision,
            discount=settings.discount,
            information_weight=settings.information_weight,
            starts=settings.starts,
            cache=self._cache,
        )

    def _preferences(self, wishes: Wishes) -> Preferences:
        weight = self.settings.goal_weight
        sights: dict[int, float] = {}
        for label, value in wishes.sights.items():
            known = self.map.sights.find(label)
            key = -1 if known is None else known
            sights[key] = max(sights.get(key, -np.inf), weight * value)
        places = {place: weight * value for place, value in wishes.places.items()}
        return Preferences(sights=sights, places=places, collision_cost=self.settings.collision_cost)

    def _record(self, label: Hashable, open_: tuple[bool, ...], cursor: int) -> None:
        belief, plan_ = self.belief, self.plan
        entries = self.map.changes.since(cursor)[0] or ()
        self.trace.append(
            StepRecord(
                step=self._steps,
                sight=label,
                open=open_,
                places=belief.places,
                certainty=belief.certainty,
                doubt=belief.doubt,
                certain=self.certain,
                moved=belief.moved,
                dropped=belief.dropped,
                evidence=belief.evidence,
                complexity=belief.complexity,
                accuracy=belief.accuracy,
                grown=tuple(entry for entry in entries if isinstance(entry, GrowthEvent)),
                learned=tuple(updates(entries)),
                policy=tuple(plan_.policy.tolist()),
                probability=float(plan_.probability[plan_.chosen]),
                G=plan_.expected_free_energy.row(plan_.chosen),
                terms=plan_.expected_free_energy.terms,
                policies=len(plan_.policies),
                action=plan_.action,
                retracted=self._retracted,
            )
        )


def _planner(settings: Settings) -> Planner:
    beam = settings.policies == MapGuided.name
    policies = MapGuided(beam=settings.beam) if beam else POLICIES[settings.policies]()
    return Planner(policies=policies, choice=CHOICES[settings.choice]())


def _generator(seed: Seed) -> np.random.Generator:
    try:
        return np.random.default_rng(seed)
    except (TypeError, ValueError) as error:
        raise CogmapError(f"agent: seed is {seed!r}; use a whole number of 0 or more, or None") from error
