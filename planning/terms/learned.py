"""What visits teach about a table: the information gains of eq. 8 (learning)."""

from typing import ClassVar

import numpy as np

from .base import Term, geometric
from .plain import Step, collected
from .rolled import Floats, Rollout, Staying


class Learned(Term):
    """Exact expected information gain about the Dirichlet counts of one table; a subclass names the table.

    A step adds C(t) - C(t-1), where C = sum_s q_s I_s(v_s / q_s), v are expected visits, q the probability of any and
    I what so many visits teach. C telescopes, so nothing is collected twice in a rollout.

    Attributes:
        table: its name in `LocalModel.information`.
    """

    table: ClassVar[str]
    sign: ClassVar[float] = -1.0
    kind: ClassVar[str] = "information"

    def gain(self, rollout: Rollout) -> Floats:
        table = rollout.model.information[self.table]
        if not table.any():
            return np.zeros(len(rollout.parent))
        learned = rollout.collected(table)
        return learned - learned[rollout.parent]

    def staying(self, ends: Staying, steps: int) -> Floats:
        """In closed form: sum_j discount^j sum_s q (I_s(x_{j+1}) - I_s(x_j)), x_j = (visits + j belief) / q.

        I is piecewise linear, hence a sum of c_m min(x, m) over its knots m, and each of these grows by
        r = belief / reached a step until it is full: a geometric sum.
        """
        table, discount = ends.model.information[self.table], ends.model.discount
        total = np.zeros(len(ends.parent))
        if not table.any():
            return total
        row, place = np.nonzero(ends.belief > 0.0)
        any_visit = ends.reached[row, place]
        start, rate = ends.visits[row, place] / any_visit, ends.belief[row, place] / any_visit
        for m in range(1, table.shape[1]):
            room = np.maximum(m - start, 0.0)
            whole = np.minimum(np.floor(room / rate), steps)
            rest = np.where(whole < steps, room - whole * rate, 0.0)
            grown = any_visit * (rate * geometric(discount, whole) + rest * discount**whole)
            total += np.bincount(row, weights=grown * _bend(table, m)[place], minlength=len(total))
        return total

    def plain(self, step: Step) -> float:
        gained = 0.0
        for s, row in enumerate(step.model.information[self.table].tolist()):
            gained += collected(row, step.visits[s], step.reached[s])
            gained -= collected(row, step.visits_before[s], step.reached_before[s])
        return gained


def _bend(table: Floats, m: int) -> Floats:
    """`[R]` c_m: by how much the slope falls at knot `m`."""
    before = table[:, m] - table[:, m - 1]
    return before - (table[:, m + 1] - table[:, m]) if m + 1 < table.shape[1] else before
