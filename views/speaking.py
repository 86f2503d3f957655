"""Which sensor spoke for what, and what was expected of it."""

from collections.abc import Hashable
from dataclasses import dataclass

import numpy as np

from ..agent import Agent
from ..model import shown

LEAST = 5e-4
"""Nats and counts below which there are none to speak of."""


@dataclass(frozen=True, slots=True)
class Spoken:
    """What one sensor had to say at the last step of the place that the agent believes to be in."""

    sensor: str
    seen: bool  # whether it saw anything
    sensed: Hashable  # what it sensed, as the graph shows it; None where it saw nothing
    expected: Hashable  # what was most probable there before; None where nothing was known of it
    nats: float  # log P(sensed | place) beyond that of a place of which nothing is known: what it spoke for the place

    def __str__(self) -> str:
        if not self.seen:
            return f"{self.sensor} saw nothing"
        known = "" if self.expected is None else f" (expected {shown(self.expected)})"
        spoke = f"spoke {'for' if self.nats > 0.0 else 'against'} it by {abs(self.nats):.3f} nats"
        return f"{self.sensor} {shown(self.sensed)}{known} {spoke if abs(self.nats) >= LEAST else 'told nothing of it'}"


def spoken(agent: Agent) -> tuple[Spoken, ...]:
    """What each sensor had to say at the last step, in order."""
    last, here = agent.window[-1], agent.belief.place
    row, percept = np.flatnonzero(last.places == here), last.percept
    tables = {table.name: table for table in last.tables}
    found: list[Spoken] = []
    for name, sensor in agent.map.sensors.items():
        expected = agent.expected[name]
        if name not in percept.readings:
            found.append(Spoken(name, False, None, expected, 0.0))
            continue
        reading = percept.readings[name]
        told = tables[sensor.symbol].array[0, row].item() if len(row) and sensor.symbol in tables else 0.0
        log = np.log(told) if told > 0.0 else sensor.log_likelihood(np.array([here]), reading).item()
        nats = float(log - sensor.log_predictive(reading))
        found.append(Spoken(name, True, sensor.label(reading), expected, nats))
    return tuple(found)
