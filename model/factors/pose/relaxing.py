"""Positions that go best with what was measured between them: weighted least squares over the ways that were walked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

AXES = 3

DRIFTING, TURNS = 0.08, 4
"""Radians that a heading drifts by from one measurement to the next; and how often both are improved in turn."""


@dataclass(frozen=True, slots=True)
class Measured:
    """What was measured between places.

    Attributes:
        ends: `[E, 2]` the two places of each measurement.
        moved: `[E, 3]` how far the second lies from the first.
        along, across: `[E]` standard deviations of that, in the direction of the move and square to it.
    """

    ends: Ints
    moved: Floats
    along: Floats
    across: Floats

    def among(self, chosen: NDArray[np.bool_]) -> Measured:
        """These measurements alone."""
        return Measured(self.ends[chosen], self.moved[chosen], self.along[chosen], self.across[chosen])

    @property
    def precision(self) -> Floats:
        """`[E, 3, 3]` the inverse covariance of each."""
        flat = self.moved[:, :2]
        u = flat / np.maximum(np.linalg.norm(flat, axis=1), 1e-12)[:, None]
        along, across = 1.0 / np.square(self.along), 1.0 / np.square(self.across)
        found = np.zeros((len(u), AXES, AXES))
        found[:, :2, :2] = across[:, None, None] * np.eye(2) + (along - across)[:, None, None] * (
            u[:, :, None] * u[:, None]
        )
        found[:, 2, 2] = along
        return found


def relaxed(where: Floats, measured: Measured, free: Ints) -> Floats:
    """`[n, 3]` where the places `free` lie if all others stay where they are: the most probable positions.

    Args:
        where: `[S, 3]` where places are thought to be now.
        measured: between places; what is between two others that stay is ignored.
        free: `[n]` ascending.
    """
    at = np.searchsorted(free, measured.ends)
    at[at == len(free)] = 0
    inside = free[at] == measured.ends
    some = inside.any(axis=1)
    measured, at, inside = measured.among(some), at[some], inside[some]
    first, second = measured.ends.T
    precision = measured.precision
    off = np.einsum("eij,ej->ei", precision, measured.moved - (where[second] - where[first]))
    pull = np.zeros((len(free), AXES))
    np.add.at(pull, at[inside[:, 1], 1], off[inside[:, 1]])
    np.add.at(pull, at[inside[:, 0], 0], -off[inside[:, 0]])
    blocks = [
        (at[inside[:, a] & inside[:, b], a], at[inside[:, a] & inside[:, b], b], (1.0 if a == b else -1.0), a, b)
        for a in (0, 1)
        for b in (0, 1)
    ]
    from scipy.sparse import coo_array  # slow to import, and only needed in metric maps
    from scipy.sparse.linalg import spsolve

    axes = np.arange(AXES)
    row = np.concatenate([(i[:, None, None] * AXES + axes[:, None] + 0 * axes).ravel() for i, _, _, _, _ in blocks])
    column = np.concatenate([(j[:, None, None] * AXES + 0 * axes[:, None] + axes).ravel() for _, j, _, _, _ in blocks])
    value = np.concatenate([(sign * precision[inside[:, a] & inside[:, b]]).ravel() for _, _, sign, a, b in blocks])
    size = AXES * len(free)
    slight = 1e-12 * float(np.abs(value).max(initial=1.0))
    hold = np.arange(size)  # who is tied to nobody stays
    matrix = coo_array(
        (np.append(value, np.full(size, slight)), (np.append(row, hold), np.append(column, hold))), shape=(size, size)
    )
    return where[free] + np.asarray(spsolve(matrix.tocsc(), pull.ravel())).reshape(-1, AXES)


def straightened(where: Floats, measured: Measured, heading: Floats, free: Ints) -> tuple[Floats, Floats]:
    """The same of an agent whose heading drifts: positions `[n, 3]`, and how far it was turned `[E]`, in radians.

    Measurements are in the order in which they were made, each in the frame that the agent then took for right.
    Positions and headings are improved in turn: a heading is a random walk from zero, seen from where places lie.

    Args:
        where, measured, free: as for `relaxed`.
        heading: `[E]` what was thought of the headings so far.
    """
    from scipy.linalg import solveh_banded  # slow to import

    found, heading = where.copy(), heading.copy()
    raw = measured.moved[:, 0] + 1j * measured.moved[:, 1]
    ends = measured.ends
    seen = np.square(np.abs(raw) / measured.across)  # of an angle, its precision
    steps = np.full(len(raw), 1.0 / DRIFTING**2)
    bands = np.zeros((2, len(raw)))
    bands[0, 1:], bands[1] = -steps[1:], seen + steps + np.append(steps[1:], 0.0)
    for _ in range(TURNS):
        turned = raw * np.exp(1j * heading)
        moved = np.stack([turned.real, turned.imag, measured.moved[:, 2]], axis=1)
        found[free] = relaxed(found, Measured(ends, moved, measured.along, measured.across), free)
        across = (found[ends[:, 1]] - found[ends[:, 0]]) @ np.array([1.0, 1j, 0.0])
        heading = solveh_banded(bands, seen * (heading + np.angle(across * np.conj(turned))))
    return found[free], heading


def drift(measured: Measured, source: int, places: Ints, size: int) -> Floats:
    """`[n]` standard deviation, along each axis, of where places lie from `source`: at most what the best way has.

    Variances add up along the ways that were walked; infinite where none leads.
    """
    return np.sqrt(_shortest(measured, np.square(measured.along), source, size)[places])


def path_length(measured: Measured, source: int, places: Ints, size: int) -> Floats:
    """`[n]` how long the shortest way from `source` along measured ones is; infinite where none leads."""
    return _shortest(measured, np.linalg.norm(measured.moved, axis=1), source, size)[places]


def around(measured: Measured, ends: Ints, most: int, size: int) -> Ints:
    """The places nearest to `ends` by steps along measured ways, `most` or fewer, ascending."""
    steps = _shortest(measured, np.ones(len(measured.ends)), ends, size, unweighted=True, min_only=True)
    order = np.argsort(steps, kind="stable")[:most]
    return np.sort(order[np.isfinite(steps[order])])


def _shortest(measured: Measured, length: Floats, source: int | Ints, size: int, **options: bool) -> Floats:
    """What the shortest ways from `source` add up to; `length` is that of each measured one."""
    from scipy.sparse import csr_array  # slow to import, and only needed in metric maps
    from scipy.sparse.csgraph import dijkstra

    graph = csr_array((length, tuple(measured.ends.T)), shape=(size, size))
    return dijkstra(graph, directed=False, indices=source, **options)
