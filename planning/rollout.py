"""Expected free energy of policies: beliefs rolled forward, every term kept apart."""

from collections.abc import Sequence

import numpy as np

from ..model import CogmapError, Floats, Ints
from .energy import ExpectedFreeEnergy
from .local import LocalModel
from .policies.base import Policies
from .prefixes import Prefixes, prefixes_of
from .terms import TERMS, Rollout, Staying, Term

CHUNK = 200_000  # numbers in the larger arrays; more policies are evaluated in parts


def evaluate(model: LocalModel, policies: Policies, terms: Sequence[Term] = TERMS) -> ExpectedFreeEnergy:
    """Expected free energy of each policy a_1..a_L from Q_0 = `model.belief` (eqs. 4, 5 and 8).

    Beliefs are rolled forward, Q_t(s') = sum_s B[s', s, a_t] Q_{t-1}(s), once for each prefix that policies share. Each
    term is summed over the steps, step t weighted by discount^(t-1); what a step adds stands in the file of the term.
    Information gains are multiplied by `information_weight`. `reference.evaluate_plain` is the same, line by line.

    Raises:
        CogmapError: an action index that the motions do not have.
    """
    least, most = policies.span
    if least < 0 or most >= len(model.motions):
        raise CogmapError(f"evaluate: actions must be 0..{len(model.motions) - 1}; one policy has another")
    terms = tuple(terms)
    values = _in_groups(model, policies, terms)
    if model.information_weight != 1.0:
        values[[term.kind == "information" for term in terms]] *= model.information_weight
    return ExpectedFreeEnergy(terms, values)


def _in_groups(model: LocalModel, policies: Policies, terms: tuple[Term, ...]) -> Floats:
    """`[T, P]` terms: most policies move for a few steps only and see what is near, where one may move for hundreds."""
    actions, look_ahead = policies.actions, model.look_ahead
    if actions.shape[1] <= look_ahead:
        return _in_parts(model, policies, terms)
    far = (actions[:, look_ahead:] != model.motions.stay).any(axis=1)
    near = model.within(model.B.reachable(np.flatnonzero(model.belief), look_ahead))
    values = np.empty((len(terms), len(actions)))
    for rows, part in ((~far, near), (far, model)):
        if rows.any():
            values[:, rows] = _in_parts(part, Policies(actions[rows]), terms)
    return values


def _in_parts(model: LocalModel, policies: Policies, terms: tuple[Term, ...]) -> Floats:
    """`[T, P]` the terms of each policy."""
    size = max(1, CHUNK // (len(model.belief) * policies.actions.shape[1]))
    if len(policies) <= size:
        return _evaluate(model, policies, terms)
    parts = (Policies(policies.actions[i : i + size]) for i in range(0, len(policies), size))
    return np.concatenate([_evaluate(model, part, terms) for part in parts], axis=1)


def _evaluate(model: LocalModel, policies: Policies, terms: tuple[Term, ...]) -> Floats:
    """`[T, P]` the terms of each policy."""
    length, moving = policies.actions.shape[1], _moving(model, policies.actions)
    prefixes = policies.prefixes if moving == length else prefixes_of(policies.actions[:, :moving])
    rolled, ends = _kept_roll(model, policies, prefixes), prefixes.of[:, -1]
    gains = np.empty((len(terms), len(prefixes)))
    for row, term in zip(gains, terms, strict=True):
        row[:] = term.gain(rolled)
    total = _summed(model.discount, prefixes, gains).take(ends, axis=1)
    if moving < length:
        last = Staying.after(rolled, ends)
        rest = np.stack([term.staying(last, length - moving) for term in terms])
        total += model.discount**moving * rest
    return total


def _moving(model: LocalModel, actions: Ints) -> int:
    """Steps until all policies stay to the end; all steps where summing over those that are left would not pay."""
    length, stay = actions.shape[1], model.motions.stay
    if length <= model.look_ahead or not model.B.settled(stay):
        return length
    moves = np.flatnonzero((actions != stay).any(axis=0))
    moving = int(moves[-1]) + 1 if len(moves) else 1
    return moving if length - moving > model.look_ahead else length


def _kept_roll(model: LocalModel, policies: Policies, prefixes: Prefixes) -> Rollout:
    """Beliefs rolled forward, once for policies that come again, as long as belief and ways are the same."""
    kept = model.kept
    if kept is None or all(policies is not made for made in kept.policies.values()):
        return _roll(model, prefixes)
    before: Rollout | None = kept.rollouts.get(id(policies))
    if before is not None and np.array_equal(before.belief[0], model.belief):
        rolled = before.again(model)
    else:
        rolled = _roll(model, prefixes)
    kept.rollouts[id(policies)] = rolled
    return rolled


def _roll(model: LocalModel, prefixes: Prefixes) -> Rollout:
    """Beliefs rolled forward, level by level."""
    belief = np.zeros((len(prefixes), len(model.belief)))
    belief[0] = model.belief
    B, action = model.B.used(prefixes.action)
    for above, begin, end in prefixes.levels:
        parent = prefixes.parent[begin:end]
        belief[begin:end] = B.predicted(belief[above:begin], parent - above, action[begin:end])
    levels = [(begin, end) for _, begin, end in prefixes.levels]
    return Rollout(model, prefixes.parent, prefixes.action, levels, belief)


def _summed(discount: float, prefixes: Prefixes, gains: Floats) -> Floats:
    """`[T, N]` the discounted gains of all steps of each prefix; takes the place of `gains`."""
    weight = 1.0
    for _, begin, end in prefixes.levels:
        step = gains[:, begin:end]
        step *= weight
        if begin > 1:  # the empty prefix has gained nothing
            step += gains.take(prefixes.parent[begin:end], axis=1)
        weight *= discount
    return gains
