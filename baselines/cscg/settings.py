"""The settings of a CSCG agent."""

from dataclasses import asdict, dataclass
from math import isfinite
from typing import Any

from ...worlds import WorldError

EXPLORING = ("random", "targets", "curious")
RETRAINING = ("restart", "continue")
NAVIGATION = ("viterbi", "random")


@dataclass(frozen=True, slots=True, kw_only=True)
class CscgSettings:
    """How a CSCG agent learns and explores.

    Attributes:
        clones: clones an observation.
        pseudocount: kappa of expectation maximisation.
        iterations: of expectation maximisation, at most, each time it is retrained.
        tolerance: expectation maximisation stops when an iteration raises its objective by less than this, in nats
            a step of the history; 0: never before `iterations`.
        viterbi_pseudocount: kappa of Viterbi training, and of the model that is used.
        viterbi_iterations: of Viterbi training, at most; it stops when its path no longer changes.
        retrain_every: observations between two trainings, each on the whole history.
        retraining: `"restart"` begins each training with new random counts, `"continue"` with the last expected
            counts, and random ones where a transition is new.
        exploring: what `"viterbi"` navigation does without a preferred sight. `"random"`: nothing is preferred, so
            random moves. `"targets"`: go to a state drawn among the decoded ones; there one random move, and a new
            draw. `"curious"` (ours, not the paper's): go to the nearest state with the least tried action, and take it.
        stays: whether exploring stays in a room now and then, to learn what that does.

    Raises:
        WorldError: a value that cannot be.
    """

    clones: int = 10
    pseudocount: float = 0.05
    iterations: int = 200
    tolerance: float = 1e-4
    viterbi_pseudocount: float = 1e-4
    viterbi_iterations: int = 100
    retrain_every: int = 5
    retraining: str = "restart"
    exploring: str = "random"
    stays: bool = False

    def __post_init__(self) -> None:
        for name in ("clones", "viterbi_iterations", "retrain_every"):
            whole(name, getattr(self, name), least=1)
        whole("iterations", self.iterations, least=0)
        for name in ("pseudocount", "viterbi_pseudocount", "tolerance"):
            _amount(name, getattr(self, name))
        one_of("retraining", self.retraining, RETRAINING)
        one_of("exploring", self.exploring, EXPLORING)
        one_of("stays", self.stays, (False, True))

    def to_dict(self) -> dict[str, Any]:
        """The settings by name, as JSON can hold them."""
        return asdict(self)


def one_of(name: str, value: object, names: tuple[object, ...]) -> None:
    """Refuse a value that is none of `names`. Raises WorldError: the same."""
    if value not in names:
        raise WorldError(f"{name} of a CSCG agent is one of {', '.join(map(str, names))}; got {value!r}")


def whole(name: str, value: Any, *, least: int) -> None:
    """Refuse what is no whole number of `least` or more. Raises WorldError: the same."""
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise WorldError(f"{name} of a CSCG agent is a whole number of {least} or more; got {value!r}")


def _amount(name: str, value: Any) -> None:
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value) or value < 0:
        raise WorldError(f"{name} of a CSCG agent is a finite number of 0 or more; got {value!r}")
