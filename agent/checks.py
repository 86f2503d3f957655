"""What must hold of the state of an agent, whoever wrote the file that it comes from."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..inference import Belief, Hypothesis
from ..model import CogmapError, CognitiveMap, Percept, Slice, window_graph
from .state import Choice, GivenPreferences, State

NEARLY = 1e-6  # how far probabilities may be from adding up to one


def check_state(state: State, map_: CognitiveMap) -> None:
    """Refuse a state that no agent with this map can be in. Raises CogmapError: it is one."""
    actions = len(map_.motions)
    if not (state.steps >= 0 and (state.belief is not None) == (state.steps > 0) == bool(state.window)):
        raise CogmapError("its steps do not go with what it believes")
    if not (_is_action(state.action, actions) and (state.action is not None or not (state.acted and state.steps))):
        raise CogmapError("its last action is none")
    if state.open is not None and len(state.open) != actions:
        raise CogmapError("its ways are not one an action")
    if state.belief is not None:
        _check_belief(state.belief, map_)
    _check_preferences(state.preferences, map_)
    if not all(_is_action(action, actions) and many > 0 <= total for action, (many, total) in state.costs.items()):
        raise CogmapError("its moves cost what none can")
    for name, value in (state.expected or {}).items():
        hash(value)
        if name not in map_.sensors:
            raise CogmapError("it expected something of a sensor that it does not have")
    if state.choice is not None:
        _check_choice(state.choice, map_)
    if state.percept is not None:
        _check_percept(state.percept, map_)
    _check_window(state.window, state, map_)


def check_recognition(
    places: Mapping[Any, Any],
    missed: Any,
    followed: Any,
    moved: Any,
    map_: CognitiveMap,
    hypotheses: Sequence[Hypothesis],
) -> None:
    """Refuse what no agent says of which place is which.

    Args:
        places: by number of a place of the followed hypothesis, the place of the map.
        missed: numbers of places of which the map was not taught the last steps.
        followed: number of the hypothesis that the map says; None where there is none.
        moved: whether it has the agent moved in the last step.
        map_: the map.
        hypotheses: all of them.

    Raises:
        CogmapError: a number is none, or about a place or a hypothesis that there is not.
    """
    numbers = [*places, *places.values(), *missed, *([] if followed is None else [followed])]
    whole = all(isinstance(number, int) and not isinstance(number, bool) for number in numbers)
    if not whole or not isinstance(moved, bool) or not all(place in map_.places for place in places.values()):
        raise CogmapError("which place is which is told by what are no places of the map")
    known = {*places, *missed}  # of a place that was missed the map has not been told yet
    if followed is not None and not (0 <= followed < len(hypotheses) and hypotheses[followed].here in known):
        raise CogmapError("the map follows a hypothesis that there is not")


def _check_belief(belief: Belief, map_: CognitiveMap) -> None:
    message, told = belief.message, belief.log_likelihood
    of_pairs = (message.places, message.positions, message.mass, told)
    lists = (*zip(of_pairs, "iiff", strict=True), *zip(belief.pairwise, "iif", strict=True))
    if not all(part.ndim == 1 and part.dtype.kind == kind for part, kind in lists):
        raise CogmapError("a list of the belief is none of numbers of its kind")
    if len(set(map(len, of_pairs))) > 1 or len(set(map(len, belief.pairwise))) > 1:
        raise CogmapError("the masses of the belief do not belong to its places and positions")
    fine = _is_distribution(message.mass) and np.isfinite(told).all() and _are_shares(belief.pairwise[2])
    fine = fine and all(-NEARLY <= p <= 1.0 + NEARLY for p in (belief.moved, belief.dropped, belief.doubt))
    if not fine or float(belief.pairwise[2].sum()) > 1.0 + NEARLY:
        raise CogmapError("the masses of the belief are no probabilities")
    _check_numbers(message.places, message.positions, map_)
    for places in belief.pairwise[:2]:
        if not _are_below(places, len(map_.places)):
            raise CogmapError("the belief comes from places that the map does not have")


def _check_preferences(preferences: GivenPreferences, map_: CognitiveMap) -> None:
    if any(place not in map_.places for place in preferences.places):
        raise CogmapError("it prefers a place that the map does not have")


def _check_choice(choice: Choice, map_: CognitiveMap) -> None:
    _check_preferences(choice.preferences, map_)
    if not choice.policy or not all(0 <= action < len(map_.motions) for action in choice.policy):
        raise CogmapError("its last choice is no sequence of actions")


def _check_window(window: Sequence[Slice], state: State, map_: CognitiveMap) -> None:
    if not _are_consecutive([slice_.step for slice_ in window], state.steps - 1):
        raise CogmapError("the window is not of its last steps")
    for slice_ in window:
        numbers, shape = (slice_.places, slice_.positions), (len(slice_.places), len(slice_.positions))
        if any(part.ndim != 1 for part in numbers) or slice_.joint.shape != shape:
            raise CogmapError("the window does not fit its places and positions")
        _check_numbers(*numbers, map_)
        if any(len(np.unique(part)) < len(part) for part in numbers) or not _is_distribution(slice_.joint):
            raise CogmapError("the masses of the window are no probabilities")
        _check_percept(slice_.percept, map_)
        for table in slice_.tables:
            if not (np.isfinite(table.array) & (table.array >= 0.0)).all():
                raise CogmapError("a factor of the window has numbers that are none")
    for variable in window_graph(map_, window).variables:  # its factors check their shapes
        assert variable.domain


def _check_percept(percept: Percept, map_: CognitiveMap) -> None:
    if not _is_action(percept.action, len(map_.motions)):
        raise CogmapError("a percept has an action that is none")
    here = np.zeros(1, dtype=np.int64)
    readings: Mapping[str, Any] = percept.readings
    for name, reading in readings.items():
        sensor: Any = map_.sensors[name]
        if isinstance(reading, int) and reading < 0:
            raise CogmapError(f"a percept has a reading of {name} that is none")
        hash(sensor.label(reading))
        likelihood: Any = sensor.log_likelihood(here, reading)
        if np.shape(likelihood) != (1,) or np.isnan(likelihood).any():
            raise CogmapError(f"a percept has a reading of {name} that is none")


def _check_numbers(places: NDArray[Any], positions: NDArray[Any], map_: CognitiveMap) -> None:
    for numbers, count in ((places, len(map_.places)), (positions, max(len(map_.positions), 1))):
        if not len(numbers) or not _are_below(numbers, count):
            raise CogmapError("belief or window are about places that the map does not have")


def _is_action(action: int | None, count: int) -> bool:
    return action is None or 0 <= action < count


def _are_consecutive(steps: Iterable[int], last: int) -> bool:
    listed = [*steps]
    return not listed or (listed[0] >= 0 and listed[-1] == last and all(b == a + 1 for a, b in pairwise(listed)))


def _are_below(numbers: NDArray[Any], bound: int) -> bool:
    return numbers.ndim == 1 and bool(((numbers >= 0) & (numbers < bound)).all())


def _are_shares(numbers: NDArray[Any]) -> bool:
    return bool((np.isfinite(numbers) & (numbers >= 0.0)).all())


def _is_distribution(mass: NDArray[Any]) -> bool:
    return _are_shares(mass) and abs(float(mass.sum()) - 1.0) < NEARLY
