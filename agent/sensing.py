"""What one step brings, in the words of the hypotheses about the map."""

from collections.abc import Callable
from math import log

import numpy as np

from ..inference import Sensed, WayScheme
from ..model import Carried, GenerativeModel, Locks, Percept

UNSURE = 0.25  # P(the move failed) at least, where the body is not sure of it


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
        takes = [action for action, what in enumerate(motions.takes) if what]  # these lead to the same room
        self.actions = tuple(action for action in range(len(motions)) if action not in (motions.stay, *takes))
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
        self._locks = next((name for name, sensor in model.sensors.items() if isinstance(sensor, Locks)), None)
        own = {"open", self._locks, *(name for name, sensor in model.sensors.items() if isinstance(sensor, Carried))}
        self._others = [name for name in model.sensors if name not in sights | own]

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
        locks = readings.get(self._locks or "") or (-1,) * len(open_)  # a locked way leads on, to who carries its key
        ways = tuple(open_[action] if locks[action] < 0 else 1.0 for action in self.actions) or (None,)
        action = None if percept.action is None else self.ways.get(percept.action)
        return Sensed(
            sights,
            ways,
            action,
            certain=percept.taken or percept.outcome in ("arrived", "blocked"),
            told=percept.moved,
            others=self._told(percept, place) if any(name in readings for name in self._others) else None,
            went=self._went(percept, moves=action is not None),
            fails=UNSURE if percept.outcome == "unsure" and action is not None else 0.0,
        )

    def _went(self, percept: Percept, *, moves: bool) -> tuple[float, ...] | None:
        """Log-likelihood of what odometry measured and the body said, if each way was taken, and last if none was."""
        measured, said = self._model.pose.measured(percept), moves and percept.outcome in ("arrived", "blocked")
        if (measured is None and not said) or not self.actions:
            return None
        each = np.zeros(len(self._model.motions)) if measured is None else measured
        went = each[[*self.actions, self._model.motions.stay]]
        if said:
            lie = log(self._model.priors.door_floor)  # the body is wrong as rarely as a door is believed otherwise
            went[slice(-1, None) if percept.outcome == "arrived" else slice(-1)] += lie
        return tuple((went - went.max()).tolist())

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
