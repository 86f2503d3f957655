"""What a term of a choice model is: its parameters, and what it adds to the log weight of each way."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...model import CogmapError, Floats
from ..choices import Choices


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """A number that is fitted."""

    name: str  # of it
    meaning: str  # what it is, for people
    low: float  # its least value
    high: float  # its greatest value
    start: float  # where a fit sets out, and what simulated individuals have unless told otherwise
    spread: float  # standard deviation between individuals in a hierarchical fit
    typical: tuple[float, float]  # between which values further fits set out
    # standard deviation of the weak normal prior around `start` that keeps what choices do not tell from
    # running away; none unless given
    doubt: float = np.inf

    def check(self, value: float) -> float:
        """The value, if it is within bounds (else CogmapError)."""
        if not (isinstance(value, int | float | np.number) and self.low <= value <= self.high):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise CogmapError(
                f"parameter {self.name}: {value!r} is out of bounds; give a number from {self.low:g} to {self.high:g}"
            )
        return float(value)


class Term(ABC):
    """A term of the log weight of each way: P(way) is proportional to the exponential of their sum.

    Attributes:
        parameters: its own.
    """

    parameters: tuple[Parameter, ...]

    needs_agent: bool = False
    """Whether it reads `Choices.prospects`, so that an agent has to follow the walk first."""

    @abstractmethod
    def prepare(self, choices: Choices) -> Any:
        """All that does not depend on the parameters; worked out once."""

    @abstractmethod
    def weigh(self, prepared: Any, values: Floats) -> tuple[Floats, Floats]:
        """`[C, K]` nats of each way, and `[p, C, K]` their derivatives by each parameter."""

    def log_prior(self, values: Floats) -> tuple[float, Floats]:
        """Nats of a prior over the parameters (maximum a posteriori), and `[p]` its derivatives: see `doubt`."""
        start, doubt = np.array([(p.start, p.doubt) for p in self.parameters]).T
        away = (values - start) / doubt
        return -0.5 * float(away @ away), -away / doubt
