"""Noise in pixels and in actions of a MiniGrid environment."""

from typing import Any

import gymnasium as gym
import numpy as np

from ..errors import WorldError

_MOVES = (0, 1, 2, 6)  # left, right, forward, nothing
MOST = {"pixels": 255.0, "gain": 1.0, "slips": 1.0}  # the kinds of noise, and the most that each may be


class Unsteady(gym.Wrapper[Any, Any, Any, Any]):
    """An environment whose camera and legs err.

    Args:
        env: one of MiniGrid.
        pixels: standard deviation of the noise in each value of each pixel, of 255; only in an RGB view.
        gain: the light changes: each frame is multiplied by a number drawn evenly from 1 - gain to 1 + gain.
        slips: how often another of turning left, turning right, going forward and doing nothing is carried out.

    Raises:
        WorldError: a number out of range, or noise in pixels of a view that has none.
    """

    def __init__(self, env: gym.Env[Any, Any], *, pixels: float = 0.0, gain: float = 0.0, slips: float = 0.0) -> None:
        super().__init__(env)
        for name, value in (("pixels", pixels), ("gain", gain), ("slips", slips)):
            if not 0.0 <= value <= MOST[name]:
                raise WorldError(f"noise {name!r} is {value!r}; use a number from 0 to {MOST[name]:g}")
        if (pixels or gain) and getattr(env.unwrapped, "view", "rgb") == "symbolic":
            raise WorldError("noise in pixels needs pixels; use the view rgb")
        self._pixels, self._gain, self._slips = pixels, gain, slips
        self._rng = np.random.default_rng()

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Reset the environment; a seed seeds the noise as well."""
        if seed is not None:
            self._rng = np.random.default_rng([seed, 1])
        observation, info = self.env.reset(seed=seed, options=options)
        return self._seen(observation), info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Take the action, or another."""
        if self._slips and self._rng.random() < self._slips:
            others = [move for move in _MOVES if move != action]
            action = others[int(self._rng.integers(len(others)))]
        observation, reward, terminated, truncated, info = self.env.step(action)
        return self._seen(observation), reward, terminated, truncated, info

    def displace(self, place: Any, **where: Any) -> Any:
        """Move the agent without a word, and return what it sees there."""
        return self._seen(self.env.get_wrapper_attr("displace")(place, **where))

    def _seen(self, observation: Any) -> Any:
        if not (self._pixels or self._gain):
            return observation
        image = observation["image"] * (1.0 + self._gain * self._rng.uniform(-1.0, 1.0))
        image = image + self._pixels * self._rng.standard_normal(image.shape)
        return {**observation, "image": np.clip(np.rint(image), 0, 255).astype(np.uint8)}
