"""Observations, checked before anything believes them."""

import sys
from collections.abc import Callable, Mapping, Set
from typing import Any

import numpy as np

from ..model import OUTCOMES, UNSEEN, CogmapError, GenerativeModel, Motions, Outcome, Percept, is_number

_MOST = sys.float_info.max
_FARTHEST = 1e100  # numbers of a displacement are below, or their squares are none


def checked(observation: Mapping[str, Any], model: GenerativeModel) -> dict[str, Any]:
    """What each sensor sensed, normalised, and what is said of the move, as `Percept` has it.

    A sensor that saw nothing is `UNSEEN`; what is not said of the move is left out. Nothing is remembered yet, so that
    an agent which refuses is as it was before.

    Raises:
        CogmapError: a key is missing or unknown, or a value is none that its sensor could have sensed.
    """
    if not isinstance(observation, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
        kind = type(observation).__name__
        hint = " (of what env.reset() and env.step() return, the first alone)" if isinstance(observation, tuple) else ""
        raise CogmapError(f"observation: is a {kind}; give a mapping with keys {_keys(model)}{hint}")
    given = dict(observation)
    if "ways" in given and "ways" not in model.sensors and "open" in model.sensors:
        if "open" in given:
            raise CogmapError("observation: 'open' and 'ways' are two words for one thing; give one of them")
        given["open"] = given.pop("ways")
    for name in model.sensors:
        if model.sensors[name].optional:
            given.setdefault(name, UNSEEN)
        if name not in given:
            raise CogmapError(f"observation: key {name!r} is missing; give {_keys(model)}")
    values = {name: _sensed(sensor.check, given.pop(name)) for name, sensor in model.sensors.items()}
    for name, value in given.items():
        if name not in _SAID:
            said = ", ".join(map(repr, _SAID))
            raise CogmapError(f"observation: unknown key {name!r}; known are {_keys(model)}, and of the move {said}")
        values[name] = _SAID[name](value, model)
    return values


def percept_of(
    values: Mapping[str, Any], model: GenerativeModel, *, action: int | None, open_: tuple[bool, ...] | None, step: int
) -> Percept:
    """What `checked` gave as the model reads it; domains grow with what was never sensed before.

    Args:
        values: what was sensed.
        model: whose sensors read it.
        action: the action that was answered last; None at the first step.
        open_: for each action whether its way may have been open before it; None where nothing senses that.
        step: the time step.
    """
    taken = action is not None and "taken" in values
    action = values["taken"] if taken else action
    seen = {name: sensor for name, sensor in model.sensors.items() if values[name] is not UNSEEN}
    outcome = values.get("outcome")
    opened = open_ is None or action is None or open_[action]
    if outcome in ("arrived", "blocked"):
        opened = outcome == "arrived"
    return Percept(
        action=action,
        opened=action is not None and opened,
        readings={name: sensor.read(values[name], step=step) for name, sensor in seen.items()},
        taken=taken,
        outcome=outcome,
        displacement=values.get("displacement"),
        turn=values.get("turn"),
        moved=values.get("moved", False),
        cost=values.get("cost"),
        costs=values.get("costs"),
        lengths=values.get("lengths"),
    )


def unseen_ways(percept: Percept | None, motions: Motions) -> tuple[bool, ...]:
    """For each action whether a percept does not tell of its way."""
    seen = (percept or Percept()).ways(len(motions))
    return tuple(way is None and action != motions.stay for action, way in enumerate(seen))


def _sensed(check: Callable[[Any], Any], value: Any) -> Any:
    return UNSEEN if value is UNSEEN else check(value)


def _keys(model: GenerativeModel) -> str:
    names = list(map(repr, model.sensors)) or ["of its sensors (it has none)"]
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def _action(taken: Any, model: GenerativeModel) -> int:
    index = model.motions.index(taken)
    if index is None:
        names = ", ".join(model.motions.names)
        raise CogmapError(f"observation: 'taken' is {taken!r}; give an action by name or index: {names}")
    return index


def _outcome(outcome: Any, model: GenerativeModel) -> Outcome:
    for known in OUTCOMES:
        if isinstance(outcome, str) and outcome == known:
            return known
    raise CogmapError(f"observation: 'outcome' is {outcome!r}; give one of {', '.join(map(repr, OUTCOMES))}")


def _moved(moved: Any, model: GenerativeModel) -> bool:
    if not isinstance(moved, bool | np.bool_):
        raise CogmapError(f"observation: 'moved' is {moved!r}; give true where the agent was moved")
    return bool(moved)


def _displacement(measured: Any, model: GenerativeModel) -> tuple[float, ...]:
    sizes = (2, 3) if model.pose.settles else (model.pose.dimensions,)
    try:
        if isinstance(measured, bytes | Mapping | Set):  # their items would pass for numbers in order
            raise TypeError
        plain = (each for each in measured if each is not np.ma.masked and not isinstance(each, str | bytes | bool))
        vector = tuple(map(float, plain))
    except (TypeError, ValueError):
        vector = ()
    if len(vector) not in sizes or not all(abs(each) < _FARTHEST for each in vector):
        given = " or ".join(map(str, sizes))
        raise CogmapError(f"observation: 'displacement' is {_short(measured)}; give {given} finite numbers")
    return vector


def _number(name: str, least: float) -> Callable[[Any, GenerativeModel], float]:
    def number(value: Any, model: GenerativeModel) -> float:
        if not is_number(value, least, _MOST):
            bound = "" if least < 0.0 else f" of {least:g} or more"
            raise CogmapError(f"observation: {name!r} is {_short(value)}; give a finite number{bound}")
        return float(value)

    return number


def _short(value: Any) -> str:
    return " ".join(repr(value).split())


def _each(what: str) -> Callable[[Any, GenerativeModel], tuple[float | None, ...]]:
    def numbers(value: Any, model: GenerativeModel) -> tuple[float | None, ...]:
        names = model.motions.names
        if isinstance(value, Mapping):
            if unknown := [name for name in value if name not in names]:
                known = ", ".join(names)
                raise CogmapError(
                    f"observation: {what!r} has {_short(unknown[0])}; give {what} of actions by name: {known}"
                )
            value = [value.get(name) for name in names]
        given = list(value) if isinstance(value, list | tuple | np.ndarray) else []
        found = [None if each is None or each is np.ma.masked else each for each in given]
        if len(found) != len(names) or not all(each is None or is_number(each, 0.0, _MOST) for each in found):
            raise CogmapError(
                f"observation: {what!r} is {_short(value)}; give each action a finite number of 0 or more, or None"
            )
        return tuple(None if each is None else float(each) for each in found)

    return numbers


_SAID: dict[str, Callable[[Any, GenerativeModel], Any]] = {
    "taken": _action,
    "outcome": _outcome,
    "displacement": _displacement,
    "turn": _number("turn", -_MOST),
    "moved": _moved,
    "cost": _number("cost", 0.0),
    "costs": _each("costs"),
    "lengths": _each("lengths"),
}
"""What an observation may say of the move besides, and what reads it."""
