"""What a term of expected free energy is: its name and looks, and what it gains over a rollout."""

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np

from .plain import Step
from .rolled import Floats, Rollout, Staying

KINDS = ("information", "preference", "cost")
"""What a term may be; every information gain is multiplied by the weight that the settings give to information."""


class Term(ABC):
    """A term of G(policy), summed over the steps of the policy, each weighted by the discount.

    A subclass says what the term is called and how it is told and drawn, and gives `gain`; its options are fields.

    Attributes:
        name: of its values, as in `energy["utility"]`.
        label: for people.
        sign: +1.0 where it is added to G, -1.0 where it is subtracted.
        kind: one of `KINDS`.
        colour: of lines and bars, as `#rrggbb`.
        equation: what one step adds, as a formula.
        meaning: what it is, for sentences.
    """

    name: ClassVar[str]
    label: ClassVar[str]
    sign: ClassVar[float]
    kind: ClassVar[str]
    colour: ClassVar[str]
    equation: ClassVar[str]
    meaning: ClassVar[str]

    @abstractmethod
    def gain(self, rollout: Rollout) -> Floats:
        """`[N]` nats that the last step of each prefix adds, undiscounted; the first prefix is empty and adds none."""

    @abstractmethod
    def plain(self, step: Step) -> float:
        """The same for one step of one policy, in plain Python: what `gain` is tested against."""

    def staying(self, ends: Staying, steps: int) -> Floats:
        """`[N]` nats of so many more steps that stay, each leaving the belief as it is, the first at weight one.

        `ends` holds the first of them after each policy. This is right for what depends on the step alone; a term that
        depends on earlier steps has to say itself what staying adds.
        """
        return geometric(ends.model.discount, steps) * self.gain(ends)


def geometric(ratio: float, terms: Floats | float) -> Floats:
    """1 + ratio + ... of so many terms, ratio above 0, at most 1."""
    many = np.asarray(terms, dtype=np.float64)
    if ratio == 1.0:
        return many
    return np.expm1(many * np.log(ratio)) / np.expm1(np.log(ratio))
