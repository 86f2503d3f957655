"""What a clone-structured model believes about rooms, for an experimenter who knows the true ones."""

from collections.abc import Sequence

import numpy as np

from ...worlds import WorldError
from .model import CloneModel, Floats
from .sequence import Ints


def room_transitions(
    model: CloneModel, path: Ints, rooms: Sequence[int] | Ints, n: int, *, named: bool = False
) -> Floats:
    """P(next room | room, action) as B[next room, previous room, action], `[n, n, K]`.

    B[r', r, a] = sum over z of P(z | r) sum over z' of P(z' | z, a) P(r' | z'), where both P(r | z) and
    P(z | r) are shares of the T visits of the decoded path: of the visits of state z those spent in room r, and of
    the visits of room r those decoded as z. What is expected in states that were never decoded counts for no room,
    so a column can sum to less than 1; a room never visited has a column of zeros.

    Args:
        model: the model.
        path: `[T]` the decoded state of each step.
        rooms: `[T]` or longer, the true room, 0 to n - 1, of each step.
        n: how many rooms there are.
        named: a sight is met in one room only and so names it: each clone of a sight, decoded or not, counts for
            the room where that sight was met.

    Raises:
        WorldError: fewer rooms than steps, or a room that is not there.
    """
    visits = _visits(model, path, rooms, n)
    in_room = _shares(_pooled(model, visits) if named else visits)
    per_state = _next_rooms(model, in_room)
    return np.einsum("zr,zaq->qra", _shares(visits.T).T, per_state, optimize=True)


def _visits(model: CloneModel, path: Ints, rooms: Sequence[int] | Ints, n: int) -> Floats:
    """`[S, n]` how often each state was decoded in each room."""
    true = np.asarray(rooms, dtype=np.int64)
    if true.ndim != 1 or len(true) < len(path):
        raise WorldError(f"give the true room of each of the {len(path)} steps learned from; got {len(true)}")
    if true.size and (true.min() < 0 or true.max() >= n):
        raise WorldError(f"rooms are numbered from 0 to {n - 1}; got {true.min()} to {true.max()}")
    return np.bincount(path * n + true[: len(path)], minlength=model.states * n).astype(float).reshape(model.states, n)


def _pooled(model: CloneModel, visits: Floats) -> Floats:
    """`[S, n]` the visits of each sight, alike for all its clones."""
    return np.repeat(visits.reshape(model.observations, model.clones, -1).sum(axis=1), model.clones, axis=0)


def _shares(table: Floats) -> Floats:
    """Rows divided by their sums; zeros stay."""
    total = table.sum(axis=1, keepdims=True)
    return np.divide(table, total, out=np.zeros_like(table), where=total > 0.0)


def _next_rooms(model: CloneModel, in_room: Floats) -> Floats:
    """`[S, K, n]` P(next room | state, action)."""
    n, c = in_room.shape[1], model.clones
    outside = np.einsum("oac,r->oacr", model.background, in_room.sum(axis=0))
    sights, actions, after = model.triples.rows.T
    excess = model.blocks - model.background[sights, actions, :, None]
    np.add.at(outside, (sights, actions), excess @ in_room.reshape(-1, c, n)[after])
    return outside.transpose(0, 2, 1, 3).reshape(model.states, model.actions, n)
