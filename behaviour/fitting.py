"""Maximum likelihood and maximum a posteriori: parameters from choices, with standard errors."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..model import CogmapError, Floats
from .models import ChoiceModel, Prepared

STARTS = 3  # points from which a fit sets out, unless told otherwise
_STEP = 1e-4  # of the differences that make the Hessian, as a share of the width of a parameter's typical range
_EDGE = 1e-6  # of this width: a parameter so near to a bound is at it
_OPTIONS = {"maxiter": 300, "maxcor": 30, "ftol": 1e-9, "gtol": 1e-6}


@dataclass(frozen=True)
class Fit:
    """The result of a fit."""

    model: str  # the name of the model
    parameters: dict[str, float]  # by name
    # by name, from the Hessian; None of a parameter at its bound, or where the Hessian has none
    standard_errors: dict[str, float | None]
    log_likelihood: float  # of all choices fitted, in nats, without the prior
    choices: int  # how many
    bic: float  # k log n - 2 log likelihood
    converged: bool  # whether the optimiser says so


@dataclass(frozen=True, slots=True)
class Around:
    """A normal prior around the group's parameters, for hierarchical fits."""

    mean: Floats
    spread: Floats

    def __call__(self, values: Floats) -> tuple[float, Floats]:
        """Nats, up to a constant, and their derivatives."""
        away = (values - self.mean) / self.spread
        return -0.5 * float(away @ away), -away / self.spread


Weights = Sequence[Floats]  # `[C]` of each individual: how much each choice counts; zero holds it out


def fit(
    model: ChoiceModel,
    prepared: Sequence[Prepared],
    *,
    weights: Weights | None = None,
    starts: int = STARTS,
    seed: int = 0,
    around: Around | None = None,
    begin: Floats | None = None,
    prior: bool = True,
    errors: bool = True,
) -> tuple[Fit, Floats]:
    """The parameters under which choices are most probable.

    By L-BFGS-B within the bounds, with exact derivatives, from `begin` or the model's own start and from points drawn
    between typical values; the best of them is the answer.

    Args:
        model: the model.
        prepared: choices of one individual or more, as the model prepared them, all under the same parameters.
        weights: of each choice; 1 unless given.
        starts: points to set out from.
        seed: of the points that are drawn.
        around: a normal prior besides, such as that of the group.
        begin: the first point.
        prior: maximum a posteriori with the terms' priors (Dirichlet counts of habits), else maximum likelihood.
        errors: work out standard errors.

    Returns:
        the fit, and its parameters as a vector.

    Raises:
        CogmapError: no choices to fit, or `starts` below 1.
    """
    weights = [np.ones(len(one.choices)) for one in prepared] if weights is None else weights
    count = round(sum(float(w.sum()) for w in weights))
    if not count:
        raise CogmapError("fit: there are no choices; give walks through places with three ways or more")
    if starts < 1:
        raise CogmapError(f"fit: starts is {starts}; use 1 or more")

    def objective(values: Floats) -> tuple[float, Floats]:
        nats, slope = _log_likelihood(model, prepared, weights, values)
        for given in (model.log_prior if prior else None, around):
            if given is not None:
                more, by = given(values)
                nats, slope = nats + more, slope + by
        return -nats / count, -slope / count

    values, converged = _minimum(model, objective, starts, seed, begin)
    nats, _ = _log_likelihood(model, prepared, weights, values)
    parameters = model.parameters
    missing: list[float | None] = [None] * len(parameters)
    sure = _errors(model, objective, values, count) if errors else missing
    named = {p.name: float(v) for p, v in zip(parameters, values, strict=True)}
    bic = len(parameters) * float(np.log(count)) - 2.0 * nats
    spread = dict(zip(named, sure, strict=True))
    return Fit(model.name, named, spread, nats, count, bic, converged), values


def _log_likelihood(
    model: ChoiceModel, prepared: Sequence[Prepared], weights: Weights, values: Floats
) -> tuple[float, Floats]:
    nats, slope = 0.0, np.zeros(len(values))
    for one, weight in zip(prepared, weights, strict=True):
        if weight.any():
            found, by = model.log_likelihood(one, values)
            nats += float(weight @ found)
            slope += weight @ by
    return nats, slope


def _minimum(model: ChoiceModel, objective: Any, starts: int, seed: int, begin: Floats | None) -> tuple[Floats, bool]:
    from scipy.optimize import minimize

    parameters, rng = model.parameters, np.random.default_rng(seed)
    if not parameters:
        return np.zeros(0), True
    points = [model.values() if begin is None else begin]
    points += [np.array([rng.uniform(*p.typical) for p in parameters]) for _ in range(starts - 1)]
    width = _widths(model)  # so that one unit means as much of each parameter
    bounds = [(p.low / w, p.high / w) for p, w in zip(parameters, width.tolist(), strict=True)]

    def scaled(point: Floats) -> tuple[float, Floats]:
        nats, slope = objective(point * width)
        return nats, slope * width

    best: Any = None
    for point in points:
        found: Any = minimize(scaled, point / width, jac=True, method="L-BFGS-B", bounds=bounds, options=_OPTIONS)
        if best is None or found.fun < best.fun - 1e-9:
            best = found
    low, high = np.array([(p.low, p.high) for p in parameters]).T
    return np.clip(best.x * width, low, high), bool(best.success)


def _widths(model: ChoiceModel) -> Floats:
    return np.array([p.typical[1] - p.typical[0] for p in model.parameters])


def _errors(model: ChoiceModel, objective: Any, values: Floats, count: int) -> list[float | None]:
    """From the inverse Hessian over the parameters that are not at a bound."""
    width = _widths(model)
    low, high = np.array([(p.low, p.high) for p in model.parameters]).reshape(-1, 2).T
    free = np.flatnonzero((values > low + _EDGE * width) & (values < high - _EDGE * width))
    found: list[float | None] = [None] * len(values)
    hessian = np.empty((len(free), len(free)))
    for row, i in enumerate(free.tolist()):
        step = min(_STEP * float(width[i]), float(values[i] - low[i]), float(high[i] - values[i]))
        slopes: list[Floats] = []
        for sign in (1.0, -1.0):
            moved = values.copy()
            moved[i] += sign * step
            slopes.append(objective(moved)[1])
        hessian[row] = count * (slopes[0] - slopes[1])[free] / (2.0 * step)
    try:
        variance = np.diag(np.linalg.inv((hessian + hessian.T) / 2.0))
    except np.linalg.LinAlgError:
        return found
    for i, v in zip(free.tolist(), variance.tolist(), strict=True):
        found[i] = float(np.sqrt(v)) if v > 0.0 else None
    return found
