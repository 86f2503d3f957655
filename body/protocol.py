"""What an agent needs of a lower level: four verbs, and what they bring."""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol, runtime_checkable

OUTCOMES = ("arrived", "blocked", "unsure")


@dataclass(frozen=True, slots=True)
class Percept:
    """What a lower level reports about one upper-level step.

    Attributes:
        sight: the label of the place, or likelihoods of labels; None where nothing was made out.
        ways: for each way whether it is open: true, false, P(open), or None where it was not looked at.
        outcome: of the move: arrived, blocked or unsure; None of none.
        steps: low-level steps that it took.
        displacement, turn: as measured; None where that cannot be told.
        moved: it has gone elsewhere besides, on business of its own.
    """

    sight: Hashable | Mapping[Any, float] | None
    ways: Mapping[Any, bool | float | None] = field(default_factory=dict[Any, bool | float | None])
    outcome: str | None = None
    steps: int = 0
    displacement: tuple[float, ...] | None = None
    turn: float | None = None
    moved: bool = False


@runtime_checkable
class Body(Protocol):
    """A lower level: it receives the way to take, and carries out the move. Costs are counted in low-level steps."""

    def wake(self) -> Percept:
        """Look round once: nothing is known of where this is."""
        ...

    def perform(self, way: Any, *, budget: int | None = None) -> Percept:
        """Try to go through a way, in `budget` low-level steps at most."""
        ...

    def look(self, ways: Iterable[Any]) -> Percept:
        """Look at these ways; looking has a price."""
        ...

    def cost(self, way: Any) -> float:
        """Low-level steps that going through a way is expected to take."""
        ...
