"""Names to parts: the one place where agents are made by name, for the command line, ledgers and sweeps."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, Self

import numpy as np

from ..agent import Agent, Settings, TurningAgent
from ..baselines import ChartFrontier, CscgAgent, CscgSettings, FrontierAgent, RandomAgent
from ..model import GROWTHS, POSES, Bearings, CogmapError, Plane, Pose, Sensor, Sight, StaticGrowth, Ways
from ..planning import BY, CHOICES, POLICIES, LShaped, MapGuided, Planner, Sampled
from ..worlds import Chart, HasChart, Motions, World, offered

CSCG = {
    "cscg": (False, "viterbi"),
    "cscg_pose": (True, "viterbi"),
    "cscg_random": (False, "random"),
    "cscg_pose_random": (True, "random"),
}
"""The four variants of the paper: whether it is given its position, and how it moves."""

_FIRST = ("look_ahead", "policies", "beam", "starts", "precision", "choice", "growth", "places")  # in files

PRESETS: dict[str, tuple[Callable[..., Settings], dict[str, Any]]] = {
    "cogmap": (Settings, {}),
    "paper": (Settings.paper, {"policies": LShaped.name, "choice": Sampled.name}),
}
"""Agents that are made as one: settings, and the names of parts that differ from the default."""

AGENTS = ("cogmap", "frontier", "random", *CSCG)


class Maker(Protocol):
    """Makes the agents of a sweep, each with its own seed. It must be picklable to run in other processes."""

    @property
    def agent(self) -> str:
        """What the agents are called in results."""
        ...

    def make(self, world: Any, seed: np.random.SeedSequence, /) -> Any:
        """A new agent for this world, with `step`, and for navigating with `prefer`."""
        ...

    def to_dict(self, chart: Chart, /) -> dict[str, Any]:
        """What agents in the world of this chart are made with, as plain JSON values."""
        ...


@dataclass(frozen=True, slots=True)
class Parts:
    """The parts of an agent, by name.

    Raises:
        CogmapError: no agent, or no part, has this name.
    """

    agent: str = "cogmap"  # one of `AGENTS`
    settings: Settings = field(default_factory=Settings)  # of `cogmap`
    growth: str = "predicted"  # one of `GROWTHS`; static growth is told how many places the world has
    policies: str = "map_guided"  # one of `POLICIES`
    choice: str = "outward"  # one of `CHOICES`
    # one of `POSES`; a lattice unless given, and none in worlds whose actions have no displacements
    pose: str | None = None
    cost: str = "steps"  # what exploring is to take little of, "steps" or "metres"
    cscg: CscgSettings = field(default_factory=CscgSettings)  # of the clone-structured graphs

    def __post_init__(self) -> None:
        if self.agent not in AGENTS:
            raise CogmapError(f"no agent is called {self.agent!r}; choose one of {', '.join(AGENTS)}")
        if self.pose == "turning":
            raise CogmapError(
                "settings: pose is 'turning', but the moves of this world are told as they are, however the agent is "
                "turned; use --pose lattice, or a body that may be turned: minigrid:MAZE with --turned"
            )
        for name, known in (
            ("growth", GROWTHS),
            ("policies", POLICIES),
            ("choice", CHOICES),
            ("pose", POSES),
            ("cost", BY),
        ):
            if (value := getattr(self, name)) is not None and value not in known:
                raise CogmapError(f"settings: {name} is {value!r}; choose one of {', '.join(known)}")

    @classmethod
    def named(cls, agent: str = "cogmap", *, preset: str = "cogmap", **options: Any) -> Self:
        """From the options of the command line: names of parts, look_ahead, engine; what is None is the preset's.

        Raises:
            CogmapError: no preset has this name, and as for the parts.
        """
        if preset not in PRESETS:
            raise CogmapError(f"no preset is called {preset!r}; choose one of {', '.join(PRESETS)}")
        make, parts = PRESETS[preset]
        given = {name: value for name, value in options.items() if value is not None}
        numbers = {name: given.pop(name) for name in ("look_ahead", "engine") if name in given}
        return cls(agent, make(**numbers), **{**parts, **given})

    def growing(self, growth: str) -> Self:
        """The same with another growth."""
        return replace(self, growth=growth)

    def make(self, world: Any, seed: np.random.SeedSequence) -> Any:
        """A new agent that knows of the world only what its kind must be told.

        Args:
            world: gives the motions; the number of places to static growth; and the number of sights (or places, if it
                is given positions) to a clone-structured graph.
            seed: of the agent.

        Raises:
            CogmapError: a pose that this world has not, metres where it tells none, or a baseline that needs
                displacements.
            WorldError: no motions, or no chart.
        """
        motions = offered(world, World, "an agent").motions
        chart = offered(world, HasChart, f"agent {self.agent}").chart
        if self.agent == "cogmap":
            growth = StaticGrowth(len(chart.places)) if self.growth == StaticGrowth.name else GROWTHS[self.growth]()
            planner = Planner(policies=POLICIES[self.policies](), choice=CHOICES[self.choice]())
            if planner.explorer is not None:
                planner = replace(planner, explorer=replace(planner.explorer, by=self.cost))
            number, pose = int(seed.generate_state(1)[0]), self._pose(world, motions)
            if self.cost == "metres" and not isinstance(pose, Plane):
                raise CogmapError(
                    "cost metres needs a graph that tells how long its ways are; here every way is one step: "
                    "leave --cost out"
                )
            own: Any = {"sensors": _sensors(world), "pose": pose, "growth": growth, "planner": planner}
            kind = TurningAgent if getattr(world.unwrapped, "turned", False) else Agent
            return kind(motions, **own, settings=self.settings, seed=number)
        if self.agent in CSCG:
            positions, how = CSCG[self.agent]
            seen = len(chart.places if positions else set(chart.sights.values()))
            told: dict[str, Any] = {"observations": seen, "positions": positions, "navigation": how}
            return CscgAgent(motions, settings=self.cscg, seed=seed, **told)
        if self.agent == "frontier" and not motions.displacements:
            return ChartFrontier(chart, seed=seed)
        if not motions.displacements:
            raise CogmapError(f"agent {self.agent} reckons where it is, and these actions have no displacements")
        return {"frontier": FrontierAgent, "random": RandomAgent}[self.agent](motions, seed=seed)

    def _pose(self, world: Any, motions: Motions) -> Pose | None:
        """The pose that was asked for; a lattice where actions have displacements, a plane where moves or ways do."""
        measured = not motions.displacements and bool({"displacement", "bearings"} & {*_observed(world)})
        if self.pose == "plane" and not measured:
            raise CogmapError("pose plane needs a world that tells displacements or bearings; use --pose none")
        if self.pose == "lattice" and not motions.displacements:
            raise CogmapError(
                "pose lattice needs actions with displacements; declare graph.motions, or use --pose none"
            )
        name = self.pose or (None if motions.displacements else "plane" if measured else "none")
        return None if name is None else POSES[name]()

    def to_dict(self, chart: Chart | None = None) -> dict[str, Any]:
        """What the agent goes by, as plain JSON values; nothing for a baseline that has no settings."""
        if self.agent != "cogmap":
            return self.cscg.to_dict() if self.agent in CSCG else {}
        places = len(chart.places) if chart is not None and self.growth == StaticGrowth.name else None
        cost = {} if self.cost == "steps" else {"cost": self.cost}
        names = {"policies": self.policies, "beam": MapGuided().beam, "choice": self.choice, "growth": self.growth}
        pose = {} if self.pose is None else {"pose": self.pose}
        values = {**self.settings.to_dict(), **names, **pose, **cost, "places": places}
        return {name: values[name] for name in dict.fromkeys((*_FIRST, *values))}


def _sensors(world: Any) -> list[Sensor] | None:
    """A sensor for each that the world has; None where these are the usual two."""
    names = [name for name in _observed(world) if name not in ("ways", "displacement", "lengths")]
    if not names or sorted(names) == ["open", "sight"]:
        return None
    own: dict[str, Sensor] = {"open": Ways(learned="bearings" in names), "bearings": Bearings()}
    sights = [Sight(name) for name in names if name not in own]
    return [*sights, *(own[name] for name in reversed(names) if name in own)]


def _observed(world: Any) -> list[str]:
    """What is in an observation."""
    return list(getattr(getattr(world, "observation_space", None), "spaces", ()))
