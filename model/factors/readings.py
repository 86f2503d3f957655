"""Readings of sensors, checked and brought into one form: labels, likelihoods of labels, ways."""

from collections.abc import Collection, Hashable, Iterable, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any, cast

import numpy as np

from ..domain import Domain
from ..errors import CogmapError
from ..labels import plain
from ..motions import Motions
from ..unseen import UNSEEN

_PLAIN = bool | int | float | None
WayReading = bool | float | None  # whether a way is open: true, false, P(open), or None where it was not looked at


@dataclass(frozen=True, slots=True)
class Likelihoods:
    """P(reading | label) of each label that it is not zero for; only their ratios count, the largest is 1."""

    of: Mapping[Hashable, float]


def checked_label(value: Any, sensor: str, declared: Domain) -> Hashable:
    """The label as a plain hashable value.

    Args:
        value: what the observation has.
        sensor: whose reading it is.
        declared: labels that are known; None can be one of them.

    Raises:
        CogmapError: it is none that can be known again.
    """
    missing = _is_missing(value)
    label: Any = value.item() if isinstance(value, np.ndarray) and value.ndim == 0 else value
    if missing or (label is None and None not in declared):
        name = "masked" if missing else "None"
        remedy = "" if missing else f', or declare the label: Sight("{sensor}", labels=[None])'
        raise CogmapError(f"observation: {sensor} is {name}; give UNSEEN where nothing was seen{remedy}")
    try:
        hash(label)
    except TypeError as error:
        kind = type(value).__name__
        raise CogmapError(
            f"observation: {sensor} is a {kind}, not hashable; label sights with str, int or tuple"
        ) from error
    if _has_nan(label):  # it would be a new sight each time
        raise CogmapError(f"observation: {sensor} is NaN, which equals nothing; give UNSEEN where nothing was seen")
    return plain(label)


def declared(labels: Any, sensor: str) -> tuple[Hashable, ...]:
    """The labels that a sensor is declared with. Raises CogmapError: they are no list of labels."""
    if labels is None:
        return ()
    if isinstance(labels, str | bytes) or not isinstance(labels, Iterable):
        raise CogmapError(f"{sensor}: labels are {labels!r}; give a list of labels")
    listed = list(cast(Iterable[Any], labels))
    known = Domain(sensor, [None])
    return tuple(checked_label(label, sensor, known) for label in listed)


def checked_likelihoods(value: Mapping[Any, Any], sensor: str, declared: Domain) -> Hashable | Likelihoods:
    """Likelihoods of labels, with 1 as the largest; the label itself where only one is possible.

    Raises:
        CogmapError: a label or a likelihood that is none, or none above zero.
    """
    given = {checked_label(label, sensor, declared): likelihood for label, likelihood in value.items()}
    for label, likelihood in given.items():
        if not _is_likelihood(likelihood):
            raise CogmapError(
                f"observation: {sensor} has likelihood {likelihood!r} of {label!r}; give finite numbers of 0 or more"
            )
    most = max(map(float, given.values()), default=0.0)
    if most <= 0.0:
        raise CogmapError(
            f"observation: {sensor} has no likelihood above 0; give one of a label, or UNSEEN where nothing was seen"
        )
    told = {label: float(likelihood) / most for label, likelihood in given.items() if float(likelihood) / most > 0.0}
    return next(iter(told)) if len(told) == 1 else Likelihoods(told)


def checked_ways(value: Any, motions: Motions) -> tuple[WayReading, ...] | None:
    """A reading an action, from a list, an array (masked where not looked at) or a mapping by name.

    Staying is always open. None where no way was looked at.

    Raises:
        CogmapError: it is not one truth value, probability or None an action.
    """
    names = ", ".join(motions.names)
    if value is UNSEEN:
        return None
    if isinstance(value, Mapping):
        given = cast(Mapping[Any, Any], value)
        if unknown := [name for name in given if name not in motions.names]:
            raise CogmapError(f"observation: 'open' has no way {unknown[0]!r}; known are {names}")
        value = [given.get(name) for name in motions.names]
    entries, shape = _listed(value)
    if shape != (len(motions),):
        raise CogmapError(f"observation: 'open' has shape {shape}; give one truth value an action: {names}")
    read = [_way(each) for each in entries]
    if all(way is None for action, way in enumerate(read) if action != motions.stay):
        return None
    return tuple(True if action == motions.stay else way for action, way in enumerate(read))


def _listed(value: Any) -> tuple[list[Any], tuple[int, ...]]:
    """Its single readings, None where masked, and its shape."""
    if isinstance(value, np.ma.MaskedArray) and value.ndim == 1:
        masked = cast("np.ma.MaskedArray[Any, Any]", value)
        hidden = np.ma.getmaskarray(masked).tolist()
        value = [None if out else each for each, out in zip(masked.data.tolist(), hidden, strict=True)]
    if isinstance(value, list | tuple):
        entries = list(cast("list[Any] | tuple[Any, ...]", value))
        if not any(not isinstance(entry, _PLAIN) and np.ndim(entry) for entry in entries):
            return entries, (len(entries),)
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise CogmapError(
            "observation: 'open' holds lists of different lengths; give one truth value an action"
        ) from error
    return (array.tolist() if array.ndim == 1 else []), array.shape


def _way(value: Any) -> WayReading:
    if value is None or value is UNSEEN or value is np.ma.masked:
        return None
    if isinstance(value, bool | np.bool_):
        return bool(value)
    if isinstance(value, int | float | np.integer | np.floating) and 0.0 <= value <= 1.0:
        return bool(value) if value in (0, 1) else float(value)
    raise CogmapError(
        f"observation: 'open' holds {value!r}; give truth values, P(open) from 0 to 1, or None where not looked at"
    )


def _is_missing(value: Any) -> bool:
    if isinstance(value, np.ma.MaskedArray) and value.ndim == 0:
        return bool(np.ma.getmaskarray(cast("np.ma.MaskedArray[Any, Any]", value)).all())
    return value is UNSEEN  # among the keys of likelihoods


def _has_nan(label: Hashable) -> bool:
    if isinstance(label, tuple | frozenset):
        return any(_has_nan(part) for part in cast(Collection[Hashable], label))
    try:
        return bool(label != label)
    except (TypeError, ValueError):  # such as pandas' NA, which is neither equal nor unequal
        return True


def _is_likelihood(value: Any) -> bool:
    if isinstance(value, bool | np.bool_) or value is np.ma.masked:
        return False
    return isinstance(value, int | float | np.integer | np.floating) and isfinite(value) and bool(value >= 0.0)
