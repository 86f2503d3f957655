"""Expected free energy of policies: beliefs rolled forward, every term kept apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..model.errors import CogmapError
from .information import collected_information
from .policies.base import Policies
from .reach import Reach
from .staying import geometric, staying_teaches
from .transitions import Transitions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
CHUNK = 2_000_000  # numbers in the largest array; more policies are evaluated in parts
FEW = 128  # places up to which a dense product is quicker than going through the successors


@dataclass(frozen=True, slots=True)
class ExpectedFreeEnergy:
    """G(policy), term by term; each `[P]`, in nats, summed over the steps of the policy.

    Attributes:
        state_information: what the sights would tell about the place (eq. 5, eq. 8 inference).
        sight_information: what they would teach about A_o (eq. 8 learning).
        position_information: what the positions would teach about A_p (eq. 8 learning).
        transition_information: what their doors would teach about B_s (eq. 8 learning).
        utility: expected log preference of the sights and places (eq. 5).
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
    v_s(t) = sum_{t'<=t} Q_t'(s) expected visits, q_s(t) = max_{t'<=t} Q_t'(s) the probability of any visit (the
    largest is a bound that is exact on the way to a place and while staying there), C_s = q_s I_s(v_s / q_s)
    what they teach, and each step t weighted by discount^(t-1),

        state information       sum_t H[P_t] - sum_s Q_t(s) H[A[:, s]], over the steps that do not stay
        sight information       sum_t sum_s C_s(t) - C_s(t-1), I from `sight_information`
        position information    the same, I from `position_information`
        transition information  the same, I from `transition_information`
        utility                 sum_t sum_o P_t(o) log_C[o] + sum_s Q_t(s) log_C_place[s]
        collision               collision_cost sum_t sum_s Q_{t-1}(s) collision[s, a_t]

    and the information terms multiplied by `information_weight`.

    Entropies are over all sights: a row of mass m and multiplicity k adds -m ln(m / k). I is linear between
    integers and constant beyond its table. C telescopes, so nothing is collected twice in a rollout; nor does
    staying tell again what the first look at a place has told.
    Beliefs and gains are rolled forward once for each prefix that policies share.
    `reference.evaluate_plain` is the same, line by line.

    Raises:
        CogmapError: an action index that the motions do not have.
    """
    actions = policies.actions
    if actions.min() < 0 or actions.max() >= len(reach.motions):
        raise CogmapError(f"evaluate: actions must be 0..{len(reach.motions) - 1}; one policy has another")
    terms = np.empty((6, len(actions)))
    for rows, columns in _groups(reach, actions):
        terms[:, rows] = _in_parts(_Tables.of(reach, columns), actions[rows])
    terms[:4] *= reach.information_weight
    return ExpectedFreeEnergy(*terms)


def _groups(reach: Reach, actions: Ints) -> list[tuple[Ints, Ints]]:
    """Policies that see the same places, and these: most move for a few steps only, where one may move for hundreds."""
    all_ = np.arange(len(actions)), np.arange(len(reach.belief))
    if actions.shape[1] <= reach.look_ahead or not isinstance(reach.B, Transitions):
        return [all_]
    far = (actions[:, reach.look_ahead :] != reach.motions.stay).any(axis=1)
    if far.all():
        return [all_]
    near = reach.B.reachable(np.flatnonzero(reach.belief), reach.look_ahead)
    groups = [(np.flatnonzero(~far), near), (np.flatnonzero(far), all_[1])]
    return groups[: 1 + bool(far.any())]


def _in_parts(tables: _Tables, actions: Ints) -> Floats:
    """`[6, P]` the terms of each policy."""
    size = max(1, CHUNK // (tables.risk.size or 1))
    parts = [_evaluate(tables, actions[i : i + size]) for i in range(0, len(actions), size)]
    return parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1)


@dataclass(frozen=True, slots=True)
class _Tables:
    """The tables of `Reach` laid out for the rollout."""

    belief: Floats  # [R]
    B: Floats | Transitions  # [K, R, R], B[a, s, s'], or where the places are many their successors
    A: Floats  # [R, O]
    ambiguity: Floats  # [R] H[A[:, s]], without the multiplicity, which cancels in the state information
    utility: Floats  # [R] expected log preference
    risk: Floats  # [K, R] expected cost of collision
    information: tuple[Floats, ...]  # of A_o, A_p, B_s, each [R, N + 1]
    discount: float
    stay: int
    settled: bool  # whether it is known that to stay leaves every belief as it is

    @classmethod
    def of(cls, reach: Reach, columns: Ints) -> _Tables:
        """Of some of the places, ascending."""
        every = len(columns) == len(reach.belief)
        at = slice(None) if every else columns
        B = reach.B.within(columns) if isinstance(reach.B, Transitions) and not every else reach.B
        A = np.ascontiguousarray(reach.A.T[at])
        information = (reach.sight_information, reach.position_information, reach.transition_information)
        return cls(
            belief=reach.belief[at],
            B=_laid_out(B),
            A=A,
            ambiguity=_entropy(A),
            utility=reach.utility[at],
            risk=np.ascontiguousarray(reach.collision_cost * reach.collision[at].T),
            information=tuple(table[at] for table in information),
            discount=reach.discount,
            stay=reach.motions.stay,
            settled=isinstance(B, Transitions) and B.settled(reach.motions.stay),
        )


def _laid_out(B: Floats | Transitions) -> Floats | Transitions:
    if not isinstance(B, Transitions):
        return np.ascontiguousarray(B.transpose(2, 1, 0))
    return B.by_action if len(B.successors) <= FEW else B


@dataclass(frozen=True, slots=True)
class _Level:
    """The distinct prefixes of one length: `n` nodes of the prefix tree."""

    belief: Floats  # [n, R] Q_t
    visits: Floats  # [n, R] expected visits so far
    reached: Floats  # [n, R] probability of any visit so far
    learned: Floats  # [3, n] information about A_o, A_p and B_s collected by them


def _evaluate(tables: _Tables, actions: Ints) -> Floats:
    """`[6, P]` the terms of each policy."""
    kinds, places = tables.risk.shape
    nothing = np.zeros((1, places))
    level = _Level(tables.belief[None], nothing, nothing, np.zeros((3, 1)))
    node = np.zeros(len(actions), dtype=np.int64)
    total = np.zeros((6, len(actions)))
    weight = 1.0
    length = actions.shape[1]
    moving = _moving(tables, actions) if tables.settled else length
    for column in actions.T[:moving]:
        # children are numbered action by action, so that one product serves all children of an action
        child = column * len(level.belief) + node
        present = np.zeros(kinds * len(level.belief), dtype=np.bool_)
        present[child] = True
        node = (np.cumsum(present) - 1)[child]
        action, parent = np.divmod(np.flatnonzero(present), len(level.belief))
        level, gains = _descend(tables, level, parent, action)
        total += weight * gains[:, node]
        weight *= tables.discount
    if moving < length:
        total += weight * _stay(tables, level, length - moving)[:, node]
    return total


def _moving(tables: _Tables, actions: Ints) -> int:
    """Steps until all policies stay to the end; all steps where summing over those that are left would not pay."""
    length = actions.shape[1]
    moves = np.flatnonzero((actions != tables.stay).any(axis=0))
    moving = int(moves[-1]) + 1 if len(moves) else 1
    return moving if length - moving > max(table.shape[1] for table in tables.information) else length


def _stay(tables: _Tables, level: _Level, steps: int) -> Floats:
    """`[6, n]` what so many steps that stay add to the terms, the first of them at weight one."""
    gains = np.zeros((6, len(level.belief)))
    seen = level.belief, level.visits, level.reached
    gains[1:4] = staying_teaches(tables.information, *seen, steps=steps, discount=tables.discount)
    weight = geometric(tables.discount, steps)
    gains[4] = weight * (level.belief @ tables.utility)
    gains[5] = weight * (level.belief @ tables.risk[tables.stay])
    return gains


def _descend(tables: _Tables, level: _Level, parent: Ints, action: Ints) -> tuple[_Level, Floats]:
    """The next level of the tree, and `[6, n]` what the step to each of its nodes adds to the terms."""
    before = level.belief[parent]
    belief = np.empty_like(before)
    bounds = np.searchsorted(action, np.arange(len(tables.risk) + 1)).tolist()
    for a in range(len(tables.risk)):
        if bounds[a] < bounds[a + 1]:
            here = slice(bounds[a], bounds[a + 1])
            if isinstance(tables.B, Transitions):
                belief[here] = tables.B.predicted(before[here], a)
            else:
                np.matmul(before[here], tables.B[a], out=belief[here])
    visits = level.visits[parent] + belief
    reached = np.maximum(level.reached[parent], belief)
    learned = collected_information(tables.information, visits, reached)
    gains = np.empty((6, len(action)))
    gains[0] = (action != tables.stay) * (_entropy(belief @ tables.A) - belief @ tables.ambiguity)
    gains[1:4] = learned - level.learned[:, parent]
    gains[4] = belief @ tables.utility
    gains[5] = np.einsum("ns,ns->n", before, tables.risk[action])
    return _Level(belief, visits, reached, learned), gains


def _entropy(mass: Floats) -> Floats:
    """`[n]` entropy of rows `mass [n, O]`."""
    return -np.einsum("no,no->n", mass, np.log(np.maximum(mass, np.finfo(np.float64).tiny)))
