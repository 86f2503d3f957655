"""Expected free energy of policies: beliefs rolled forward, every term kept apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..model.errors import CogmapError
from .information import total_information
from .policies.base import Policies
from .reach import Reach

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
CHUNK = 2_000_000  # numbers in the largest array; more policies are evaluated in parts


@dataclass(frozen=True, slots=True)
class ExpectedFreeEnergy:
    """G(policy), term by term; each `[P]`, in nats, summed over the steps of the policy.

    Attributes:
        state_information: what the sights would tell about the place (eq. 5, eq. 8 inference).
        sight_information: what they would teach about A_o (eq. 8 learning).
        position_information: what the positions would teach about A_p (eq. 8 learning).
        transition_information: what the moves would teach about B_s (eq. 8 learning).
        utility: expected log preference of the sights (eq. 5).
        collision: expected risk of collision (eq. 8).
    """

    state_information: Floats
    sight_information: Floats
    position_information: Floats
    transition_information: Floats
    utility: Floats
    collision: Floats

    @property
    def information(self) -> Floats:
        """`[P]` all information gains together."""
        learned = self.sight_information + self.position_information + self.transition_information
        return self.state_information + learned

    @property
    def G(self) -> Floats:
        """`[P]` collision - information - utility; the least is best."""
        return self.collision - self.information - self.utility

    def __len__(self) -> int:
        return len(self.utility)

    def row(self, policy: int) -> dict[str, float]:
        """The terms of one policy by name, and `G`."""
        terms = {name: float(getattr(self, name)[policy]) for name in self.__slots__}
        return {**terms, "G": float(self.G[policy])}


def evaluate(reach: Reach, policies: Policies) -> ExpectedFreeEnergy:
    """Expected free energy of each policy a_1..a_L from Q_0 = `reach.belief` (eqs. 4, 5 and 8).

    Q_t(s') = sum_s B[s', s, a_t] Q_{t-1}(s), predicted sights P_t = A Q_t, and with
    m_s = sum_{t'<t} Q_t'(s) visits and n_sa = sum_{t'<t, a_t'=a} Q_{t'-1}(s) attempts before step t

        state information       sum_t H[P_t] - sum_s Q_t(s) H[A[:, s]]
        sight information       sum_t sum_s I_s(m_s + Q_t(s)) - I_s(m_s), I from `sight_information`
        position information    the same, I from `position_information`
        transition information  sum_t sum_s J_sa(n_sa + Q_{t-1}(s)) - J_sa(n_sa), a = a_t,
                                J from `transition_information`
        utility                 sum_t sum_o P_t(o) log_C[o]
        collision               collision_cost sum_t sum_s Q_{t-1}(s) collision[s, a_t]

    Entropies are over all sights: a row of mass m and multiplicity k adds -m ln(m / k). I and J are
    linear between integers and constant beyond their table. Both telescope, so only the totals of a
    policy matter, and beliefs are rolled forward once for each prefix that policies share.
    `reference.evaluate_plain` is the same, line by line.

    Raises:
        CogmapError: an action index that the motions do not have.
    """
    actions = policies.actions
    if actions.min() < 0 or actions.max() >= len(reach.motions):
        raise CogmapError(f"evaluate: actions must be 0..{len(reach.motions) - 1}; one policy has another")
    tables = _Tables.of(reach)
    size = max(1, CHUNK // (tables.risk.size + actions.shape[1] * len(reach.belief)))
    parts = [_evaluate(tables, actions[i : i + size]) for i in range(0, len(actions), size)]
    columns = parts[0] if len(parts) == 1 else [np.concatenate(column) for column in zip(*parts, strict=True)]
    return ExpectedFreeEnergy(*columns)


@dataclass(frozen=True, slots=True)
class _Tables:
    """The tables of `Reach` laid out for the rollout: (action, place) flattened into one axis `K R`."""

    belief: Floats  # [R]
    B: Floats  # [K, R, R], B[a, s, s']
    A: Floats  # [R, O]
    ambiguity: Floats  # [R] H[A[:, s]]
    utility: Floats  # [R] expected log preference
    risk: Floats  # [K R] expected cost of collision
    sight: Floats  # [R, N + 1]
    position: Floats  # [R, N + 1]
    transition: Floats  # [K R, N + 1]

    @classmethod
    def of(cls, reach: Reach) -> _Tables:
        A = np.ascontiguousarray(reach.A.T)
        transition = reach.transition_information.transpose(1, 0, 2)
        return cls(
            belief=reach.belief,
            B=np.ascontiguousarray(reach.B.transpose(2, 1, 0)),
            A=A,
            ambiguity=_entropy(A),
            utility=A @ reach.log_C,
            risk=reach.collision_cost * reach.collision.T.ravel(),
            sight=reach.sight_information,
            position=reach.position_information,
            transition=transition.reshape(-1, transition.shape[-1]),
        )


def _evaluate(tables: _Tables, actions: Ints) -> list[Floats]:
    """The six terms, each `[P]`."""
    beliefs, node = _roll_forward(tables, actions)
    attempts = _attempts(beliefs, node, actions, len(tables.B))
    visits = attempts @ tables.B.reshape(-1, len(tables.belief))
    surprise = _entropy(beliefs @ tables.A).take(node[:, 1:]).sum(1)
    return [
        surprise - visits @ tables.ambiguity,
        total_information(tables.sight, visits),
        total_information(tables.position, visits),
        total_information(tables.transition, attempts),
        visits @ tables.utility,
        attempts @ tables.risk,
    ]


def _roll_forward(tables: _Tables, actions: Ints) -> tuple[Floats, Ints]:
    """Beliefs at the nodes of the prefix tree `[nodes, R]`, and the nodes of each policy `[P, L + 1]`."""
    node = np.zeros((len(actions), actions.shape[1] + 1), dtype=np.int64)
    level = tables.belief[None, :]
    levels = [level]
    above = node[:, 0]
    offset = 1
    for step, action in enumerate(actions.T, start=1):
        level, above = _children(tables.B, level, above, action)
        levels.append(level)
        node[:, step] = above + offset
        offset += len(level)
    return np.concatenate(levels), node


def _children(B: Floats, level: Floats, above: Ints, action: Ints) -> tuple[Floats, Ints]:
    """The next level of the tree `[children, R]`, and the child that each policy goes through `[P]`.

    Children are numbered action by action, so that one product serves all children of an action.
    """
    kinds, parents = len(B), len(level)
    child = action * parents + above
    present = np.zeros(kinds * parents, dtype=bool)
    present[child] = True
    count = present.cumsum()
    before = level.take(present.nonzero()[0] % parents, axis=0)
    after: list[Floats] = []
    low = 0
    for a, high in enumerate(count[parents - 1 :: parents].tolist()):
        if high > low:
            after.append(before[low:high] @ B[a])
        low = high
    return np.concatenate(after), count[child] - 1


def _attempts(beliefs: Floats, node: Ints, actions: Ints, kinds: int) -> Floats:
    """`[P, K R]` expected attempts of each (action, place) along each policy."""
    chosen = np.eye(kinds).take(actions, axis=0)
    before = beliefs.take(node[:, :-1], axis=0)
    return (chosen.transpose(0, 2, 1) @ before).reshape(len(actions), -1)


def _entropy(mass: Floats) -> Floats:
    """`[n]` entropy of rows `mass [n, O]`, lumps counted as one sight each.

    The sights in a lump add its mass times the log of their number. That is linear in the mass, so it
    is the same in H[P_t] as in the mean of H[A[:, s]], and their difference needs none of it.
    """
    return -np.einsum("no,no->n", mass, np.log(np.maximum(mass, np.finfo(np.float64).tiny)))
