"""Where the walk led: posterior marginals, pairs, evidence, and the belief about now."""

from dataclasses import dataclass

import numpy as np

from ...worlds import WorldError
from .model import CloneModel, Floats
from .sequence import Walk


@dataclass(frozen=True, slots=True)
class Posterior:
    """What is believed about every step of a walk, given all of it."""

    marginals: Floats  # `[T, c]` P(clone at t | walk), of the clones of the sight seen at t
    pairs: Floats  # `[T - 1, c, c]` P(clone at t, clone at t + 1 | walk)
    log_likelihood: float  # log P(sights | actions), nats


def posterior(model: CloneModel, walk: Walk) -> Posterior:
    """Smooth a walk by forward and backward messages (Rabiner 1989, eqs. 19 to 37).

    Raises:
        WorldError: the walk has more sights or actions than the model, or probability 0 under it.
    """
    forward, log_likelihood = _filtered(model, walk)
    model = model.covering(walk)
    blocks = model.blocks[model.triples.steps(walk)]
    backward = np.ones_like(forward)
    for t in range(len(blocks) - 1, -1, -1):
        backward[t] = blocks[t] @ backward[t + 1]
        backward[t] /= backward[t].max()
    pairs = forward[:-1, :, None] * blocks * backward[1:, None, :]
    marginals = forward * backward
    return Posterior(
        marginals / marginals.sum(axis=1, keepdims=True), pairs / pairs.sum(axis=(1, 2), keepdims=True), log_likelihood
    )


def log_likelihood(model: CloneModel, walk: Walk) -> float:
    """log P(sights | actions), nats; minus infinity where it is impossible.

    Raises:
        WorldError: the walk has more sights or actions than the model.
    """
    try:
        return _filtered(model, walk)[1]
    except _ImpossibleError:
        return -np.inf


def filtered(model: CloneModel, walk: Walk) -> Floats:
    """`[T, c]` P(clone at t | the walk up to t), of the clones of the sight seen at t.

    Raises:
        WorldError: the walk has more sights or actions than the model, or probability 0 under it.
    """
    return _filtered(model, walk)[0]


def followed(model: CloneModel, belief: Floats, *, sight: int, action: int, after: int) -> Floats:
    """`[c]` the belief about the clones of sight `after`, once `action` has led there from `sight`.

    Uniform where the model holds that impossible.
    """
    row = model.triples.number.get((sight, action, after))
    if row is None:  # every clone alike: nothing told them apart
        return np.full(model.clones, 1 / model.clones)
    ahead = belief @ model.blocks[row]
    total = ahead.sum()
    return ahead / total if total > 0.0 else np.full(model.clones, 1 / model.clones)


class _ImpossibleError(WorldError):
    """The walk has probability 0."""


def _filtered(model: CloneModel, walk: Walk) -> tuple[Floats, float]:
    model = model.covering(walk)
    which = model.triples.steps(walk)
    forward = np.full((len(walk), model.clones), 1 / model.clones)
    scales = np.empty(len(which))
    for t, block in enumerate(model.blocks[which]):
        ahead = forward[t] @ block
        scales[t] = ahead.sum()
        if scales[t] <= 0.0:
            raise _ImpossibleError(f"the model gives step {t} of the walk probability 0; use a positive pseudocount")
        np.divide(ahead, scales[t], out=forward[t + 1])
    return forward, float(np.log(scales).sum()) - float(np.log(model.observations))
