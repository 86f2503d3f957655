"""Nearest-frontier search in a world whose ways belong to the place, by its chart."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..worlds import BY, Chart, Place, Routes, WorldError


class ChartFrontier:
    """Goes by a shortest way to the nearest place that was seen but not entered, draws settled evenly.

    When it enters a place it is told which places the ways there lead to, no more; it stays when none is left. It is
    given its true position, and neither looks at sights nor seeks them.

    Args:
        chart: of the world that it is in.
        by: what is nearest, by `"steps"` or `"length"`.
        seed: of its random choices.

    Raises:
        WorldError: an unknown `by`.
    """

    positions = True
    """It is given its true position as well."""

    def __init__(self, chart: Chart, *, by: str = "steps", seed: int | np.random.SeedSequence | None = None) -> None:
        if by not in BY:
            raise WorldError(f"nearest frontier: by is {by!r}; use one of {', '.join(BY)}")
        self.entered: set[Place] = set()
        self._routes, self._rng = Routes(chart, by), np.random.default_rng(seed)

    def step(self, observation: Mapping[str, Any]) -> int:
        """The next action after an observation with the true place as `position`."""
        place = self._routes.chart.find(observation["position"])
        self.entered.add(place)
        found, before = self._routes.nearest(place, lambda other: other not in self.entered, self.entered.__contains__)
        ways = list(self._routes.chart.exits(place))
        if not found:
            return ways.index("stay")
        end = found[int(self._rng.integers(len(found)))]
        while before[end] != place:
            end = before[end]
        leads = self._routes.chart.exits(place)
        return next(i for i, way in enumerate(ways) if leads[way] == end)
