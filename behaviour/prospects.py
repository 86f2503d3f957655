"""What an agent that follows a walk expects beyond each way: its policies, step by step, computed once a walk."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..agent import Agent, Settings
from ..planning import LocalModel, MapGuided, Planner, Policies, Rollout, Step, Term, evaluate
from .ground import LEAST_WAYS, Ground, Way
from .routes import Route

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]
Position = tuple[float, ...]
LOOK_AHEAD = 6
"""Steps of a policy that are judged, unless told otherwise."""
HALF = 0.5  # belief below which an agent does not know where it is
OLDEST = 60_000  # steps; what is older counts as that old
SIZE = 100_000  # numbers in the larger arrays of an evaluation; more policies are evaluated in parts


@dataclass(frozen=True, eq=False)
class Prospects:
    """The policies that an agent considered at each choice of a walk, those that begin with an open way.

    What a step of a policy gains is the agent's own -G of that step. Where the step leads to a place that it knows,
    forgetting would add to it: in full, it would gain there what a place never seen gains. So with forgetting φ the
    step gains `gain + extra (1 - (1 - φ)^age)`.
    """

    choice: Ints  # `[N]` which choice each policy belongs to, ascending
    way: Ints  # `[N]` the way that it begins with, ascending within a choice
    gain: Floats  # `[N, L]` nats that each step gains
    # `[N, L]` nats that forgetting could add; zero in places never entered or entered earlier in the policy
    extra: Floats
    age: NDArray[np.uint16]  # `[N, L]` steps since the place was last entered

    @classmethod
    def joined(cls, parts: Sequence[Prospects]) -> Prospects:
        """Those of one choice each, numbered in order."""
        number = np.repeat(np.arange(len(parts)), [len(part.way) for part in parts]).astype(np.int32)
        columns = ("way", "gain", "extra", "age")
        return cls(number, *(np.concatenate([getattr(part, name) for part in parts]) for name in columns))


@dataclass(frozen=True, eq=False)
class Followings:
    """The results of following a recorded walk."""

    prospects: Prospects  # of its choices
    astray: int  # steps at which the agent believed to be elsewhere than it was
    entered: int  # places that it has as entered at the end
    nodes: int  # places that were entered


def new_agent(ground: Ground, *, look_ahead: int = LOOK_AHEAD, seed: int = 0) -> Agent:
    """The agent that is led along walks: the paper's model, policies grown on the map, by all that they may teach."""
    planner = Planner(policies=MapGuided(), explorer=None)
    return Agent(dict(ground.motions), planner=planner, settings=Settings(look_ahead=look_ahead), seed=seed)


def follow_route(
    route: Route, ground: Ground, *, look_ahead: int = LOOK_AHEAD, on_step: Callable[[], None] = lambda: None
) -> Followings:
    """Lead a new agent along a walk, and keep what it expected at each choice.

    Args:
        route: the walk.
        ground: of its world.
        look_ahead: steps that the agent looks ahead.
        on_step: called after each step.

    Raises:
        CogmapError: the agent refuses what is sensed.
    """
    agent, places = new_agent(ground, look_ahead=look_ahead), route.places.tolist()
    foresight, parts, known = Foresight(agent, ground), list[Prospects](), dict[int, Position]()
    astray = 0
    for i, observation in enumerate(ground.observations(places)):
        at, ahead = places[i], places[i + 1] if i + 1 < len(places) else -1
        believed = foresight.arrive(observation)
        astray += known.setdefault(at, believed) != believed or agent.belief.certainty < HALF
        ways = ground.ways[at]
        if len(ways) >= LEAST_WAYS and any(way.target == ahead for way in ways):
            parts.append(foresight.look(ways))
        on_step()
    distinct = len(set(known.values()))
    entered = int(np.count_nonzero(agent.map.visited)) if distinct == len(known) else distinct
    return Followings(Prospects.joined(parts), astray, entered, len(known))


class Foresight:
    """Leads an agent along a walk step by step, and records what it expects beyond each way.

    It plans only where it is asked, so this is quicker than `cogmap.agent.follow`, and comes to the same.

    Args:
        agent: the agent.
        ground: of the world.
    """

    def __init__(self, agent: Agent, ground: Ground) -> None:
        self._agent = agent
        self._names = {name: i for i, name in enumerate(agent.map.motions.names)}
        self._terms, self._length = tuple(agent.planner.terms), agent.settings.look_ahead
        self._stay = agent.map.motions.stay
        self._last: dict[Position, int] = {}  # the step at which each place was last believed to be entered
        self._new = 0.0  # nats that a place never seen gains

    def arrive(self, observation: Mapping[str, Any]) -> Position:
        """Let the agent perceive the next step of the walk; answers with where in its map it believes to be.

        Places go by their position: their numbers change where another hypothesis about the map becomes the best one.

        Raises:
            CogmapError: what `Agent.perceive` raises.
        """
        position = tuple(self._agent.map.position(self._agent.perceive(observation).place) or ())
        self._last[position] = self._agent.steps
        return position

    def look(self, ways: Iterable[Way]) -> Prospects:
        """What it expects beyond these ways; call `arrive` first."""
        plan = self._agent.plan
        model, at = plan.model, {self._names[way.action]: i for i, way in enumerate(ways)}
        actions = plan.policies[:, : self._length]
        first = actions[:, 0]
        missing = [action for action in at if action not in first]  # a policy that takes it, and stays
        added = np.full((len(missing), actions.shape[1]), self._stay)
        added[:, 0] = missing
        actions = np.concatenate([actions[np.isin(first, list(at))], added])
        actions = np.unique(actions, axis=0)  # what differs only beyond the look-ahead is one policy
        way = np.array([at[action] for action in actions[:, 0].tolist()], dtype=np.int32)
        order = np.argsort(way, kind="stable")
        actions, way = actions[order], way[order]
        gain = _gains(model, actions, self._terms)
        if not model.entered.all():
            self._new = float(sum(table[~model.entered, 1].mean() for table in model.information.values()))
        extra, age = self._forgotten(model, actions, gain)
        return Prospects(np.zeros(len(way), dtype=np.int32), way, _narrow(gain), _narrow(extra), age)

    def _forgotten(
        self, model: LocalModel, actions: NDArray[np.int64], gain: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.uint16]]:
        """What forgetting could add to each step, and the age of what is known there."""
        last = np.array([self._last.get(tuple(at), -1) for at in model.position.tolist()] + [-1])
        at = np.full(len(actions), int(model.belief.argmax()))
        length = actions.shape[1]
        path = np.empty((len(actions), length), dtype=np.int64)
        for t in range(length):
            moved = model.successor[at, actions[:, t]]
            at = np.where((at < 0) | (actions[:, t] == self._stay), at, moved)
            path[:, t] = at
        before = path[:, :, None] == path[:, None, :]
        again = (before & np.tri(length, k=-1, dtype=np.bool_)).any(axis=2) | (path == model.belief.argmax())
        known = (last[path] >= 0) & ~again
        age = np.where(known, self._agent.steps + 1 + np.arange(length) - last[path], 0)
        return np.where(known, np.maximum(self._new - gain, 0.0), 0.0), np.minimum(age, OLDEST).astype(np.uint16)


def _gains(model: LocalModel, actions: NDArray[np.int64], terms: Sequence[Term]) -> NDArray[np.float64]:
    """`[N, L]` -G of each step by itself."""
    size = max(1, SIZE // (len(model.belief) * actions.shape[1]))
    parts: list[NDArray[np.float64]] = []
    for begin in range(0, len(actions), size):
        policies, steps = Policies(actions[begin : begin + size]), _Steps(terms, model.information_weight)
        evaluate(model, policies, [steps])
        parts.append(steps.found[policies.prefixes.of])
    return np.concatenate(parts)


class _Steps(Term):
    """Takes down what the last step of each prefix gains, all terms together."""

    name, kind, sign = "steps", "preference", 1.0

    def __init__(self, terms: Sequence[Term], information_weight: float) -> None:
        self._terms, self._weight = terms, information_weight
        self.found = np.zeros(0)

    def gain(self, rollout: Rollout) -> NDArray[np.float64]:
        weights = [-term.sign * (self._weight if term.kind == "information" else 1.0) for term in self._terms]
        gains = [weight * term.gain(rollout) for weight, term in zip(weights, self._terms, strict=True)]
        self.found = np.sum(gains, axis=0)
        return self.found.copy()

    def plain(self, step: Step) -> float:
        raise NotImplementedError  # never evaluated line by line


def _narrow(values: NDArray[np.float64]) -> Floats:
    return values.astype(np.float32)
