"""Any environment of MiniGrid with a body in it, as a world for the level above."""

from contextlib import redirect_stdout
from io import StringIO
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from minigrid.minigrid_env import MiniGridEnv

from ..worlds import Motions, Observation, WorldError
from ..worlds import minigrid as mg
from .errand import errand_of
from .protocol import Percept
from .roaming import COLOURS, DOORS, RoamingBody

_STAY = DOORS + len(COLOURS)
_KEYS = tuple(f"{colour} key" for colour in COLOURS)
_DOORS, _NONE = tuple(f"door {n}" for n in range(DOORS)), (None,) * DOORS
VIEWS = ("symbolic", "rgb")


class PixelView(gym.ObservationWrapper[Any, Any, Any]):
    """The view of an environment of MiniGrid in pixels, as MiniGrid's own wrapper shows it."""

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        super().__init__(env)
        told: Any = env.observation_space
        side = mg.TILE * told["image"].shape[0]
        image = spaces.Box(0, 255, (side, side, 3), np.uint8)
        self.observation_space = spaces.Dict({**told.spaces, "image": image})

    def observation(self, observation: Any) -> Any:
        """The same in pixels."""
        return {**observation, "image": mg.paint(observation["image"])}


class RegisteredWorld(gym.Env[Observation, Any]):
    """An environment of MiniGrid by its id. Rooms are chunks of space bounded by doors and gaps, which are their ways.

    Nothing is known of how its rooms lie to each other: actions have no displacements, but a door leads back. The sight
    is which of the rooms that the body has been in this is; it tells which key is carried, and which doors are locked,
    and there is an action for each kind of key. `info` has `low_level_steps` and `reached`, whether the
    environment gave a reward.

    Args:
        name: of the environment.
        view: what the body sees, `"symbolic"` or `"rgb"`.
        errand: whether it is to do what the mission asks for.

    Raises:
        WorldError: no such id, no environment of MiniGrid, no such view, or a mission that is not understood.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": []}  # pyright: ignore[reportIncompatibleVariableOverride]
    motions = Motions(
        (*_DOORS, *(f"take {key}" for key in _KEYS), "stay"),
        (),
        (*range(DOORS), *(-1 for _ in _KEYS), _STAY),
        (*_NONE, *_KEYS, None),
    )

    def __init__(self, name: str, *, view: str | None = None, errand: bool = False) -> None:
        view = view or "symbolic"
        if view not in VIEWS:
            raise WorldError(f"view is {view!r}; use {' or '.join(VIEWS)}")
        mg.need_minigrid()
        if name not in gym.registry:
            raise WorldError(f"no environment {name!r} is registered; MiniGrid's begin with MiniGrid- or BabyAI-")
        try:
            env: Any = gym.make(name, disable_env_checker=True)
        except (gym.error.Error, TypeError, ImportError) as error:
            raise WorldError(f"{name!r} cannot be made ({_line(error)})") from error
        if not isinstance(env.unwrapped, MiniGridEnv):
            raise WorldError(f"{name!r} is no world of MiniGrid; a body of this library lives in no other")
        self.name, self.env = name, PixelView(env) if view == "rgb" else env
        self.body, self._errand = RoamingBody(self.env), errand
        self.action_space = spaces.Discrete(_STAY + 1)
        text = spaces.Text(200)
        self.observation_space = spaces.Dict({"sight": text, "open": spaces.MultiBinary(_STAY + 1), "carried": text})
        self.rooms_seen = 0

    @property
    def low_level_steps(self) -> int:
        """Low-level steps since the last reset."""
        return self.body.steps

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Wake up where the environment puts it. Raises WorldError: the mission is not understood."""
        super().reset(seed=seed)
        try:
            with redirect_stdout(StringIO()):  # BabyAI tells of what it tried in vain
                seen, _ = self.env.reset(seed=seed, options=options)
        except gym.error.DependencyNotInstalled as error:
            raise WorldError(f"{self.name}: {_line(error)}") from error
        wanted = errand_of(seen["mission"]) if self._errand else None
        if self._errand and wanted is None:
            raise WorldError(f"{self.name}: the mission {seen['mission']!r} is none that a body understands yet")
        self.body.begin(seen, errand=wanted)
        self._percept = self.body.wake()
        return self._observation(), self._info()

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Go through a way."""
        before = self.body.reward
        if not self.body.ended:
            self._percept = self._done(int(action))
        return self._observation(), self.body.reward - before, self.body.ended, False, self._info()

    def _done(self, action: int) -> Percept:
        if action == _STAY:
            return self.body.stay()
        return self.body.perform(action) if action < DOORS else self.body.take(action - DOORS)

    def _observation(self) -> Observation:
        body, told = self.body, self._percept
        ways, keys, locks = [told.ways[way] for way in range(DOORS)], body.keys, body.locks
        costs = [body.cost_of(colour) if colour in keys else None for colour in range(len(COLOURS))]
        seen: Observation = {
            "sight": body.room,
            "open": [*ways, *(cost is not None for cost in costs), True],
            "carried": body.key,
            "locks": [
                *(_KEYS[locks[way]] if way in locks else None for way in range(DOORS)),
                *(None for _ in _KEYS),
                None,
            ],
            "costs": [*map(self._cost, range(DOORS)), *costs, None],
        }
        if told.moved:
            return {**seen, "moved": True}
        return seen if told.outcome is None else {**seen, "outcome": told.outcome, "cost": told.steps}

    def _cost(self, way: int) -> float | None:
        return self.body.cost(way) if self._percept.ways[way] else None

    def _info(self) -> dict[str, Any]:
        return {"low_level_steps": self.body.steps, "reached": self.body.reward > 0.0}


def _line(error: Exception) -> str:
    return " ".join(str(error).split())
