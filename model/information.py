"""What n more observations would teach about a categorical distribution held as a Dirichlet."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Floats
from .errors import CogmapError

FEW = 16  # rows up to which each is looked up


def dirichlet_information(alpha: ArrayLike, steps: int, *, multiplicity: ArrayLike | None = None) -> Floats:
    """Mutual information between theta ~ Dir(alpha) and n draws from Cat(theta), for n = 0..steps.

    By the chain rule draw n + 1 adds the expected information of one draw given the counts k of the
    first n. With X = alpha_0 + n and phi(x) = x (psi(x + 1) - ln x) that is

        I_{n+1} - I_n = sum_i E_k[phi(alpha_i + k)] / X - phi(X) / X

    where k, the count of outcome i, is beta-binomial. At n = 0 this is the parameter information gain
    -sum_i (alpha_i/alpha_0) [ln(alpha_i/alpha_0) - psi(alpha_i + 1) + psi(alpha_0 + 1)] of eq. 8.

    Args:
        alpha: `[..., O]` concentrations, not negative; a zero entry is an outcome that cannot happen.
        steps: N, the largest number of draws.
        multiplicity: `[..., O]` (broadcast) outcomes that an entry stands for, each with that alpha.

    Returns:
        `[..., N + 1]` nats; grows with n, ever more slowly; column 0 is zero.

    Raises:
        CogmapError: negative or non-finite input, a row without mass, or `steps` below zero.
    """
    alpha, weight = _checked(alpha, multiplicity, steps)
    total = (weight * alpha).sum(-1, keepdims=True)
    if not (total > 0.0).all():
        raise CogmapError("dirichlet_information: a row of alpha has no mass; give it a positive entry")
    information = np.zeros((*alpha.shape[:-1], steps + 1))
    if steps == 0:
        return information
    # the count k comes first, so that the counts possible after n draws are one contiguous block
    concentration = alpha + _counts(steps, alpha.ndim)
    mass = total + _counts(steps, alpha.ndim)
    value = weight * _phi(concentration)
    whole = _phi(mass)[..., 0]
    urn = np.zeros_like(concentration)
    urn[0] = 1.0
    for n in range(steps):
        expected = np.einsum("k...o,k...o->...", urn[: n + 1], value[: n + 1])
        information[..., n + 1] = np.maximum(expected - whole[n], 0.0) / mass[n, ..., 0]
        if n + 1 < steps:
            drawn = urn[: n + 1] * (concentration[: n + 1] / mass[n])
            urn[: n + 1] -= drawn
            urn[1 : n + 2] += drawn
    return np.cumsum(information, axis=-1)


class KnownInformation:
    """`dirichlet_information` of rows that were met before is looked up; what is kept takes `most` bytes or so.

    Args:
        most: bytes; when they are full, the older half is forgotten.
    """

    __slots__ = ("_known", "_size", "most")

    def __init__(self, most: int = 2**20) -> None:
        self.most = most
        self._known: dict[tuple[bytes, int], Floats] = {}
        self._size = 0

    def __call__(self, alpha: Floats, steps: int, multiplicity: Floats | None = None) -> Floats:
        """`[..., N + 1]` nats of `[..., O]` concentrations and their multiplicities."""
        outcomes = alpha.shape[-1]
        if outcomes == 1 and multiplicity is None:  # one outcome teaches nothing
            return np.zeros((*alpha.shape[:-1], steps + 1))
        many = np.ones_like(alpha) if multiplicity is None else multiplicity
        rows = np.concatenate([alpha, many], axis=-1).reshape(-1, 2 * outcomes)
        first = np.ones(len(rows), dtype=np.bool_)
        if len(rows) > FEW:  # of a long list most are as the one before
            first[1:] = (rows[1:] != rows[:-1]).any(axis=1)
        packed, width = rows[first].tobytes(), 16 * outcomes
        table = np.array([self._row(packed[i : i + width], steps) for i in range(0, len(packed), width)])
        return table.reshape(-1, steps + 1)[first.cumsum() - 1].reshape(*alpha.shape[:-1], steps + 1)

    def __deepcopy__(self, memo: object) -> KnownInformation:
        return KnownInformation(self.most)  # what it knows is no part of what a model believes

    def _row(self, packed: bytes, steps: int) -> Floats:
        found = self._known.get((packed, steps))
        if found is None:
            found = self._known[packed, steps] = _row_information(packed, steps)
            self._size += _size(packed, found)
            if self._size > self.most:
                self._forget()
        return found

    def _forget(self) -> None:
        for key in list(self._known)[: len(self._known) // 2 + 1]:
            self._size -= _size(key[0], self._known.pop(key))


def _size(packed: bytes, row: Floats) -> int:
    """Bytes that a row takes with its key."""
    return len(packed) + row.nbytes + 300


def _row_information(packed: bytes, steps: int) -> Floats:
    """One row: its concentrations, then their multiplicities."""
    both = np.frombuffer(packed).reshape(2, -1)
    alpha, many = both[:, both[0] > 0.0]  # to the bit the same, however many slots are unused
    if many.sum() <= 1.0:  # one outcome teaches nothing
        return np.zeros(steps + 1)
    return dirichlet_information(alpha, steps, multiplicity=many)


def _checked(alpha: ArrayLike, multiplicity: ArrayLike | None, steps: int) -> tuple[Floats, Floats]:
    alpha = np.asarray(alpha, dtype=np.float64)
    weight = np.ones(1) if multiplicity is None else np.asarray(multiplicity, dtype=np.float64)
    if steps < 0:
        raise CogmapError(f"dirichlet_information: steps is {steps}; give 0 or more")
    if alpha.ndim == 0 or alpha.shape[-1] == 0:
        raise CogmapError("dirichlet_information: alpha has no outcomes; give [..., O] concentrations")
    for name, array in (("alpha", alpha), ("multiplicity", weight)):
        if not (np.isfinite(array).all() and (array >= 0.0).all()):
            raise CogmapError(f"dirichlet_information: {name} must be finite and not negative")
    try:
        alpha, weight = np.broadcast_arrays(alpha, weight)
    except ValueError as error:
        raise CogmapError(
            f"dirichlet_information: multiplicity {weight.shape} does not fit alpha {alpha.shape}"
        ) from error
    return alpha, weight


def _counts(steps: int, dimensions: int) -> Floats:
    """0..steps-1 along a new first axis."""
    return np.arange(steps, dtype=np.float64).reshape(steps, *([1] * dimensions))


def _phi(x: Floats) -> Floats:
    """x (psi(x + 1) - ln x) where `x[k] = x[0] + k`; zero at zero."""
    from scipy.special import digamma  # slow to import, and only needed here

    psi = np.empty_like(x)
    psi[0] = digamma(x[0] + 1.0)
    np.reciprocal(x[1:], out=psi[1:])
    np.cumsum(psi, axis=0, out=psi)
    return x * (psi - np.log(np.maximum(x, np.finfo(np.float64).tiny)))
