"""One step of one policy in plain Python, and the sums over places that the plain terms share."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import floor, log

from ..local import LocalModel


@dataclass(frozen=True, slots=True)
class Step:
    """One step of one policy; lists have an entry a place."""

    model: LocalModel  # the local model
    action: int  # what is done
    before: Sequence[float]  # Q_{t-1}, the belief before
    after: Sequence[float]  # Q_t, the belief after
    visits_before: Sequence[float]  # expected visits of each place, up to the step before
    visits: Sequence[float]  # the same, this step included
    # probability of any visit of each place, up to the step before: the largest belief so far
    reached_before: Sequence[float]
    reached: Sequence[float]  # the same, this step included
    path: Sequence[int] = ()  # the actions so far, this one included
    # probability that each action was tried in each place up to the step before, by (place, action)
    tried_before: Mapping[tuple[int, int], float] = field(default_factory=dict[tuple[int, int], float])
    # the same, this step included
    tried: Mapping[tuple[int, int], float] = field(default_factory=dict[tuple[int, int], float])


def predicted_sights(model: LocalModel, Q: Sequence[float]) -> list[float]:
    """P(o) = sum_s A[o, s] Q(s), lumped rows together."""
    return [sum(float(row[s]) * Q[s] for s in range(len(Q))) for row in model.A]


def entropy(model: LocalModel, sights: Sequence[float]) -> float:
    """-sum m ln(m / k) over rows of mass m that stand for k sights each."""
    counts = model.multiplicity.tolist()
    return -sum(mass * log(mass / k) for mass, k in zip(sights, counts, strict=True) if mass > 0.0)


def collected(table: Sequence[float], visits: float, reached: float) -> float:
    """C = q I(v / q): what `visits` teach if there is any visit with probability `reached`."""
    return reached * read(table, visits / reached) if reached > 0.0 else 0.0


def read(table: Sequence[float], visits: float) -> float:
    """I(visits), linear between integers, constant beyond the table."""
    last = len(table) - 1
    if visits >= last:
        return table[last]
    low = floor(visits)
    return table[low] + (visits - low) * (table[low + 1] - table[low])
