"""The planner: what makes policies, what they are judged by, and how one is chosen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model import CogmapError, Motions
from .choices import Choice, Outward, Sampled
from .local import LocalCache, LocalModel, MapHypotheses, MapView, Preferences, local_model
from .plan import Plan, policy_posterior
from .policies import LShaped, MapGuided, Options, PolicyGenerator
from .rollout import evaluate
from .terms import KINDS, TERMS, Term

LAST = 0.01
"""Weight that the last step of a plan has at least, however long it is: what is far is worth setting out for."""

USUAL = Options()


@dataclass(frozen=True, kw_only=True)
class Planner:
    """How an agent plans. Its parts are objects; write your own as a subclass of the part's base class.

    Raises:
        CogmapError: a part is of another kind, or terms share a name.
    """

    policies: PolicyGenerator = field(default_factory=MapGuided)  # which action sequences are compared
    # what their expected free energy is the sum of, any number, each with a name of its own
    terms: Sequence[Term] = TERMS
    choice: Choice = field(default_factory=Outward)  # which of them is followed
    # how it explores where there are places never entered; None for one that goes by the above alone, as any
    # does whose policies, terms or choice are not the usual ones, unless it is given
    explorer: Options | None = field(default_factory=lambda: USUAL)

    def __post_init__(self) -> None:
        object.__setattr__(self, "terms", tuple(self.terms))
        if self.explorer is USUAL and not self._usual:
            object.__setattr__(self, "explorer", None)
        parts: list[tuple[str, Any, Any]] = [
            ("policies", self.policies, PolicyGenerator),
            ("choice", self.choice, Choice),
            ("explorer", self.explorer, Options | type(None)),
        ]
        for name, part, kind in (*parts, *(("terms", term, Term) for term in self.terms)):
            if not isinstance(part, kind):
                raise CogmapError(
                    f"planner: {name} has {part!r}; give an object of a class that extends {kind.__name__}"
                )
        names = [term.name for term in self.terms]
        if not names or len(set(names)) < len(names):
            given = ", ".join(names) or "none"
            raise CogmapError(f"planner: the terms are {given}; give one or more, each with a name of its own")
        for term in self.terms:
            if term.kind not in KINDS or abs(term.sign) != 1.0:
                raise CogmapError(
                    f"planner: term {term.name} is of kind {term.kind!r} and sign {term.sign}; "
                    f"use one of {', '.join(KINDS)}, and 1.0 or -1.0"
                )

    @property
    def _usual(self) -> bool:
        """Whether it plans as any planner does that is given nothing."""
        return type(self.policies) is MapGuided and self.terms == TERMS and self.choice == Outward()

    @classmethod
    def paper(cls) -> Planner:
        """That of the paper's own agent: L-shaped paths (of its three ways the one that reaches 13 steps), and a draw.

        The draw is from P(policy) (eq. 6).
        """
        return cls(policies=LShaped(), choice=Sampled())

    def check(self, motions: Motions, look_ahead: int) -> None:
        """Refuse, before any work, what could not be planned: see `PolicyGenerator.check`."""
        self.policies.check(motions, look_ahead)

    def plan(
        self,
        map_: MapView,
        places: NDArray[np.int64],
        belief: NDArray[np.float64],
        *,
        open_: Sequence[bool],
        look_ahead: int,
        rng: np.random.Generator,
        preferences: Preferences | None = None,
        precision: float = 16.0,
        discount: float = 1.0,
        information_weight: float = 1.0,
        starts: int = 32,
        cache: LocalCache | None = None,
        structure: MapHypotheses | None = None,
        costs: NDArray[np.float64] | None = None,
        unseen: Sequence[bool] = (),
        prices: NDArray[np.float64] | None = None,
    ) -> Plan:
        """Cut the local model out of a map, make policies, evaluate them, choose one.

        Args:
            map_: what is planned with.
            places: `[n]` where the agent may be, ascending.
            belief: `[n]` Q(s) of each.
            open_: for each action, whether its way is sensed open now.
            look_ahead: steps that policies look ahead.
            rng: breaks ties, and draws.
            preferences: what is hoped for; nothing, unless told.
            precision: gamma of eq. 6.
            discount: weight of each step relative to the one before.
            information_weight: weight of every information gain.
            starts: places to set out from, at most.
            cache: of the map, kept from plan to plan.
            structure: hypotheses about the map, which policies may tell apart.
            costs: `[K]` what each action is expected to cost, for terms that ask.
            unseen: for each action, whether no sensor tells of its way, so that it is worth a try; none, unless told.
            prices: `[K]` what each action is expected to cost from here, in usual moves; all 1 unless told.

        Raises:
            CogmapError: what `local_model`, the generator or `policy_posterior` raise.
        """
        model = local_model(
            map_,
            places,
            belief,
            open_=open_,
            look_ahead=look_ahead,
            preferences=preferences,
            discount=discount,
            information_weight=information_weight,
            starts=starts,
            cache=cache,
            beyond=self.policies.beyond,
            structure=structure,
            costs=costs,
            explorer=None if self.explorer is None else self.explorer.found,
            unseen=unseen,
            prices=prices,
        )
        return self._decide(model, precision, rng)

    def decide(self, model: LocalModel, *, precision: float = 16.0, rng: np.random.Generator) -> Plan:
        """The same with tables that are given.

        Raises:
            CogmapError: a table that does not fit (see `LocalModel.check`), and what `plan` raises.
        """
        model.check()
        return self._decide(model, precision, rng)

    def _decide(self, model: LocalModel, precision: float, rng: np.random.Generator) -> Plan:
        explorer = self.explorer if model.frontier is not None else None
        generator, terms, choice = self.policies, self.terms, self.choice
        if explorer is not None:
            generator, terms, choice = explorer, explorer.terms, explorer.choice
        policies = generator.make(model)
        model = _in_sight(model, policies.actions.shape[1])
        energy = evaluate(model, policies, terms)
        G = energy.G
        probability = policy_posterior(G, precision=precision)
        chosen = choice.choose(model, policies.actions, G, probability, rng)
        action = int(policies.actions[chosen, 0])
        return Plan(model, policies.actions, energy, probability, chosen, action, policies.cut, generator, choice)


def _in_sight(model: LocalModel, length: int) -> LocalModel:
    """The model with a discount that leaves something of the last step of plans that go beyond the look-ahead."""
    if length <= model.look_ahead:
        return model
    last = min(model.discount**model.look_ahead, LAST)
    return replace(model, discount=max(model.discount, last ** (1.0 / length)))
