"""Every knob of the agent, with its symbol, default and source."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, fields
from typing import Any

from ..inference.message import FilterOptions
from ..inference.query import ENGINES
from ..model.cognitive_map import Priors
from ..model.errors import CogmapError
from ..model.growth import GROWTHS
from ..model.learning import Rates
from ..planning import CHOICES, GENERATORS


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """How an agent models, infers and plans.

    "Paper" below is de Tinguy, Verbelen and Dhoedt, "Learning dynamic cognitive map with autonomous navigation".

    Attributes:
        look_ahead: L, steps that policies look ahead (paper: 6 for its computation times, 13 or 14 in the Tolman
            maze).
        policies: policy generator: `map_guided` (ours), or `exhaustive`, `self_avoiding`, `l_shaped` (paper's
            appendix on policies).
        beam: prefixes that `map_guided` keeps a level.
        precision: γ in P(π) = softmax(-γ G) (paper: 16).
        choice: `best` takes a policy of the least G, ties broken by the seed; `sampled` draws from P(π).
        growth: `predicted`, `observed` or `static` (paper's figure on internal map layouts: c, b, a).
        places: number of places, for `static` growth only.
        rates: learning rates of the Dirichlet counts (paper's table of transition learning rates).
        forgetting: share of the evidence for transitions that fades each step (ours; off).
        certainty: Q(s) below which learning, growth and position wait (paper: 0.7).
        window: W, time steps of the factor graph that is kept.
        engine: sum-product engine of the window: `numpy` or `gtsam`.
        filter: displacement prior, slip and support of the forward filter (ours).
        priors: concentrations before evidence (ours; the paper starts from the shape of its matrices).
        discount: weight of each step of a policy relative to the one before (ours; paper: 1).
        goal_weight: weight of the utility term (paper: 1, and 2 in the Tolman maze).
        collision_cost: -log P(c = 1), what a collision costs, in nats (paper: binary; eq. 7).

    Raises:
        CogmapError: a value is out of range, or a name is unknown.
    """

    look_ahead: int = 6
    policies: str = "map_guided"
    beam: int = 64
    precision: float = 16.0
    choice: str = "best"
    growth: str = "predicted"
    places: int | None = None
    rates: Rates = field(default_factory=Rates)
    forgetting: float = 0.0
    certainty: float = 0.7
    window: int = 10
    engine: str = "numpy"
    filter: FilterOptions = field(default_factory=FilterOptions)
    priors: Priors = field(default_factory=Priors)
    discount: float = 0.95
    goal_weight: float = 1.0
    collision_cost: float = 1.0

    def __post_init__(self) -> None:
        for name in ("look_ahead", "beam", "window"):
            _check(getattr(self, name) >= 1, name, getattr(self, name), "use 1 or more")
        for name in ("precision", "collision_cost", "goal_weight"):
            _check(0.0 <= getattr(self, name) < float("inf"), name, getattr(self, name), "use a number of 0 or more")
        for name in ("forgetting", "certainty"):
            _check(0.0 <= getattr(self, name) <= 1.0, name, getattr(self, name), "use a number from 0 to 1")
        _check(self.places is None or self.places >= 1, "places", self.places, "use 1 or more, or None")
        for name, known in (("policies", GENERATORS), ("growth", GROWTHS), ("engine", ENGINES), ("choice", CHOICES)):
            value = getattr(self, name)
            _check(value in known, name, value, f"choose one of {', '.join(known)}")

    def to_dict(self) -> dict[str, Any]:
        """The settings as plain JSON values."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> Settings:
        """The settings that `to_dict` gave.

        Raises:
            CogmapError: a name is unknown.
        """
        unknown = set(values) - {field_.name for field_ in fields(cls)}
        if unknown:
            raise CogmapError(f"settings: unknown {', '.join(sorted(unknown))}; known are the fields of Settings")
        nested: dict[str, type[Any]] = {"rates": Rates, "filter": FilterOptions, "priors": Priors}
        given = dict(values)
        for name, kind in nested.items():
            if isinstance(given.get(name), dict):
                parts: dict[str, Any] = given[name]
                given[name] = kind(**{key: tuple(v) if isinstance(v, list) else v for key, v in parts.items()})
        return cls(**given)


def _check(fine: bool, name: str, value: object, remedy: str) -> None:
    if not fine:
        raise CogmapError(f"settings: {name} is {value!r}; {remedy}")
