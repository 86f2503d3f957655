"""Local models for the planning tests: random tables, and grids partly visited."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from cogmap.model import Motions, dirichlet_information
from cogmap.planning import LocalModel, Transitions

GRID = Motions(("up", "down", "left", "right", "stay"), ((-1, 0), (1, 0), (0, -1), (0, 1), (0, 0)))
LINE = Motions(("back", "on", "stay"), ((-1,), (1,), (0,)))


def random_model(
    seed: int,
    *,
    motions: Motions = GRID,
    places: int = 5,
    sights: int = 4,
    look_ahead: int = 3,
    sparse: bool = False,
) -> LocalModel:
    """Nothing but the shapes and the sums is as in a map; `sparse` makes B and the belief one-hot."""
    rng = np.random.default_rng(seed)
    kinds, steps = len(motions), look_ahead + int(rng.integers(0, 3))
    if sparse:
        B = np.zeros((places, places, kinds))
        target = rng.integers(0, places, (places, kinds))
        np.put_along_axis(B, target[None], 1.0, axis=0)
        belief = np.eye(places)[rng.integers(places)]
        A = np.eye(sights)[rng.integers(0, sights, places)].T
    else:
        B = np.moveaxis(rng.dirichlet(np.full(places, 0.3), (places, kinds)), -1, 0)
        belief = rng.dirichlet(np.full(places, 0.5))
        A = rng.dirichlet(np.full(sights, 0.5), places).T
    blocked = rng.random((places, kinds))
    blocked[:, motions.stay] = 0.0
    senses = tuple(rng.dirichlet(np.full(3, 0.5), places).T for _ in range(int(rng.integers(3))))
    untried = rng.random((places, kinds)) * (rng.random((places, kinds)) < 0.4) if seed % 2 else None
    if untried is not None:
        untried[:, motions.stay] = 0.0
    return LocalModel(
        motions=motions,
        look_ahead=look_ahead,
        untried=untried,
        places=np.arange(places) + 7,
        belief=belief,
        A=np.ascontiguousarray(A),
        multiplicity=np.where(rng.random(sights) < 0.5, 1.0, rng.integers(1, 2000, sights)),
        log_C=rng.normal(size=sights) * rng.choice([0.0, 3.0]),
        log_C_place=rng.normal(size=places) * rng.choice([0.0, 2.0]),
        B=Transitions.of(B),
        blocked=blocked,
        collision_cost=float(rng.random() * 5),
        information={
            "sight": dirichlet_information(rng.random((places, 4)) + 1e-3, steps),
            "position": dirichlet_information(rng.random((places, 3)) + 1e-3, steps),
            "transition": dirichlet_information(rng.random((places, kinds, 3)) + 1e-3, steps).sum(axis=1),
        },
        successor=rng.integers(-1, places, (places, kinds)),
        entered=rng.random(places) < 0.6,
        senses=senses,
        looks=bool(rng.random() < 0.5),
        costs=rng.random(kinds) if rng.random() < 0.5 else None,
        position=np.where(
            rng.random((places, 1)) < 0.8, rng.normal(size=(places, len(motions.displacements[0]))), np.nan
        ),
        discount=float(rng.choice([1.0, 0.9])),
        information_weight=float(rng.choice([0.0, 1.0, 2.5])),
    )


def grid_model(
    rooms: Iterable[tuple[int, int]],
    *,
    visited: Iterable[tuple[int, int]],
    at: tuple[int, int],
    look_ahead: int = 6,
    closed: Iterable[tuple[tuple[int, int], tuple[int, int]]] = (),
    goal: tuple[int, int] | None = None,
) -> LocalModel:
    """A map of grid rooms: visited ones have a sight of their own, others any of 1000; known ways are open."""
    rooms, visited = list(rooms), set(visited)
    index = {room: i for i, room in enumerate(rooms)}
    shut = {frozenset(pair) for pair in closed}
    R, K = len(rooms), len(GRID)
    successor, blocked = np.full((R, K), -1), np.zeros((R, K))
    B = np.full((R, R, K), 1e-3)
    for room, i in index.items():
        for a in range(K):
            to = GRID.move(room, a)
            known = to in index and frozenset((room, to)) not in shut and (room in visited or to in visited)
            if known:
                successor[i, a] = index[to]
            blocked[i, a] = 0.05 if known else 0.95 if room in visited else 0.5
            B[index[to] if known else i, i, a] += 1.0
    blocked[:, GRID.stay] = 0.0
    A = np.full((R + 1, R), 1e-4)
    alpha = np.full((R, 2), [1.0, 1e-3])
    for room, i in index.items():
        A[i if room in visited else R, i] = 1.0
        alpha[i] = [3.0, 1e-6] if room in visited else [1e-6, 1e-6]
    look = max(look_ahead, 1)
    sight = dirichlet_information(alpha, look, multiplicity=[1.0, 1000.0])
    log_C = np.zeros(R + 1)
    if goal is not None:
        log_C[index[goal]] = 3.0
    return LocalModel(
        motions=GRID,
        look_ahead=look_ahead,
        places=np.arange(R),
        belief=np.eye(R)[index[at]],
        A=A / A.sum(0),
        multiplicity=np.append(np.ones(R), 1000.0),
        log_C=log_C,
        log_C_place=np.zeros(R),
        B=Transitions.of(B / B.sum(0)),
        blocked=blocked,
        collision_cost=1.0,
        information={
            "sight": sight,
            "position": np.zeros((R, look + 1)),
            "transition": dirichlet_information(np.full((R, K, 2), [5.0, 0.1]), look).sum(axis=1),
        },
        successor=successor,
        entered=np.array([room in visited for room in rooms]),
        position=np.array(rooms, dtype=np.float64),
    )
