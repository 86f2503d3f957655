"""What one step brings, in the words of the hypotheses about the map."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..inference import Sensed, WayScheme
from ..model import GenerativeModel, Percept


class Sensing:
    """The ways and sensors of a model as hypotheses know them: ways are the actions that lead somewhere.

    Attributes:
        actions: the action of each way.
        ways: the way of each action that leads somewhere.
        scheme: the ways.
    """

    def __init__(self, model: GenerativeModel) -> None:
        self._model = model
        motions = model.motions
        self.actions = tuple(action for action in range(len(motions)) if action != motions.stay)
        self.ways = {action: way for way, action in enumerate(self.actions)}
        undone = [motions.inverse[action] for action in self.actions]
        inverse = tuple(self.ways[action] for action in undone) if all(action >= 0 for action in undone) else None
        placed = model.pose.origin is not None
        self.scheme = WayScheme(
            max(len(self.actions), 1),
            inverse if self.actions else (0,),
            tuple(motions.displacements[action] for action in self.actions) if placed and inverse else None,
            sensors=max(len(model.sights_sensed), 1),
        )
        sights = {sensor.name for sensor in model.sights_sensed}
        self._others = [name for name in model.sensors if name not in sights and name != "open"]

    def labels(self) -> list[int]:
        """How many labels each sensor has shown."""
        return [len(sensor.labels) for sensor in self._model.sights_sensed] or [0]

    def sensed(self, percept: Percept, *, place: Callable[[int], int | None]) -> Sensed:
        """A percept as hypotheses take it in.

        Args:
            percept: what the step brought.
            place: the place of the model for a place of the hypotheses, where it has one.
        """
        readings, open_ = percept.readings, percept.ways(len(self._model.motions))
        sights = tuple(readings.get(sensor.name) for sensor in self._model.sights_sensed) or (None,)
        ways = tuple(open_[action] for action in self.actions) or (None,)
        action = None if percept.outcome == "blocked" else percept.action
        return Sensed(
            sights,
            ways,
            None if action is None else self.ways.get(action),
            certain=percept.taken or percept.outcome == "arrived",
            told=percept.moved,
            others=self._told(percept, place) if any(name in readings for name in self._others) else None,
        )

    def _told(self, percept: Percept, place: Callable[[int], int | None]) -> Callable[[int | None], float]:
        """What sensors of other kinds say of a place; None stands for one never seen."""
        model, readings = self._model, percept.readings
        heard = [(model.sensors[name], readings[name]) for name in self._others if name in readings]

        def log_likelihood(number: int | None) -> float:
            there = None if number is None else place(number)
            if there is None:
                return sum(sensor.log_predictive(reading) for sensor, reading in heard)
            here = np.array([there])
            return sum(float(sensor.log_likelihood(here, reading)[0]) for sensor, reading in heard)

        return log_likelihood
