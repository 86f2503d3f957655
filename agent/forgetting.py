"""Labels and positions that nothing in the map has any more are forgotten, now and then."""

from __future__ import annotations

from ..inference import Tracker
from ..model import CognitiveMap
from .state import State

EVERY = 256
"""Steps after which it is looked for them."""

SPARE = 512
"""So many, or none is forgotten."""


def forget_unused(map_: CognitiveMap, tracker: Tracker, state: State) -> None:
    """Forget what is known by its name alone, or memory would grow with everything that was ever seen.

    A label goes that no place shows, in the map or in a hypothesis, and that the last percepts do not have; a position
    that no place has. Where there are hardly more of them than places it is not worth looking.
    """
    if state.steps % EVERY or state.belief is None:
        return
    for at, sensor in enumerate(map_.sights_sensed):
        if len(sensor.labels) > len(map_.places) + 2 * SPARE:
            sensor.forget(_in_window(state, sensor.name) | tracker.labels_used(at), least=SPARE)
    if len(map_.positions) > 2 * len(map_.places) + 2 * SPARE:
        message = state.belief.message
        arrays = [message.positions, *(slice_.positions for slice_ in state.window)]
        map_.pose.forget({number for array in arrays for number in array.tolist()}, least=SPARE)


def _in_window(state: State, name: str) -> set[int]:
    used = set[int]()
    for slice_ in state.window:
        reading = slice_.percept.readings.get(name)
        used.update([reading] if isinstance(reading, int) else reading or ())
    return used
