"""Observations, checked before anything believes them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..model import CogmapError, GenerativeModel, Percept


def checked(observation: Mapping[str, Any], model: GenerativeModel) -> dict[str, Any]:
    """What each sensor sensed, normalised, and `taken`, the action that was really carried out, where that is said.

    Nothing is remembered yet, so that an agent which refuses is as it was before.

    Raises:
        CogmapError: a key is missing, or a value is none that its sensor could have sensed.
    """
    if not isinstance(observation, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
        kind = type(observation).__name__
        raise CogmapError(f"observation: is a {kind}; give a mapping with keys {_keys(model)}")
    for name in model.sensors:
        if name not in observation:
            raise CogmapError(f"observation: key {name!r} is missing; give {_keys(model)}")
    values = {name: sensor.check(observation[name]) for name, sensor in model.sensors.items()}
    return values | ({"taken": _action(observation["taken"], model)} if "taken" in observation else {})


def percept_of(
    values: Mapping[str, Any], model: GenerativeModel, *, action: int | None, open_: tuple[bool, ...] | None, step: int
) -> Percept:
    """What `checked` gave as the model reads it; domains grow with what was never sensed before.

    Args:
        values: what was sensed.
        model: whose sensors read it.
        action: the action that was answered last; None at the first step.
        open_: for each action whether its way was sensed open before it; None where nothing senses that.
        step: the time step.
    """
    action = None if action is None else values.get("taken", action)
    readings = {name: sensor.read(values[name], step=step) for name, sensor in model.sensors.items()}
    return Percept(action, action is not None and (open_ is None or open_[action]), readings)


def _keys(model: GenerativeModel) -> str:
    names = list(map(repr, model.sensors)) or ["of its sensors (it has none)"]
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def _action(taken: Any, model: GenerativeModel) -> int:
    names = model.motions.names
    if isinstance(taken, str) and taken in names:
        return names.index(taken)
    if isinstance(taken, int | np.integer) and not isinstance(taken, bool) and 0 <= taken < len(names):
        return int(taken)
    raise CogmapError(f"observation: 'taken' is {taken!r}; give an action by name or index: {', '.join(names)}")
