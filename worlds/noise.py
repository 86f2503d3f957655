"""Noise in a world, as a Gymnasium wrapper."""

from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from .errors import WorldError
from .protocol import CanClose, CanDisplace, HasChart, Observation, World, offered
from .spaces import Labels

NOISES: Mapping[str, float] = MappingProxyType(
    {"sight": 1.0, "door": 1.0, "slip": 1.0, "fail": 1.0, "moved": 1.0, "odometry": 1.0, "heading": 180.0, "miss": 1.0}
)
"""The kinds of noise, and the most that each may be."""

_NO_SENSORS = ("open", "ways", "bearings", "lengths", "displacement")


class NoisyWorld(gym.Wrapper[Observation, Any, Observation, Any]):
    """A wrapper that adds noise to a world. Each kind of noise has its own random stream, seeded by `reset(seed=)`.

    What really happened is in `info` alone: `taken`, the action carried out; `failed` and `moved`, truth values.

    Args:
        world: a world with motions.
        noise: rates by kind, 0 where not given.
            `sight`: a label is drawn evenly from the other labels of its sensor.
            `door`: each reading of a way flips (`stay` does not).
            `miss`: an open way is read as shut.
            `slip`: another action than the one given is carried out, drawn evenly from the others.
            `fail`: the action is not carried out.
            `moved`: then the agent is put into a place drawn evenly from those that are not closed.
            `odometry`: standard deviation of the displacement measured along each axis, over the length of the move.
            `heading`: standard deviation, in degrees, of the direction in which a move is measured, anew at each.

    Raises:
        WorldError: an unknown kind, a rate outside 0 to 1 (0 to 180 degrees), or a world that has nothing to err in.
    """

    def __init__(self, world: gym.Env[Observation, Any], **noise: float) -> None:
        super().__init__(world)
        self.motions = offered(world, World, "noise").motions
        self.noise = {kind: _rate(kind, value) for kind, value in noise.items() if _rate(kind, value) > 0.0}
        self._labels = _labels(world) if "sight" in self.noise else {}
        self._stay = _stay(self) if "fail" in self.noise else 0
        self._check()
        self._actions = len(self.motions.names)
        self._measured: NDArray[np.float64] | None = None
        self._rng = _streams(None)

    @property
    def place(self) -> Any:
        """The true place of the agent: for experiments, never for agents."""
        return self.env.get_wrapper_attr("place")

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Reset the world; a seed seeds the noise as well."""
        observation, info = self.env.reset(seed=seed, options=options)
        if seed is not None:
            self._rng = _streams(seed)
        return self._sensed(self._odometry(observation)), info

    def step(self, action: Any) -> tuple[Observation, Any, bool, bool, dict[str, Any]]:
        """Take an action, or another, or none."""
        taken = self._other("slip", range(self._actions), action) if self._happens("slip") else action
        failed = self._happens("fail")
        observation, reward, terminated, truncated, info = self.env.step(self._stay if failed else taken)
        observation = self._odometry(observation)
        if moved := self._happens("moved"):
            place, seen = self._put_anywhere()
            observation = {**observation, **seen}
            info = {**info, "place" if "place" in info else "position": place}
        told = {**info, "taken": taken, "failed": failed, "moved": moved}
        return self._sensed(observation), reward, terminated, truncated, told

    def observe(self) -> Observation:
        """What the agent senses now, without acting: another look, with errors of its own."""
        return self._sensed(offered(self.env, CanDisplace, "observing").observe())

    def displace(self, place: Any) -> Observation:
        """Move the agent to `place` without a word, and return what it senses there."""
        return self._sensed(offered(self.env, CanDisplace, "displacing").displace(place))

    def _happens(self, kind: str) -> bool:
        rate = self.noise.get(kind, 0.0)
        return rate > 0.0 and self._rng[kind].random() < rate

    def _other(self, kind: str, choices: Sequence[Any], this: Any) -> Any:
        """One of the choices but this, drawn evenly."""
        while len(choices) > 1:
            drawn = choices[int(self._rng[kind].integers(len(choices)))]
            if drawn != this:
                return drawn
        return this

    def _sensed(self, observation: Observation) -> Observation:
        """With errors in labels and in readings of ways, and the last move as it was measured."""
        seen = dict(observation)
        for sensor, labels in self._labels.items():
            if self._happens("sight"):
                seen[sensor] = self._other("sight", labels, seen[sensor])
        if self.motions.local:
            seen["ways"] = {way: self._read(is_open) for way, is_open in seen["ways"].items()}
            self._actions = len(self.motions.names) + len(seen["ways"])
        elif self.noise.keys() & {"door", "miss"}:
            pairs = zip(self.motions.names, seen["open"], strict=True)
            read = [is_open if name == "stay" else self._read(is_open) for name, is_open in pairs]
            seen["open"] = read if None in read else np.array(read, dtype=np.bool_)
        if self._measured is not None:
            seen["displacement"] = self._measured.copy()
        return seen

    def _read(self, is_open: bool | None) -> bool | None:
        flipped, missed = self._happens("door"), self._happens("miss")
        return None if is_open is None else bool(is_open) != flipped and not missed

    def _odometry(self, observation: Observation) -> Observation:
        """The same; the displacement is measured: turned, then blurred."""
        if "odometry" in self.noise or "heading" in self.noise:
            true = np.asarray(observation["displacement"], dtype=np.float64)
            angle = np.deg2rad(self.noise.get("heading", 0.0)) * self._rng["heading"].standard_normal()
            turned = true.copy()
            turned[:2] = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) @ true[:2]
            spread = self.noise.get("odometry", 0.0) * np.linalg.norm(true)
            self._measured = turned + spread * self._rng["odometry"].standard_normal(true.size)
        return observation

    def _put_anywhere(self) -> tuple[Any, Observation]:
        places = offered(self.env, HasChart, "noise 'moved'").chart.places
        closed = _closed(self.env)
        place = places[int(self._rng["moved"].integers(len(places)))]
        while place in closed:
            place = places[int(self._rng["moved"].integers(len(places)))]
        return place, offered(self.env, CanDisplace, "noise 'moved'").displace(place)

    def _check(self) -> None:
        keys = set(_observed(self.env))
        ways = {"ways" if self.motions.local else "open"}
        needs = {"door": ways, "miss": ways, "odometry": {"displacement"}, "heading": {"displacement"}}
        for kind in self.noise:
            if missing := needs.get(kind, set()) - keys:
                raise WorldError(f"noise {kind!r} errs in {missing.pop()!r}, and this world does not tell it")
        if "moved" in self.noise:
            offered(self.env, HasChart, "noise 'moved'")
            offered(self.env, CanDisplace, "noise 'moved'")


def _rate(kind: str, value: Any) -> float:
    if kind not in NOISES:
        raise WorldError(f"unknown noise {kind!r}; use {', '.join(NOISES)}")
    if isinstance(value, bool) or not isinstance(value, int | float | np.number) or not 0.0 <= value <= NOISES[kind]:
        raise WorldError(f"noise {kind!r} is {value!r:.40}; use a number from 0 to {NOISES[kind]:g}")
    return float(value)


def _streams(seed: int | None) -> dict[str, np.random.Generator]:
    return dict(zip(NOISES, map(np.random.default_rng, np.random.SeedSequence(seed).spawn(len(NOISES))), strict=True))


def _observed(world: gym.Env[Any, Any]) -> Mapping[str, Any]:
    space = world.observation_space
    return space.spaces if isinstance(space, spaces.Dict) else {}


def _labels(world: gym.Env[Any, Any]) -> dict[str, Sequence[Any]]:
    """The labels of each sensor: of the chart, where there is one, else of the space of observations."""
    sensors = [key for key in _observed(world) if key not in _NO_SENSORS]
    try:
        seen = set(offered(world, HasChart, "noise").chart.sights.values())
    except WorldError:
        return {sensor: _labels_of(sensor, _observed(world)[sensor]) for sensor in sensors}
    columns: list[Collection[Any]] = (
        [seen] if len(sensors) == 1 else [set(column) for column in zip(*seen, strict=True)]
    )
    return {sensor: sorted(column, key=repr) for sensor, column in zip(sensors, columns, strict=True)}


def _labels_of(sensor: str, space: spaces.Space[Any]) -> Sequence[Any]:
    if isinstance(space, spaces.Discrete):
        return range(int(space.start), int(space.start + space.n))
    if isinstance(space, Labels):
        return space.labels
    raise WorldError(f"noise 'sight' draws from the labels of {sensor!r}, and {space} does not list them")


def _stay(world: NoisyWorld) -> int:
    motions = world.motions
    stays = [i for i, vector in enumerate(motions.displacements) if not any(vector)]
    stays += [i for i, name in enumerate(motions.names) if name == "stay"]
    if not stays:
        raise WorldError("noise 'fail' needs an action that stays, such as 'stay'")
    return stays[0]


def _closed(world: gym.Env[Any, Any]) -> frozenset[Any]:
    try:
        return offered(world, CanClose, "noise").closed_rooms
    except WorldError:
        return frozenset()
