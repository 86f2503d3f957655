"""Learning the counts of a walk by expectation maximisation (Baum et al. 1970)."""

from dataclasses import dataclass, replace

import numpy as np

from .messages import Messages
from .model import CloneModel, Floats
from .sequence import Ints, Walk

PIECE = 8  # steps of one triple that are summed in one product


@dataclass(frozen=True, slots=True)
class Fit:
    """What expectation maximisation found.

    With n iterations made, entry i belongs to the model before iteration i + 1, so the last one is that of the model
    before the one returned.
    """

    model: CloneModel  # with the expected counts of the walk as its counts
    log_likelihood: Floats  # `[n]` log P(sights | actions), nats
    objective: Floats  # `[n]` log_likelihood + `log_prior`: what each iteration raises or leaves
    converged: bool  # whether the tolerance stopped it


def log_prior(model: CloneModel) -> float:
    """kappa * sum of log P(next | state, action), nats, over every row whose (sight, action) has a block.

    Counts plus kappa maximise expected log-likelihood plus this: up to a constant, the log density of a
    Dirichlet(1 + kappa) prior on each row. With kappa = 0 it is 0, and the log-likelihood itself never falls.
    """
    kappa = model.pseudocount
    if kappa == 0.0:
        return 0.0
    outside = model.states - model.triples.sizes * model.clones
    rest = np.log(kappa / model.totals).sum(axis=1)
    return kappa * float(np.log(model.blocks).sum() + outside @ rest)


class Expectation:
    """The expectation step for one walk, with its workspace.

    Args:
        model: it has a block for every triple of the walk; its counts do not matter.
        walk: the history, of two sights at least.
    """

    def __init__(self, model: CloneModel, walk: Walk) -> None:
        self._which = model.triples.steps(walk)
        self._messages = Messages(len(walk) - 1, model.clones, pseudocount=model.pseudocount)
        self._pieces, self._piece_starts, self._triples = _pieces(self._which)
        self._into, self._behind = (np.zeros((len(walk), model.clones)) for _ in range(2))

    def run(self, model: CloneModel) -> tuple[Floats, float]:
        """`[N, c, c]` expected counts of each triple under `model`, and the log-likelihood, nats."""
        blocks, steps = model.blocks, len(self._which)
        np.take(blocks, self._which, axis=0, out=self._messages.blocks, mode="clip")
        into, behind = self._messages.run()
        scale = np.einsum("ti,ti->t", into, blocks.sum(axis=2)[self._which])
        weight = np.empty(steps)
        weight[:-1] = np.einsum("ti,ti->t", into[1:], behind[:-1]) * scale[:-1]
        weight[-1] = into[-1] @ self._messages.blocks[-1] @ behind[-1]
        np.divide(into, weight[:, None], out=self._into[:-1])
        self._behind[:-1] = behind
        counts = np.zeros_like(model.counts)
        counts[self._triples] = self._summed() * blocks[self._triples]
        return counts, float(np.log(scale).sum()) - float(np.log(model.observations))

    def _summed(self) -> Floats:
        """`[n, c, c]` the sum of the outer products of the messages, for each triple of the walk."""
        left, right = self._into[self._pieces], self._behind[self._pieces]
        return np.add.reduceat(left.transpose(0, 2, 1) @ right, self._piece_starts, axis=0)


def _pieces(which: Ints) -> tuple[Ints, Ints, Ints]:
    """Steps of each triple in rows of `PIECE`, filled up with T - 1; the first row of each triple; the triples."""
    triples, counts = np.unique(which, return_counts=True)
    rows = -(-counts // PIECE)
    starts = np.cumsum(rows) - rows
    table = np.full(int(rows.sum()) * PIECE, len(which), dtype=np.int64)
    within = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    table[np.repeat(starts * PIECE, counts) + within] = np.argsort(which, kind="stable")
    return table.reshape(-1, PIECE), starts, triples


def baum_welch(model: CloneModel, walk: Walk, *, iterations: int, tolerance: float = 0.0) -> Fit:
    """Expectation maximisation from `model`, with its pseudocount, over the whole walk.

    Args:
        model: where to start; triples that are new to it start without counts, all clones alike.
        walk: the history.
        iterations: at most so many, each one expectation and one maximisation.
        tolerance: stop after an iteration before which the objective had risen by less than this, in nats a
            step of the walk; 0: never.

    Raises:
        WorldError: the walk has more sights or actions than the model.
    """
    model = model.covering(walk)
    values: list[tuple[float, float]] = []
    expectation = Expectation(model, walk) if len(walk) > 1 and iterations else None
    converged = False
    while expectation and len(values) < iterations and not converged:
        counts, fit = expectation.run(model)
        values.append((fit, fit + log_prior(model)))
        model = replace(model, counts=counts)
        gain = values[-1][1] - values[-2][1] if len(values) > 1 else np.inf
        converged = tolerance > 0.0 and gain < tolerance * (len(walk) - 1)
    table = np.array(values).reshape(-1, 2)
    return Fit(model, table[:, 0], table[:, 1], converged)
