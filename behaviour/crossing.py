"""Held-out likelihood: bouts that no parameter has seen, predicted from those of the group and of the individual."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..model import CogmapError, Floats
from .choices import Choices
from .fitting import STARTS, Around, Fit, Weights, fit
from .models import ChoiceModel, Prepared

FOLDS = 5
LEVELS = ("hierarchical", "alone", "pooled")
"""Whether each individual is fitted around the group, by itself, or has the parameters of the group."""


@dataclass(frozen=True)
class GroupFit:
    """A model fitted to a group."""

    group: Fit  # under the same parameters for all
    individuals: tuple[Fit, ...]  # of each individual, in order


def folds_of(choices: Sequence[Choices], folds: int = FOLDS) -> list[NDArray[np.int64]]:
    """`[C]` of each individual: the fold in which each choice is held out, whole bouts together.

    The bouts of an individual are dealt out so that folds have as many choices as can be. Where there are fewer bouts
    in all than folds, choices are dealt out in as many runs as there are folds.

    Raises:
        CogmapError: fewer than two folds.
    """
    if folds < 2:
        raise CogmapError(f"cross-validation: folds is {folds}; use 2 or more")
    if sum(len(np.unique(one.bout)) for one in choices) < folds:
        return [np.arange(len(one)) * folds // max(1, len(one)) for one in choices]
    return [_dealt(one.bout, folds, first=i) for i, one in enumerate(choices)]


def _dealt(bouts: NDArray[np.int64], folds: int, *, first: int) -> NDArray[np.int64]:
    """The largest bout first, each to the fold that has least, the first to another fold for each individual."""
    _, number, size = np.unique(bouts, return_inverse=True, return_counts=True)
    fold, filled = np.zeros(len(size), dtype=np.int64), np.zeros(folds)
    for bout in np.argsort(-size, kind="stable").tolist():
        fold[bout] = (int(np.roll(filled, -first).argmin()) + first) % folds
        filled[fold[bout]] += size[bout]
    return fold[number]


def fit_group(
    model: ChoiceModel,
    prepared: Sequence[Prepared],
    *,
    level: str = LEVELS[0],
    weights: Weights | None = None,
    starts: int = STARTS,
    seed: int = 0,
    errors: bool = True,
) -> tuple[GroupFit, list[Floats]]:
    """The group under one set of parameters, then each individual: around the group, by itself, or as the group.

    An individual without choices that count has the parameters of the group.

    Args:
        model: the model.
        prepared: choices of each individual.
        level: one of `LEVELS`.
        weights: of each choice; zero holds it out.
        starts: points from which the fit of the group sets out.
        seed: of those that are drawn.
        errors: work out standard errors.

    Returns:
        the fits, and the parameters of each individual as vectors.
    """
    if level not in LEVELS:
        raise CogmapError(f"fit: level is {level!r}; use one of {', '.join(LEVELS)}")
    group, values = fit(model, prepared, weights=weights, starts=starts, seed=seed, errors=errors)
    spread = np.array([parameter.spread for parameter in model.parameters])
    around = Around(values, spread) if level == "hierarchical" else None
    fits, found = list[Fit](), list[Floats]()
    for i, one in enumerate(prepared):
        own = None if weights is None else [weights[i]]
        if level == "pooled" or len(prepared) == 1 or not (len(one.choices) if own is None else own[0].any()):
            fits.append(group)
            found.append(values)
        else:
            single, theirs = fit(model, [one], weights=own, starts=1, around=around, begin=values, errors=errors)
            fits.append(single)
            found.append(theirs)
    return GroupFit(group, tuple(fits)), found


def held_out(
    model: ChoiceModel,
    prepared: Sequence[Prepared],
    fold: int,
    folds: Sequence[NDArray[np.int64]],
    *,
    level: str = LEVELS[0],
    starts: int = 1,
    seed: int = 0,
) -> list[Floats]:
    """`[C]` of each individual: log P of the choices of one fold under parameters from the rest; else NaN."""
    weights = [(numbers != fold).astype(np.float64) for numbers in folds]
    if not any(w.any() for w in weights):  # all choices are in one fold
        weights = [np.ones(len(numbers)) for numbers in folds]
    _, values = fit_group(model, prepared, level=level, weights=weights, starts=starts, seed=seed, errors=False)
    found: list[Floats] = []
    for one, own, numbers in zip(prepared, values, folds, strict=True):
        nats, _ = model.log_likelihood(one, own)
        found.append(np.where(numbers == fold, nats, np.nan))
    return found
