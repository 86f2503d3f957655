"""The loop that joins it all: perceive, plan, act."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..inference import Belief, RateOf, advance, begin
from ..model import (
    STEPS,
    CogmapError,
    CognitiveMap,
    FactorGraph,
    Growth,
    Motions,
    MotionSpec,
    Percept,
    Pose,
    PredictedGrowth,
    Sensor,
    Slice,
    Whereabouts,
    map_state,
    release,
    restore_map,
    safe,
    take_slice,
    updates,
    window_graph,
)
from ..planning import LocalCache, Plan, Planner
from . import storage
from .expecting import expected_at
from .following import Followed, follow
from .hypotheses import MapHypothesis
from .known_map import KnownMap
from .mapper import Mapper
from .packing import Arrays, pack, unpacked_state
from .parts import made_of, parts_of
from .perceiving import checked, percept_of, unseen_ways
from .preferring import given_preferences, weighed
from .recognition import Recognition
from .settings import Settings
from .starting import records_of_graph
from .state import Choice, GivenPreferences, State
from .trace import StepRecord, record_of
from .wholeness import IN_STEP, Before, before_step, undo_step

if TYPE_CHECKING:
    import networkx as nx

T = TypeVar("T")

Seed = int | np.random.SeedSequence | None

KEEP = 10_000
"""Steps of which the trace and the log of growth keep everything, unless told otherwise."""


class Agent:
    """An agent that builds its own map.

    It is given observations only, what each of its sensors senses by name (`{"sight": label, "open": truth values
    over the actions}`), and answers with actions; it starts at what it calls the origin, and never learns where that
    is in the world.

    Args:
        motions: names and displacements of the actions: `world.motions`, or a mapping name -> displacement; may be left
            out where the map says them.
        sensors: what it senses; `Sight("sight")` and `Ways()` unless given.
        pose: how places lie to each other; `Lattice()` unless given.
        growth: when places are added; `PredictedGrowth()` unless given.
        planner: how it plans: policies, terms of G, choice; `Planner()` unless given.
        settings: every number; see `Settings`.
        seed: of the generator that breaks ties and draws policies.
        map: what is known beforehand: a networkx graph of places, or a file of one (node-link JSON or GraphML). Nodes
            have what each sensor senses there under its name, and maybe a `position`; edges say in `way` which action
            they are. Ways that it does not have are shut. Places get numbers in its order; where in it the agent wakes
            up it finds out.
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
        self._assemble(motions, sensors, pose, growth, planner, settings or Settings(), seed)
        self.keep = keep
        if known is None:
            self.growth.begin(self.map, step=0)
        else:
            self._recognition.begin_with(records_of_graph(known, self.map, self._recognition.sensing))

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
        given = [("a sensor", sensor, Sensor) for sensor in sensors or ()]
        parts: list[tuple[str, object, type]] = [
            *given,
            ("pose", pose, Pose),
            ("growth", growth, Growth),
            ("planner", planner, Planner),
            ("settings", settings, Settings),
        ]
        for name, part, kind in parts:
            if part is not None and not isinstance(part, kind):
                raise CogmapError(f"agent: {name} is {part!r}; give an object, such as growth=PredictedGrowth()")
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
        self._mapper = Mapper(self.map, self.growth, self._recognition.mirror.ways, settings)
        self._cache = LocalCache(self.map, settings.look_ahead)
        self._plan: Plan | None = None
        self._torn: str | None = None
        self.planner.check(self.map.motions, settings.look_ahead)
        self._state = State(deque[Slice](maxlen=settings.window + 1))

    # -- the public face -----------------------------------------------------------------------------------

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
        whole = isinstance(steps, int | np.integer) and not isinstance(steps, bool)
        if steps is not None and not (whole and steps >= STEPS):
            raise CogmapError(f"agent: keep is {steps!r}; give a whole number of {STEPS} steps or more, or None")
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

    def _perceive(self, observation: Mapping[str, Any]) -> Belief:
        state, values = self._state, checked(observation, self.map)
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
            self._recognition.take_in(percept)
        self._infer(percept)
        self._teach(percept)
        state.expected = None
        state.spend(percept)
        state.percept, state.acted, state.choice, self._plan = percept, False, None, None
        state.open = self._recognition.open(percept)
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
        if self._keep is not None and len(self.trace) >= 2 * self._keep:
            del self.trace[: -self._keep]
        state.action, state.acted = plan.action, True
        return plan.action

    @property
    def parts(self) -> dict[str, Any]:
        """What it is made of, as plain JSON values: the kind of each part and its options."""
        return parts_of(self.map, self.growth, self.planner)

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything the agent knows to an npz file (JSON header, schema version, no pickle).

        Raises:
            CogmapError: a label or a setting cannot be written, or the folder cannot be.
        """
        storage.write(path, *self.state())

    def _check_whole(self) -> None:
        if self._torn is not None:
            raise CogmapError(f"agent: it is torn, {self._torn}; load it from a file, or make another")

    def _whole(self, work: Callable[[], T]) -> T:
        """Do it, or leave everything as it was; what is done within it is part of it."""
        if self._torn is IN_STEP:
            return work()
        self._check_whole()
        map_, state = self.map, self._state
        before = before_step(map_, self._recognition, state, self._plan, self.rng, len(self.trace))
        try:
            self._torn = IN_STEP
            result = work()
            self._torn = None
            release(map_)
            return result
        except BaseException as error:
            if self._torn is not None:
                self._go_back(before, error)
            raise

    def _go_back(self, before: Before, error: BaseException) -> None:
        """As it was before; a second interrupt in the middle is waited out."""
        self._torn = f"left in the middle of a step by a {type(error).__name__}"
        for _ in range(3):
            try:
                undo_step(before, self.map, self._recognition)
                self._state, self._plan, self.rng = before.state, before.plan, before.rng
                self._cache = LocalCache(self.map, self.settings.look_ahead)
                del self.trace[before.records :]
                self._torn = None
                return
            except CogmapError as why:
                self._torn = f"{self._torn}, and cannot go back ({why})"
                return
            except KeyboardInterrupt:  # it is raised in the end
                continue

    @classmethod
    def load(
        cls,
        path: str | PathLike[str],
        *,
        sensors: Iterable[Sensor] | None = None,
        pose: Pose | None = None,
        growth: Growth | None = None,
        planner: Planner | None = None,
        settings: Settings | None = None,
    ) -> Agent:
        """The agent that `save` wrote; it walks on exactly as that one would have.

        Args:
            path: of the file.
            sensors: new ones like those that it was made with, where some are not of this library.
            pose, growth, planner: the same.
            settings: others than those that it was saved with, to go by from now on.

        Raises:
            CogmapError: no such file, or it is no saved map, truncated, or from a newer schema.
        """
        if not isinstance(settings, Settings | None):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise CogmapError(f"load: settings is {settings!r}; give Settings(...), or none for those in the file")
        with storage.reading(path) as (header, arrays):
            return cls.from_state(
                header, arrays, sensors=sensors, pose=pose, growth=growth, planner=planner, settings=settings
            )

    def state(self) -> tuple[dict[str, Any], Arrays]:
        """Everything that the next steps depend on: a JSON header and arrays (the trace is left out).

        Raises:
            CogmapError: the agent is torn, or a label cannot be written.
        """
        self._check_whole()
        _ = self.steps and self.expected  # the log of changes, which tells it, is not saved
        map_, arrays = map_state(self.map)
        header = {
            "motions": _told(self.map.motions),
            "settings": self.settings.to_dict(),
            "parts": self.parts,
            "rng": self.rng.bit_generator.state,
            "map": map_,
            "state": pack(self._state, arrays, "state"),
        }
        if self._recognising:
            header["recognition"] = self._recognition.state(arrays)
        return header, arrays

    @classmethod
    def from_state(
        cls,
        header: Mapping[str, Any],
        arrays: Mapping[str, NDArray[Any]],
        *,
        sensors: Iterable[Sensor] | None = None,
        pose: Pose | None = None,
        growth: Growth | None = None,
        planner: Planner | None = None,
        settings: Settings | None = None,
    ) -> Agent:
        """The agent that `state` took apart; see `load`."""
        agent = cls.__new__(cls)
        made = made_of(header["parts"], sensors=sensors, pose=pose, growth=growth, planner=planner)
        motions = _motions(header["motions"])
        saved = Settings.from_dict(header["settings"])
        agent._assemble(motions, *made, settings or saved, None)
        agent.keep = KEEP
        restore_map(agent.map, header["map"], arrays)
        agent.rng.bit_generator.state = header["rng"]
        agent._state = unpacked_state(header["state"], arrays, agent.map, agent.settings.window)
        recognition = agent._recognition
        if "recognition" in header:
            recognition.restore(header["recognition"], arrays)
        if not agent._recognising:
            recognition.forget()
        elif recognition.followed is None and agent._state.belief is not None:
            recognition.know(agent._state.belief.place, step=agent._state.steps)
        return agent

    def _repr_html_(self) -> str:
        """Its map, and where it believes to be."""
        belief = (
            f"<p>after {self.steps} steps: {safe(self.belief)}</p>" if self.steps else "<p>it has seen nothing yet</p>"
        )
        return f"<div>{belief}{self.map._repr_html_()}</div>"  # pyright: ignore[reportPrivateUsage]

    def __repr__(self) -> str:
        return f"Agent({self.map!r}, step {self.steps})"

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
        state.belief = recognition.weighed(belief)
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
        state.belief = recognition.believed(percept) if state.revised else recognition.weighed(self.belief)
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

    def _require_plan(self) -> None:
        if not self._state.steps:
            raise CogmapError("agent: it has planned nothing yet; call step(observation) first")

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
        )


def _generator(seed: Seed) -> np.random.Generator:
    try:
        return np.random.default_rng(seed)
    except (TypeError, ValueError) as error:
        raise CogmapError(f"agent: seed is {seed!r}; use a whole number of 0 or more, or None") from error


def _told(motions: Motions) -> dict[str, Any]:
    """Actions as plain JSON values; where they have no displacements, who undoes whom is said instead."""
    reverse = {} if motions.placed else {"reverse": motions.inverse}
    return {"names": motions.names, "displacements": motions.displacements, **reverse}


def _motions(told: Mapping[str, Any]) -> Motions:
    if "reverse" in told:
        return Motions(tuple(told["names"]), (), tuple(told["reverse"]))
    return Motions.of(dict(zip(told["names"], told["displacements"], strict=True)))
