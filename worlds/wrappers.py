"""Other environments as worlds, and worlds in which less is sensed."""

from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces

from .errors import WorldError
from .generate import at_least
from .motions import Motions
from .protocol import HasChart, Observation, World, offered
from .spaces import PerAction

_LISTED = ("bearings", "lengths")  # What is told of each way


class UnseenWays(gym.ObservationWrapper[Observation, Any, Observation]):
    """Takes the sensor of ways away from a world.

    Observations have no key `open`; where ways belong to the place they are listed, each with None (not looked at).
    """

    def __init__(self, world: gym.Env[Observation, Any]) -> None:
        super().__init__(world)
        self.motions = offered(world, World, "a world without a sensor of ways").motions
        if isinstance(world.observation_space, spaces.Dict):
            told = {key: space for key, space in world.observation_space.spaces.items() if key != "open"}
            self.observation_space = spaces.Dict(told)

    def observation(self, observation: Observation) -> Observation:
        """The same without what is seen of the ways."""
        seen = {key: value for key, value in observation.items() if key != "open"}
        return seen | {"ways": dict.fromkeys(seen["ways"])} if self.motions.local else seen

    def observe(self) -> Observation:
        """What the agent senses now, without acting."""
        return self.observation(self.env.get_wrapper_attr("observe")())

    def displace(self, place: Any) -> Observation:
        """Move the agent to `place` without a word, and return what it senses there."""
        return self.observation(self.env.get_wrapper_attr("displace")(place))


class ListedWays(gym.Wrapper[Observation, Any, Observation, Any]):
    """Gives a world with local ways a fixed list of actions: action i takes the i-th way that is listed.

    Action 0 stays, action i takes the i-th way that is listed; a place with fewer ways has the others shut.
    Observations have `open` instead of `ways`; `bearings` and `lengths`, where they are told, list one an action,
    None of no way.

    Args:
        world: its `motions.local` is true.

    Raises:
        WorldError: its actions are those of the whole world already.
    """

    def __init__(self, world: gym.Env[Observation, Any]) -> None:
        super().__init__(world)
        if not offered(world, World, "listing ways").motions.local:
            raise WorldError(f"{world} has actions of the whole world already; use it as it is")
        chart = offered(world, HasChart, "listing ways").chart
        most = max(len(chart.exits(place)) for place in chart.places)
        self.motions = Motions(("stay", *(f"way {i}" for i in range(1, most))))
        self.action_space = spaces.Discrete(most)
        inner: Any = world.observation_space
        sensed = {key: space for key, space in inner.spaces.items() if key not in ("ways", *_LISTED)}
        self._sensed = {*sensed}
        told: dict[str, spaces.Space[Any]] = {key: PerAction(most) for key in _LISTED if key in inner.spaces}
        self.observation_space = spaces.Dict({**sensed, **told, "open": spaces.MultiBinary(most)})

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Reset the world."""
        observation, info = self.env.reset(seed=seed, options=options)
        return self._listed(observation), info

    def step(self, action: Any) -> tuple[Observation, Any, bool, bool, dict[str, Any]]:
        """Take the way of this number; one that is not there leads nowhere."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        return self._listed(observation), reward, terminated, truncated, info

    def observe(self) -> Observation:
        """What the agent senses now, without acting."""
        return self._listed(self.env.get_wrapper_attr("observe")())

    def displace(self, place: Any) -> Observation:
        """Move the agent to `place` without a word, and return what it senses there."""
        return self._listed(self.env.get_wrapper_attr("displace")(place))

    def _listed(self, observation: Observation) -> Observation:
        seen = {key: value for key, value in observation.items() if key in self._sensed}
        ways = [True, *map(bool, observation["ways"].values())]
        none = len(self.motions.names) - len(ways)
        seen["open"] = np.array(ways + [False] * none)
        for key in _LISTED:
            if key in observation:
                told = observation[key]
                seen[key] = (None, *(told.get(way) for way in observation["ways"]), *(None,) * none)
        return seen


class StateWorld(gym.Wrapper[Observation, Any, Any, Any]):
    """Makes a world from an environment with numbered states and actions, such as `FrozenLake-v1`.

    The number observed is the sight, and the true place in `info["place"]`. Ways are not sensed. `stay` is added if no
    motion stays: it is not carried out, and the last observation comes again.

    Args:
        world: an environment with `Discrete` observations and actions.
        motions: the displacement of each action, in the order of the actions.

    Raises:
        WorldError: other spaces, or not one motion an action.
    """

    def __init__(self, world: gym.Env[Any, Any], motions: Mapping[str, Sequence[int]]) -> None:
        super().__init__(world)
        if not (
            isinstance(world.observation_space, spaces.Discrete) and isinstance(world.action_space, spaces.Discrete)
        ):
            raise WorldError(f"{world} observes or acts by more than a number; write a wrapper of your own")
        if spaces.Discrete(len(motions)) != world.action_space:
            raise WorldError(f"{world} has the actions {world.action_space}, and {len(motions)} motions were given")
        moves = {name: tuple(vector) for name, vector in motions.items()}
        self._stay = None if any(not any(vector) for vector in moves.values()) else len(moves)
        if self._stay is not None:
            moves["stay"] = (0,) * len(next(iter(moves.values())))
        self.motions = Motions(tuple(moves), tuple(moves.values()))
        self.action_space = spaces.Discrete(len(moves))
        self.observation_space = spaces.Dict({"sight": world.observation_space})
        self._last: tuple[Any, dict[str, Any]] = (0, {})

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Reset the environment."""
        self._last = self.env.reset(seed=seed, options=options)
        return self._seen()

    def step(self, action: Any) -> tuple[Observation, Any, bool, bool, dict[str, Any]]:
        """Take an action, or stay."""
        if action == self._stay:
            observation, info = self._seen()
            return observation, 0.0, False, False, info
        state, reward, terminated, truncated, info = self.env.step(action)
        self._last = state, info
        observation, info = self._seen()
        return observation, reward, terminated, truncated, info

    def _seen(self) -> tuple[Observation, dict[str, Any]]:
        state, info = self._last
        return {"sight": int(state)}, {**info, "place": int(state)}


def frozen_lake(rows: int, columns: int, *, slippery: bool = False) -> StateWorld:
    """Gymnasium's FrozenLake without holes or a goal, the cell as sight, from the upper left corner.

    Where it is slippery, a move goes as told in one case of three, and in each other to one of the two sides.

    Raises:
        WorldError: a size is below 1.
    """
    at_least("frozen_lake", rows=(rows, 1), columns=(columns, 1))
    cells = ["S" + "F" * (columns - 1), *["F" * columns] * (rows - 1)]
    lake = gym.make("FrozenLake-v1", desc=cells, is_slippery=slippery, max_episode_steps=-1, disable_env_checker=True)
    return StateWorld(lake, {"left": (0, -1), "down": (1, 0), "right": (0, 1), "up": (-1, 0)})
