"""An agent in a world whose truth is known: set out, exploring, moved without a word."""

from collections.abc import Callable, Collection, Mapping
from concurrent.futures import Executor
from contextlib import suppress
from copy import deepcopy
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Required, TypedDict, TypeVar, Unpack

import gymnasium as gym
import numpy as np

from ..agent import Settings
from ..model import CogmapError
from ..worlds import CanDisplace, Chart, HasChart, ListedWays, Place, WorldError, offered, place_of, world_of
from ..worlds import World as OfMotions
from .judging import Trail
from .knowledge import Knowledge, Truth
from .parts import Maker, Parts
from .pool import map_seeds
from .running import Run, Seen, Watch, run

_Row = TypeVar("_Row")
World = Chart | gym.Env[Any, Any]
"""Where experiments take place: a chart, such as a maze, or an environment that has one; it is left as it is."""


class Options(TypedDict, total=False):
    """Who explores, and for how long.

    Attributes:
        agent: a name in `AGENTS`, or what makes agents: see `Parts`; `cogmap` unless given.
        settings: of the agent `cogmap` given by name.
        max_steps: moves after which to give up exploring, and again what follows; `default_steps(world)` unless given.
        steps: moves that an exploration takes, whatever is known by then; unless given, it ends when all is known.
    """

    agent: str | Maker
    settings: Settings | None
    max_steps: int | None
    steps: int | None


class Many(Options, total=False):
    """The same of `runs` runs, the first with `seed`; `executor` and `on_done` as for `map_tasks`."""

    runs: Required[int]
    seed: int
    executor: Executor | None
    on_done: Callable[[], None] | None


@dataclass(slots=True)
class Session:
    """An agent in its own copy of a world."""

    world: Any  # where it is
    agent: Any  # before its first step, or after its last observation; the action it then chose has been carried out
    start: Place  # the place where it began, which it takes as its origin
    rng: np.random.Generator  # draws what happens to it later
    most: int  # moves after which it gives up
    seed: int  # of the world
    fixed: int | None = None  # moves that it takes exploring, if that is settled
    # in which it explored the world; None where it has not, or gave up
    steps: int | None = field(init=False, default=None)
    truth: Truth = field(init=False)  # to compare its map with
    trail: Trail = field(init=False, default_factory=Trail)  # where it was while it explored
    _seen: Seen = field(init=False)

    def __post_init__(self) -> None:
        self._seen = self.world.reset(seed=self.seed, options={"start": self.start})
        self.truth = Truth(chart_of(self.world), self.start)

    @property
    def place(self) -> Place:
        """Where it truly is."""
        return getattr(self.world.unwrapped, "place", place_of(self._seen[1]))

    @property
    def true_place(self) -> int | None:
        """The place of the agent's map that stands for the one it is in."""
        return self.truth.place(self.agent.map, self.place)

    def run(self, steps: int, watch: Watch | None = None) -> Run:
        """Go on from where it is, for `steps` observations at most; see `cogmap.experiments.run`."""
        with suppress(WorldError):  # what was opened, closed or moved in the meantime shows
            self._seen = offered(self.world, CanDisplace, "this").observe(), {"place": self.place}
        done = run(self.world, self.agent, steps=steps, begin=self._seen, watch=watch)
        self._seen = done.end
        return done

    def explore(self, watch: Watch | None = None) -> tuple[Run, Knowledge]:
        """Go on until all is known, for `most` moves at most; or for `fixed` moves, whatever is known by then."""
        knowledge = Knowledge(self.truth, self.trail, watch, on=self.fixed is not None)
        done = self.run((self.fixed or self.most) + 1, knowledge)
        self.steps = knowledge.complete
        return done, knowledge

    def displace(self, *, elsewhere: bool, but: Collection[Place] = ()) -> Place:
        """Move it to a random place without a word, but for `but`, `elsewhere` to another; answers with the place."""
        here = self.place if elsewhere else None
        places = [place for place in self.truth.number if place not in but and place != here]
        place = places[int(self.rng.integers(len(places)))]
        self._seen = offered(self.world, CanDisplace, "moving an agent").displace(place), {"place": place}
        return place


def set_out(experiment: str, world: World, seed: int, **options: Unpack[Options]) -> Session:
    """A new agent at the start that belongs to a seed, in its own copy of the world.

    Raises:
        CogmapError: no agent has this name, a negative seed, or `max_steps` below 1.
        WorldError: a world without a chart.
    """
    chart, maker, most = described(experiment, world, **options)
    start, for_agent, rng = draw_start(experiment, world, seed)
    for_world = np.random.SeedSequence(seed).spawn(4)[3].generate_state(1)[0]  # `draw_start` uses the first three
    own: Any = world_of(chart) if world is chart else deepcopy(world, {id(chart): chart})  # a chart never changes
    if isinstance(maker, Parts) and offered(own, OfMotions, experiment).motions.local:
        own = ListedWays(own)
    return Session(own, maker.make(own, for_agent), start, rng, most, int(for_world), options.get("steps"))


def explored(experiment: str, world: World, seed: int, **options: Unpack[Options]) -> Session:
    """An agent that has explored the world, as `explore` with the same seed does. Raises what `set_out` raises."""
    session = set_out(experiment, world, seed, **options)
    session.explore()
    return session


def described(experiment: str, world: World, **options: Unpack[Options]) -> tuple[Chart, Maker, int]:
    """The chart, what makes the agents, and the moves after which they give up; raises what `set_out` does."""
    agent, settings, most = options.get("agent", "cogmap"), options.get("settings"), options.get("max_steps")
    if settings is not None and not isinstance(agent, str):
        raise CogmapError(f"agent {agent.agent} has settings of its own; leave the argument settings out")
    most = default_steps(world) if most is None else most
    for name, moves in (("max_steps", most), ("steps", options.get("steps"))):
        if moves is not None and moves < 1:
            raise CogmapError(f"{experiment}: {name} is {moves}; use 1 or more")
    return chart_of(world), Parts(agent, settings or Settings()) if isinstance(agent, str) else agent, most


def head_of(experiment: str, world: World, **options: Unpack[Options]) -> tuple[dict[str, Any], dict[str, Any]]:
    """What stands at the head of results: the world, its noise if it has any, the agent; and its settings."""
    chart, maker, _ = described(experiment, world, **options)
    noise: dict[str, float] = getattr(world, "noise", {})
    head = {"world": chart.name, **({"noise": noise} if noise else {}), "agent": maker.agent}
    return head, {"settings": maker.to_dict(chart)}


def many(experiment: Callable[..., _Row], world: World | str, options: Mapping[str, Any]) -> list[_Row]:
    """Rows of an experiment in a world; `options` are `Many`, and others of the experiment."""
    how = {name: value for name, value in options.items() if name in ("runs", "seed", "executor", "on_done")}
    own = {name: value for name, value in options.items() if name not in how}
    return map_seeds(partial(experiment, world, **own), **how)


def chart_of(world: World) -> Chart:
    """The true map of a world, or a `WorldError` that says what there is without one."""
    if isinstance(world, Chart):
        return world
    try:
        return offered(world, HasChart, "this experiment").chart
    except WorldError as error:
        raise WorldError(f"{error}; without a chart there is cogmap.experiments.run(world, agent, steps=…)") from error


def default_steps(world: World) -> int:
    """The number of moves after which an exploration counts as failed, unless one is given."""
    return 50 * len(chart_of(world).places) + 50


def draw_start(experiment: str, world: World, seed: int) -> tuple[Place, np.random.SeedSequence, np.random.Generator]:
    """What a seed determines: the start, the random stream of the agent, and later random events.

    Raises:
        CogmapError: a negative seed.
    """
    if seed < 0:
        raise CogmapError(f"{experiment}: seed is {seed}; use 0 or more")
    for_start, for_agent, later = np.random.SeedSequence(seed).spawn(3)
    places = chart_of(world).places
    return places[int(np.random.default_rng(for_start).integers(len(places)))], for_agent, np.random.default_rng(later)
