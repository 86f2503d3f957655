"""Expected free energy of policies: beliefs rolled forward, every term kept apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..model.errors import CogmapError
from .energy import ExpectedFreeEnergy
from .information import Lessons, lessons
from .policies.base import Policies
from .prediction import FEW, Predict, predictor
from .prefixes import Prefixes, prefixes_of
from .reach import Reach
from .staying import geometric, staying_teaches
from .transitions import Transitions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
CHUNK = 200_000  # numbers in the larger arrays; more policies are evaluated in parts


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
    least, most = policies.span
    if least < 0 or most >= len(reach.motions):
        raise CogmapError(f"evaluate: actions must be 0..{len(reach.motions) - 1}; one policy has another")
    terms = _in_groups(reach, policies)
    terms[:4] *= reach.information_weight
    return ExpectedFreeEnergy(*terms)


def _in_groups(reach: Reach, policies: Policies) -> Floats:
    """`[6, P]` terms: most policies move for a few steps only and see what is near, where one may move for hundreds."""
    actions, every = policies.actions, np.arange(len(reach.belief))
    if actions.shape[1] <= reach.look_ahead or not isinstance(reach.B, Transitions):
        return _in_parts(_Tables.of(reach, every), policies)
    far = (actions[:, reach.look_ahead :] != reach.motions.stay).any(axis=1)
    near = reach.B.reachable(np.flatnonzero(reach.belief), reach.look_ahead)
    terms = np.empty((6, len(actions)))
    for rows, columns in ((~far, near), (far, every)):
        if rows.any():
            terms[:, rows] = _in_parts(_Tables.of(reach, columns), Policies(actions[rows]))
    return terms


def _in_parts(tables: _Tables, policies: Policies) -> Floats:
    """`[6, P]` the terms of each policy."""
    size = max(1, CHUNK // (len(tables.belief) * policies.actions.shape[1]))
    if len(policies) <= size:
        return _evaluate(tables, policies)
    parts = (Policies(policies.actions[i : i + size]) for i in range(0, len(policies), size))
    return np.concatenate([_evaluate(tables, part) for part in parts], axis=1)


@dataclass(frozen=True, slots=True)
class _Tables:
    """The tables of `Reach` laid out for the rollout."""

    belief: Floats  # [R]
    predict: Predict
    A: Floats  # [R, O]
    linear: Floats  # [R, 2 + K] ambiguity H[A[:, s]], without the multiplicity, which cancels in the state information;
    # expected log preference; expected cost of collision of each action
    lessons: Lessons  # of A_o, A_p, B_s
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
        risk = reach.collision_cost * reach.collision[at]
        return cls(
            belief=reach.belief[at],
            predict=predictor(B),
            A=A,
            linear=np.concatenate([_entropy(A)[:, None], reach.utility[at, None], risk], axis=1),
            lessons=lessons(
                [reach.sight_information[at], reach.position_information[at], reach.transition_information[at]]
            ),
            discount=reach.discount,
            stay=reach.motions.stay,
            settled=isinstance(B, Transitions) and B.settled(reach.motions.stay),
        )


@dataclass(frozen=True, slots=True)
class _Rolled:
    """What is expected after each of `N` prefixes."""

    belief: Floats  # [N, R] Q_t
    visits: Floats  # [N, R] expected visits so far
    reached: Floats  # [N, R] probability of any visit so far


def _evaluate(tables: _Tables, policies: Policies) -> Floats:
    """`[6, P]` the terms of each policy."""
    length = policies.actions.shape[1]
    moving = _moving(tables, policies.actions) if tables.settled else length
    prefixes = policies.prefixes if moving == length else prefixes_of(policies.actions[:, :moving])
    rolled, ends = _roll(tables, prefixes), prefixes.of[:, -1]
    total = _summed(tables, prefixes, _gains(tables, prefixes, rolled)).take(ends, axis=1)
    if moving < length:
        last = _Rolled(rolled.belief[ends], rolled.visits[ends], rolled.reached[ends])
        total += tables.discount**moving * _stay(tables, last, length - moving)
    return total


def _moving(tables: _Tables, actions: Ints) -> int:
    """Steps until all policies stay to the end; all steps where summing over those that are left would not pay."""
    length = actions.shape[1]
    if length <= tables.lessons.most:
        return length
    moves = np.flatnonzero((actions != tables.stay).any(axis=0))
    moving = int(moves[-1]) + 1 if len(moves) else 1
    return moving if length - moving > tables.lessons.most else length


def _roll(tables: _Tables, prefixes: Prefixes) -> _Rolled:
    """Beliefs rolled forward, level by level."""
    size = len(tables.belief)
    belief, visits, reached = np.zeros((3, len(prefixes), size))
    belief[0] = tables.belief
    for above, begin, end in prefixes.levels:
        parent, action = prefixes.parent[begin:end], prefixes.action[begin:end]
        after = belief[begin:end] = tables.predict(belief[above:begin], parent - above, action)
        if tables.lessons.told:  # else nobody asks for visits
            np.add(visits[parent], after, out=visits[begin:end])
            np.maximum(reached[parent], after, out=reached[begin:end])
    return _Rolled(belief, visits, reached)


def _gains(tables: _Tables, prefixes: Prefixes, rolled: _Rolled) -> Floats:
    """`[6, N]` what the last step of each prefix adds to the terms, undiscounted."""
    parent, action = prefixes.parent, prefixes.action
    belief, likelihood, linear = rolled.belief, tables.A, tables.linear
    if belief.shape[1] > FEW:
        held = np.flatnonzero(belief.any(axis=0))
        belief, likelihood, linear = belief[:, held], likelihood[held], linear[held]
    expected = belief @ linear
    gains = np.zeros((6, len(prefixes)))
    gains[0] = (action != tables.stay) * (_entropy(belief @ likelihood) - expected[:, 0])
    if tables.lessons.told:
        learned = tables.lessons.collected(rolled.visits, rolled.reached)
        np.subtract(learned, learned[:, parent], out=gains[1:4])
    gains[4] = expected[:, 1]
    gains[5] = expected[parent, 2 + action]
    return gains


def _summed(tables: _Tables, prefixes: Prefixes, gains: Floats) -> Floats:
    """`[6, N]` the discounted gains of all steps of each prefix; takes the place of `gains`."""
    weight = 1.0
    for _, begin, end in prefixes.levels:
        step = gains[:, begin:end]
        step *= weight
        if begin > 1:  # the empty prefix has gained nothing
            step += gains.take(prefixes.parent[begin:end], axis=1)
        weight *= tables.discount
    return gains


def _stay(tables: _Tables, ends: _Rolled, steps: int) -> Floats:
    """`[6, P]` what so many steps that stay add to the terms, the first of them at weight one."""
    gains = np.zeros((6, len(ends.belief)))
    if tables.lessons.told:
        seen = ends.belief, ends.visits, ends.reached
        gains[1:4] = staying_teaches(tables.lessons.tables, *seen, steps=steps, discount=tables.discount)
    expected = ends.belief @ tables.linear
    weight = geometric(tables.discount, steps)
    gains[4] = weight * expected[:, 1]
    gains[5] = weight * expected[:, 2 + tables.stay]
    return gains


def _entropy(mass: Floats) -> Floats:
    """`[n]` entropy of rows `mass [n, O]`."""
    return -np.einsum("no,no->n", mass, np.log(np.maximum(mass, np.finfo(np.float64).tiny)))
