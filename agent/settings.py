"""Every number of the agent, with its symbol, default and source."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, fields
from typing import Any, Literal, cast

from ..inference import ENGINES, FilterOptions, TrackerOptions
from ..model import PAPER_RATES, CogmapError, Priors, Rates, is_number, is_whole
from ..planning import MAX_LOOK_AHEAD


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """The numerical settings of an agent: model, inference and planning. Its parts are passed to the agent separately.

    "Paper" below is de Tinguy, Verbelen and Dhoedt, "Learning dynamic cognitive map with autonomous navigation".

    Attributes:
        look_ahead: L, steps that policies look ahead (paper: 6 for its computation times, 13 or 14 in the Tolman
            maze).
        starts: places that the agent may be at from which a plan sets out; belief in others is left out of the plan,
            and counted in `Plan.dropped`.
        precision: γ in P(π) = softmax(-γ G) (paper: 16).
        rates: learning rates of the Dirichlet counts (paper's table of transition learning rates).
        forgetting: share of the evidence for transitions that fades each step (ours; off).
        certainty: Q(s) below which learning, growth and position wait (paper: 0.7).
        window: W, time steps of the factor graph that is kept.
        engine: sum-product engine of the window: `numpy` or `gtsam`.
        filter: displacement prior, slip and support of the forward filter (ours).
        hypotheses: how many hypotheses about the map are kept; None for an agent whose map is never in question, as in
            the paper: a place is then its position.
        priors: concentrations before evidence (ours; the paper starts from the shape of its matrices).
        discount: weight of each step of a policy relative to the one before (ours; paper: 1).
        goal_weight: weight of the utility term: how much it exploits (paper: 1, and 2 in the Tolman maze).
        information_weight: weight of the information gains: how much it explores (paper: 1).
        collision_cost: -log P(c = 1), what a collision costs, in nats (paper: binary; eq. 8).

    Raises:
        CogmapError: a value is out of range, or a name is unknown.
    """

    look_ahead: int = 6
    starts: int = 32
    precision: float = 16.0
    rates: Rates = field(default_factory=Rates)
    forgetting: float = 0.0
    certainty: float = 0.7
    window: int = 10
    engine: Literal["numpy", "gtsam"] = "numpy"
    filter: FilterOptions = field(default_factory=FilterOptions)
    hypotheses: TrackerOptions | None = field(default_factory=TrackerOptions)
    priors: Priors = field(default_factory=Priors)
    discount: float = 0.95
    goal_weight: float = 1.0
    information_weight: float = 1.0
    collision_cost: float = 1.0

    def __post_init__(self) -> None:
        for name, kind in _NESTED.items():
            if name == "hypotheses" and self.hypotheses is None:
                continue
            _check(isinstance(getattr(self, name), kind), name, getattr(self, name), f"use a {kind.__name__}")
        for name, most in _MOST.items():
            value, remedy = getattr(self, name), f"use a whole number of 1 or more, at most {most:,}"
            _check(is_whole(value, 1, most), name, value, remedy)
        for names, (least, most) in _RANGES.items():
            for name in names.split():
                value = getattr(self, name)
                _check(is_number(value, least, most), name, value, f"use a number from {least:g} to {most:g}")
        known = isinstance(self.engine, str) and self.engine in ENGINES  # pyright: ignore[reportUnnecessaryIsInstance]
        _check(known, "engine", self.engine, f"choose one of {', '.join(ENGINES)}")

    @classmethod
    def paper(cls, **others: Any) -> Settings:
        """Those of the paper's own agent; `Planner.paper()` has its policies and its draw from P(policy).

        γ is 16, steps are not discounted, rates are those of its table and add up for ever, and a place is its
        position: its map is never in question. What else departs from the paper is no number (docs/deviations.md).

        Args:
            **others: settings that are to be otherwise, such as `look_ahead=13`.

        Raises:
            CogmapError: as for `Settings`.
        """
        chosen: dict[str, Any] = {"precision": 16.0, "discount": 1.0, "rates": PAPER_RATES, "hypotheses": None}
        return cls(**{**chosen, **others})

    def to_dict(self) -> dict[str, Any]:
        """The settings as plain JSON values."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> Settings:
        """The settings that `to_dict` gave. Raises CogmapError: a name is unknown."""
        given = _known(cls, values)
        for name, kind in _NESTED.items():
            if given.get(name) is not None:
                parts = _known(kind, given[name])
                given[name] = kind(**{key: tuple(v) if isinstance(v, list) else v for key, v in parts.items()})
        return cls(**given)


_NESTED: dict[str, type[Any]] = {
    "rates": Rates,
    "filter": FilterOptions,
    "hypotheses": TrackerOptions,
    "priors": Priors,
}

_TINY, _LARGE = 1e-300, 1e9
_MOST = {"look_ahead": MAX_LOOK_AHEAD, "starts": 1_000_000, "window": 100_000}
_RANGES = {
    "precision collision_cost goal_weight information_weight": (0.0, _LARGE),
    "forgetting certainty": (0.0, 1.0),
    "discount": (_TINY, 1.0),
}
"""What each number may be."""


def _known(kind: type[Any], values: object) -> dict[str, Any]:
    """The values by name, if all are fields of `kind`."""
    names = [field_.name for field_ in fields(kind)]
    if not isinstance(values, dict):
        raise CogmapError(f"settings: {kind.__name__} cannot be made of {values!r}; give a dict of {', '.join(names)}")
    given = cast(dict[str, Any], values)
    if unknown := sorted(str(name) for name in given if name not in names):
        raise CogmapError(
            f"settings: unknown {', '.join(unknown)}; known are the fields of {kind.__name__}: {', '.join(names)}"
        )
    return dict(given)


def _check(fine: bool, name: str, value: object, remedy: str) -> None:
    if not fine:
        raise CogmapError(f"settings: {name} is {value!r}; {remedy}")
