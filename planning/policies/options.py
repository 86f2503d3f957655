"""Exploring by options: the likely shortest ways to places never entered."""

from dataclasses import dataclass
from typing import ClassVar

from ...model import CogmapError, Motions, is_number
from ..choices import TIE, Outward
from ..local import Frontier, LocalModel, Surroundings
from ..terms import Term, WayBack, WayThere
from .base import Policies, PolicyGenerator, padded
from .frontier import BY, STEPS, frontier_of


@dataclass(frozen=True, slots=True)
class Options(PolicyGenerator):
    """Policies as options: a likely shortest path to each unvisited place that is worth visiting.

    While anything is unknown each step costs `cost` nats, and what a place teaches is collected whichever comes first,
    so it cancels between options:

        G(o_f) = cost [ d(q, f) - weight E_g |x_f - x_g| / l ]

    d is the way there in steps, g runs over the other places never entered, x are positions, imagined ones too, and l
    is the longest step: the way there now, less the way back to it later. Near me, and far from what else is left.
    Places further off than (1 + weight) / (1 - weight) times the nearest, and a step, are never headed for.

    After "Information Gain Is Not All You Need" (Ericson, Pedro, Jensfelt, arXiv 2504.01980), a distance advantage.

    Raises:
        CogmapError: a number is out of range, or `by` is neither.
    """

    name: ClassVar[str] = "options"
    weight: float = 0.5  # lambda, what a step of the way back counts beside one of the way there; below 1
    cost: float = 1.0  # of a step, in nats
    kept: int = 8  # of so many of the best options the plan keeps record
    near: bool = True  # whether options also decide where something new is within the look-ahead
    # what d and the way back are measured in: "steps", or "metres", over the mean length of a way, where places
    # have positions in metres; l is the mean length then
    by: str = STEPS

    def __post_init__(self) -> None:
        if not is_number(self.weight, 0.0, 0.95):
            raise CogmapError(f"options: weight is {self.weight!r}; give a number from 0 to 0.95")
        if not is_number(self.cost, 1e-3, 1e3):
            raise CogmapError(f"options: cost is {self.cost!r}; give a number of nats from 0.001 to 1000")
        if not (isinstance(self.kept, int) and 1 <= self.kept <= 1_000):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise CogmapError(f"options: kept is {self.kept!r}; give a whole number from 1 to 1000")

        if self.by not in BY:
            raise CogmapError(f"options: ways cannot be measured by {self.by!r}; use one of {', '.join(BY)}")

    @property
    def terms(self) -> tuple[Term, ...]:
        """What the G of an option is the sum of."""
        return WayThere(self.cost), WayBack(self.cost * self.weight)

    @property
    def choice(self) -> Outward:
        """The least G; of equals the furthest out, then by lot."""
        return Outward(slack=TIE)

    def found(self, around: Surroundings) -> Frontier | None:
        """The best options from where the agent is; None where there are none, or they are not to decide here."""
        if around.preferences.sights or around.preferences.places or around.structure is not None:
            return None
        least = 0 if self.near else around.look_ahead
        return frontier_of(around, weight=self.weight, most=self.kept, beyond=least, by=self.by)

    def make(self, model: LocalModel) -> Policies:
        self.check(model.motions, model.look_ahead)
        frontier = model.frontier
        paths = [()] if frontier is None else frontier.paths
        return Policies(padded(paths, stay=model.motions.stay, length=model.look_ahead))

    def count(self, motions: Motions, look_ahead: int) -> int:
        return self.kept
