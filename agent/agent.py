"""The loop that joins it all: perceive, plan, act."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from ..inference import Belief, advance, begin
from ..model import (
    NOTHING,
    Carried,
    CogmapError,
    Contexts,
    Growth,
    Locks,
    MotionSpec,
    Percept,
    Pose,
    Sensor,
    Sight,
    Ways,
    Whereabouts,
    take_slice,
)
from ..planning import Plan, Planner
from .filing import KEEP, Filed
from .following import Followed, follow
from .known_map import KnownMap
from .perceiving import checked, percept_of, unseen_ways
from .preferring import given_preferences, weighed
from .settings import Settings
from .starting import records_of_graph
from .state import Choice, GivenPreferences
from .trace import record_of
from .wiring import Seed

if TYPE_CHECKING:
    import networkx as nx


class Agent(Filed):
    """An agent that builds its own map.

    It is given observations only, what each of its sensors senses by name (`{"sight": label, "open": truth values
    over the actions}`), and answers with actions; it starts at what it calls the origin, and never learns where that
    is in the world.

    Args:
        motions: names and displacements of the actions: `world.motions`, or a mapping name -> displacement; may be left
            out where the map says them.
        sensors: what it senses; `Sight("sight")` and `Ways()` unless given, and where motions take things also
            `Carried` and `Locks`.
        pose: how places lie to each other; `Lattice()` unless given.
        growth: when places are added; `PredictedGrowth()` unless given.
        planner: how it plans: policies, terms of G, choice; `Planner()` unless given.
        settings: every number; see `Settings`.
        seed: of the generator that breaks ties and draws policies.
        map: what is known beforehand: a networkx graph of places, or a file of one (node-link JSON, GraphML, or YAML
            of ROS). Nodes have what each sensor senses there under its name, and maybe a `position`; edges say in `way`
            which action they are, or all are counted by bearing at each place. Ways that it does not have are shut.
            Places get numbers in its order; where in it the agent wakes up it finds out. A map in several contexts says
            so in its attribute `contexts`; see `Contexts`.
        keep: of so many last steps at least `trace` has every record and `map.growth` every event, of those before it
            what is still there; None of all of them, however many.

    Attributes:
        map: what it believes the world to be.
        growth: its growth rule.
        planner: its planner.
        rng: the generator.
        trace: one record a step that was answered; see `keep`.

    Raises:
        CogmapError: motions, parts or settings that make no sense.
    """

    def __init__(
        self,
        motions: MotionSpec | Mapping[str, Sequence[int]] | None = None,
        *,
        sensors: Iterable[Sensor] | None = None,
        pose: Pose | None = None,
        growth: Growth | None = None,
        planner: Planner | None = None,
        settings: Settings | None = None,
        seed: Seed = None,
        keep: int | None = KEEP,
        map: nx.Graph[Any] | str | PathLike[str] | None = None,
    ) -> None:
        known = None if map is None else KnownMap.of(map)
        if motions is None:
            if known is None:
                raise CogmapError("agent: it has no motions; give world.motions, or {name: displacement}")
            motions = known.motions
        if sensors is None and known is not None and known.contexts:
            sensors = [Sight(), Ways(), Contexts(known.contexts)]
        elif sensors is None and (takes := getattr(motions, "takes", ())):
            carried = (NOTHING, *dict.fromkeys(what for what in takes if what))
            sensors = [Sight(), Ways(), Carried(carried), Locks(carried)]
        self._assemble(motions, sensors, pose, growth, planner, settings or Settings(), seed)
        self.keep = keep
        if known is None:
            self.growth.begin(self.map, step=0)
        else:
            self._recognition.begin_with(records_of_graph(known, self.map, self._recognition.sensing))
            for facts, place in zip(known.nodes.values(), self._recognition.mirror.in_order, strict=True):
                for sensor in self.map.sensors.values():
                    sensor.know(place, facts.get(sensor.name))

    def prefer(
        self,
        sights: Mapping[Hashable, float] | None = None,
        *,
        places: Mapping[int, float] | None = None,
        sensors: Mapping[str, Mapping[Hashable, float]] | None = None,
    ) -> None:
        """Set log preferences over all others, in nats (before `goal_weight`); none explores.

        Args:
            sights: by label of the first sensor that sees labels. Labels never met are allowed: until they are,
                "something new" carries the hope.
            places: by number of the place in the map, such as `map.place_at(position)`.
            sensors: by name of a sensor and label: `{"smell": {"cheese": 4.0}}`.

        Raises:
            CogmapError: no mapping, a preference that is no finite number, or a place or a sensor that the map does not
                have.
        """
        self._state.preferences = given_preferences(sights, places, sensors, self.map)

    def follow(self, walk: Iterable[Mapping[str, Any]]) -> Iterator[Followed]:
        """Be taken along a walk that somebody recorded; see `following.follow`."""
        return follow(self, walk)

    def moved(self) -> None:
        """Be told that it was moved: the next observation is from anywhere, whatever action was answered last."""
        self._state.told = True

    # -- the loop ------------------------------------------------------------------------------------------

    def step(self, observation: Mapping[str, Any]) -> int:
        """Take in one observation and answer with the index of the next action: `perceive`, `plan` and `act` in a row.

        It is taken whole or not at all: whatever goes wrong in it, Ctrl-C too, the agent is as it was before.

        Raises:
            CogmapError: the observation lacks a key, or a value is none that its sensor could have sensed.
        """

        def step() -> int:
            self.perceive(observation)
            return self.act()

        return self._whole(step)

    def perceive(self, observation: Mapping[str, Any]) -> Belief:
        """Take in one observation: infer where it is, learn, and let the map grow; whole or not at all, as `step`.

        Where another action than the one answered led here, the observation says so: `taken`, by name or index.

        Raises:
            CogmapError: the observation lacks a key, a value is none that its sensor could have sensed, or nothing
                was done since the last one.
        """
        return self._whole(lambda: self._perceive(observation))

    _frame_turns = False

    def _perceive(self, observation: Mapping[str, Any]) -> Belief:
        state, values = self._state, checked(observation, self.map)
        if values.get("turn") and not self._frame_turns:
            raise CogmapError(
                f"observation: 'turn' is {values['turn']!r}, and the frame of this agent does not turn; leave it out, "
                "or make a TurningAgent"
            )
        wakes = not state.steps and self._recognition.followed is not None  # in a map that was given, somewhere
        if wakes or state.told:
            values["moved"] = True
        if wakes or not state.acted:
            if "taken" not in values and not values.get("moved"):
                raise CogmapError(
                    "agent: it has not acted on the last observation; call act(), or say what was 'taken'"
                )
            state.action = values.get("taken", self.map.motions.stay)
        state.told = False
        state.begun, state.revised = len(self.map.changes), False
        self.map.grow_time(step=state.steps)
        percept = percept_of(values, self.map, action=state.action, open_=state.open, step=state.steps)
        if self._recognising:
            self._recognition.take_in(percept, step=state.steps)
        self._infer(percept)
        self._teach(percept)
        state.expected = None
        state.spend(percept)
        state.percept, state.acted, state.choice, self._plan = percept, False, None, None
        everything = (True,) * len(self.map.motions)
        state.open = self._recognition.open(percept) if self._recognising else percept.passable or everything
        state.steps += 1
        return self.belief

    @property
    def plan(self) -> Plan:
        """What it considers, and what it chose; worked out when it is first asked for, and anew where it was loaded.

        Raises:
            CogmapError: it has perceived nothing yet.
        """
        return self._plan or self._whole(self._think)

    def _think(self) -> Plan:
        if self._plan is None:
            self._require_plan()
            choice = self._state.choice
            if choice is not None:
                self._plan = choice.of(self._planned(choice.preferences, np.random.default_rng(0)))
            elif self._state.acted:
                raise CogmapError(
                    "agent: the file has no last choice, an earlier version wrote it; call step(observation)"
                )
            else:
                self._plan = self._planned(self._state.preferences, self.rng)
                self._state.choice = Choice(self._state.preferences, tuple(self._plan.policy.tolist()))
        return self._plan

    def act(self) -> int:
        """Answer the last observation with the index of an action: the first of the plan's policy; as `step`.

        Raises:
            CogmapError: it has perceived nothing since the last action.
        """
        return self._whole(self._act)

    def _act(self) -> int:
        if self._state.acted:
            raise CogmapError("agent: it has perceived nothing since its last action; call perceive(observation) first")
        plan, state = self.plan, self._state
        percept, sensors = state.percept or Percept(), self.map.sensors
        sensed = {name: sensors[name].label(reading) for name, reading in percept.readings.items() if name != "open"}
        record = record_of(
            state.steps - 1,
            sensed,
            percept,
            self.belief,
            plan,
            self.map.changes.since(state.begun)[0] or (),
            certain=self.certain,
            revised=state.revised,
        )
        self.trace.append(record)
        state.action, state.acted = plan.action, True
        return plan.action

    # -- the parts of a step -------------------------------------------------------------------------------

    def _infer(self, percept: Percept) -> None:
        """Where it is, in the map as it is."""
        state = self._state
        message = self._recognition.start if state.belief is None else state.belief.message
        if message is None:
            state.belief = begin(self.map, 0, percept)
            return
        if percept.action is not None and percept.opened and state.belief is not None and self._located:
            self._mapper.enter(Whereabouts(state.belief.places), percept.action, step=state.steps)
            self._mapper.arrive(state.belief.place, percept, step=state.steps)
        belief = advance(self.map, message, percept, support=self.settings.filter.support)
        sure = belief.message.certainty >= self.settings.certainty
        state.belief = belief.committed() if sure and not self.map.visited[belief.place] else belief

    def _teach(self, percept: Percept) -> None:
        """Teach the map the step, or have it say what the most probable hypothesis says instead."""
        recognition, state, belief = self._recognition, self._state, self.belief
        self._mapper.fade()
        if not self._recognising:
            self._remember(percept)
            if self._located:
                doors = percept.open or (None,) * len(self.map.motions)
                self._mapper.learn(belief, percept, doors, step=state.steps)
            return
        if not recognition.choose(belief):
            self._revise(percept)
            return
        state.belief = recognition.weighed(belief, percept)
        if state.belief.message is not belief.message:
            state.window.clear()
        self._remember(percept)
        if recognition.lost:
            return
        if belief.message.certainty < self.settings.certainty:
            recognition.missed()
            return
        one_way = recognition.one_way
        self._mapper.learn(belief, percept, recognition.doors, step=state.steps, one_way=one_way)
        if not recognition.grown(belief.place):
            self._revise(percept)

    def _revise(self, percept: Percept) -> None:
        """The map becomes what the most probable hypothesis says; the window begins anew."""
        state, recognition = self._state, self._recognition
        moved = recognition.follow(step=state.steps)
        if moved is not None:
            places = {moved[at]: value for at, value in state.preferences.places.items() if at in moved}
            state.preferences = replace(state.preferences, places=places)
        state.revised = moved is not None or self.belief.place != recognition.place
        here, belief = recognition.place, self.belief
        state.belief = recognition.believed(percept, here) if state.revised else recognition.weighed(belief, percept)
        state.window.clear()
        self._remember(percept)

    def _remember(self, percept: Percept) -> None:
        """Add the slice of this step to the window, with the factors as they are now."""
        belief, window = self.belief, self._state.window
        message = belief.message
        window.append(
            take_slice(
                self.map,
                window[-1] if window else None,
                (message.places, message.positions, message.mass),
                belief.likelihoods,
                step=self._state.steps,
                percept=percept,
                examined=belief.examined,
                ahead=belief.ahead,
            )
        )

    @property
    def _located(self) -> bool:
        """Whether one place holds enough of the belief, if the map is right."""
        return self.belief.message.certainty >= self.settings.certainty

    def _planned(self, preferences: GivenPreferences, rng: np.random.Generator) -> Plan:
        settings = self.settings
        places, q = self.belief.message.by_place
        return self.planner.plan(
            self.map,
            places,
            q,
            open_=self._state.open or (True,) * len(self.map.motions),
            look_ahead=settings.look_ahead,
            rng=rng,
            preferences=weighed(preferences, self.map, settings),
            precision=settings.precision,
            discount=settings.discount,
            information_weight=settings.information_weight,
            starts=settings.starts,
            cache=self._cache,
            costs=self._state.expected_costs(len(self.map.motions), stay=self.map.motions.stay),
            structure=None if preferences else self._recognition.question,  # what is preferred comes first
            unseen=unseen_ways(self._state.percept, self.map.motions),
            prices=self._state.prices(),
        )
