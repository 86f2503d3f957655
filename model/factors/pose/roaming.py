"""Open ground: an action leads now here, now there, and only what is measured and sensed tells where."""

import numpy as np

from ...percept import Percept
from .base import Growing
from .metric import MetricPose, fill
from .recognising import recognised
from .relaxing import AXES


class Roaming:
    """Has the moves of an agent that sees no bearings lead where they were measured to lead.

    What is measured is turned by the heading that the agent believes to have drifted by: where loops close it sees by
    how much.

    Args:
        pose: where places lie.
        model: what it is part of.
        step: now.
    """

    def __init__(self, pose: MetricPose, model: Growing, step: int) -> None:
        self._pose, self._model, self._step = pose, model, step

    def arrive(self, left: int, percept: Percept) -> None:
        """Before inference: the agent moved from a place; have its action lead to where that led, perhaps."""
        pose, action = self._pose, percept.action or 0
        if percept.displacement is None:
            return
        raw = np.array([*percept.displacement, 0.0])[:AXES]
        move = pose.odometer.moved(self._turned(percept.displacement), -1.0)
        assert move is not None
        at = pose.where.values[left] + move.moved
        there = recognised(pose, self._model, percept, left, at, move, open_ground=True)
        if there is None:
            there = self._somewhere_new(left, action)
            fill(pose.where, there, at.tolist())
            pose.odometer.measure(float(np.linalg.norm(move.moved)))
            pose.note(left, action, there, raw, roams=True)
        else:
            pose.note(left, action, there, raw, roams=True)
            pose.loop(left, there, at, roams=True)
        self._model.transitions.may_lead(left, action, there)
        pose.led = percept, there, 1.0

    def _turned(self, displacement: tuple[float, ...]) -> list[float]:
        c, s = np.cos(self._pose.heading.values[0]), np.sin(self._pose.heading.values[0])
        x, y = displacement[:2]
        return [float(c * x - s * y), float(s * x + c * y), *displacement[2:]]

    def _somewhere_new(self, left: int, action: int) -> int:
        """A place never entered that the action may lead to."""
        beyond = self._model.transitions.beyond(left, action)
        if beyond is not None and not self._model.visits.visited.values[beyond]:
            return beyond
        return self._model.new_place(step=self._step)
