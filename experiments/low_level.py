"""What a run took of low-level steps, in worlds where a body carries out what the agent chooses."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import gymnasium as gym

from .records import mean

TENTHS = 9  # the share of tiles seen, in tenths, that the authors count as explored


@dataclass(slots=True)
class Meter:
    """Counts from where it is made; all figures are None in a world without a body."""

    world: Any
    begin: int = 0
    least: int | None = None

    @classmethod
    def of(cls, world: gym.Env[Any, Any], goal: Any = None) -> Meter:
        """From now on; towards `goal`, if there is one."""
        inner: Any = world.unwrapped
        if not hasattr(inner, "low_level_steps"):
            return cls(None)
        return cls(inner, inner.low_level_steps, inner.least_to(goal))

    def towards(self) -> tuple[int | None, int | None]:
        """Steps until now, or until the white tile was stood on; and the fewest possible."""
        if self.world is None:
            return None, None
        return self.world.low_level_steps_to_goal(self.begin), self.least

    def explored(self) -> tuple[Any, ...]:
        """Steps until every room was entered, the fewest possible, steps to see nine tenths, the share seen."""
        if self.world is None:
            return None, None, None, None
        tally = self.world.rooms.tally
        entered = max(tally.entered.values()) if len(tally.entered) == len(self.world.chart.places) else None
        return entered, self.world.least_to_cover(), tally.shares.get(TENTHS), round(tally.share, 6)


def low_level(runs: Iterable[Any], *names: str) -> dict[str, float | None]:
    """Means of these figures over the runs that have them; nothing where none has any."""
    runs = list(runs)
    there = any(getattr(run, name) is not None for run in runs for name in names)
    return {f"mean_{name}": mean(getattr(run, name) for run in runs) for name in names} if there else {}
