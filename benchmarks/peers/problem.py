"""The problem that every library gets: a grid of places, sights that repeat, and a list of policies."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Arrays = dict[str, NDArray[np.generic]]

NAMES = ("stay", "up", "down", "left", "right")
MOVES = ((0, 0), (-1, 0), (1, 0), (0, -1), (0, 1))
"""`stay` comes first, for pymdp 0.0.7.1 takes the largest action among the policies for the last there is."""

SLIP = 0.1
SHARED = 4


def grid_problem(side: int, length: int, seed: int = 0) -> Arrays:
    """A model of `side` by `side` places, what was done and seen last, and the policies to compare.

    Returns:
        `A` `[O, S]`, each sight in about `SHARED` places; `B` `[S, S, 5]`, every move fails with probability `SLIP`,
        and at the edge; `log_C` `[O]`, sums to one in probability; `D` `[S]`, nearly even; `action` and `sight`, taken
        and seen since D; `policies` `[P, length]`, the self-avoiding walks of that length.
    """
    rng = np.random.default_rng(seed)
    places = side * side
    sights = rng.permutation(np.arange(places) // SHARED)
    wanted = rng.normal(size=places // SHARED)
    prior = 1.0 + 0.2 * rng.random(places)
    A = np.zeros((places // SHARED, places))
    A[sights, np.arange(places)] = 1.0
    return {
        "A": A,
        "B": _transitions(side),
        "log_C": wanted - np.log(np.exp(wanted).sum()),
        "D": prior / prior.sum(),
        "action": np.array(4),
        "sight": np.array(sights[places // 2 + side // 2]),
        "policies": np.array(_walks(length)),
    }


def _transitions(side: int) -> NDArray[np.float64]:
    B = np.zeros((side * side, side * side, len(MOVES)))
    for row, column in np.ndindex(side, side):
        here = row * side + column
        for action, (down, right) in enumerate(MOVES):
            inside = 0 <= row + down < side and 0 <= column + right < side
            there = here + down * side + right if inside else here
            B[there, here, action] += 1.0 - SLIP
            B[here, here, action] += SLIP
    return B


def _walks(length: int) -> list[tuple[int, ...]]:
    """Self-avoiding walks in the plane, as actions."""
    walks: list[tuple[tuple[int, ...], tuple[tuple[int, int], ...]]] = [((), ((0, 0),))]
    for _ in range(length):
        longer = []
        for actions, track in walks:
            for action, (down, right) in enumerate(MOVES[1:], start=1):
                place = (track[-1][0] + down, track[-1][1] + right)
                if place not in track:
                    longer.append(((*actions, action), (*track, place)))
        walks = longer
    return [actions for actions, _ in walks]


def read_problem(path: str | Path) -> Arrays:
    """The arrays in the file."""
    with np.load(path) as file:
        return {name: file[name] for name in file.files}
