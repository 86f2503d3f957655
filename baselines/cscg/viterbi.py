"""The most probable path (Viterbi 1967), and training on it alone."""

from dataclasses import dataclass, replace

import numpy as np

from .learning import log_prior
from .model import CloneModel, Floats
from .sequence import Ints, Walk


@dataclass(frozen=True, slots=True)
class HardFit:
    """What Viterbi training found."""

    model: CloneModel  # with the transitions of the path as its counts
    path: Ints  # `[T]` the most probable states under the model of the last iteration, the ones that were counted
    objective: Floats  # `[n]` log P(path, sights | actions) + `log_prior` before each iteration, nats; never falls
    converged: bool  # whether it stopped because the path no longer changed


def most_probable_path(model: CloneModel, walk: Walk) -> tuple[Ints, float]:
    """`[T]` the states of the most probable path, and log P(path, sights | actions), nats.

    Raises:
        WorldError: the walk has more sights or actions than the model.
    """
    model = model.covering(walk)
    clones, value = _decode(model, model.triples.steps(walk))
    return walk.sights * model.clones + clones, value - float(np.log(model.states))


def viterbi_training(model: CloneModel, walk: Walk, *, iterations: int) -> HardFit:
    """Count the transitions of the most probable path, decode again, until the path stays the same.

    Args:
        model: where to start.
        walk: the history.
        iterations: at most so many decodings, 1 or more.

    Raises:
        WorldError: the walk has more sights or actions than the model.
    """
    model = model.covering(walk)
    which, offset = model.triples.steps(walk), float(np.log(model.states))
    values: list[float] = []
    path: Ints | None = None
    converged = False
    while path is None or (len(values) < iterations and not converged):
        clones, value = _decode(model, which)
        values.append(value - offset + log_prior(model))
        converged = path is not None and np.array_equal(clones, path)
        path = clones
        model = replace(model, counts=_counted(model, which, clones))
    return HardFit(model, walk.sights * model.clones + path, np.array(values), converged)


def _counted(model: CloneModel, which: Ints, clones: Ints) -> Floats:
    """`[N, c, c]` how often the path makes each transition."""
    c = model.clones
    flat = (which * c + clones[:-1]) * c + clones[1:]
    return np.bincount(flat, minlength=model.counts.size).astype(np.float64).reshape(model.counts.shape)


def _decode(model: CloneModel, which: Ints) -> tuple[Ints, float]:
    """`[T]` the clones of the most probable path and the log of its transitions, the first state apart."""
    with np.errstate(divide="ignore"):
        steps = np.log(model.blocks)[which]
    scores = np.zeros((len(which) + 1, model.clones))
    for step, before, after in zip(steps, scores[:, :, None], scores[1:], strict=False):
        np.add(step, before, out=step)
        np.maximum.reduce(step, axis=0, out=after)
    clones = np.empty(len(scores), dtype=np.int64)
    clones[-1] = clone = int(scores[-1].argmax())
    sources = steps.argmax(axis=1).tolist()
    for t in range(len(which) - 1, -1, -1):
        clones[t] = clone = sources[t][clone]
    return clones, float(scores[-1].max())
