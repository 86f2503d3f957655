"""The least G."""

from dataclasses import dataclass
from typing import ClassVar

from ..local import LocalModel
from .base import Choice, Floats, Ints, best_of


@dataclass(frozen=True, slots=True)
class Best(Choice):
    """Takes a policy of the least G.

    Among policies as good as the best (within `TIE`) the draw is even: an agent that knows its world walks about. Where
    something is preferred those that move least come first: an agent at its goal stays there.
    """

    name: ClassVar[str] = "best"
    how: ClassVar[str] = "the least G"

    def contenders(self, model: LocalModel, actions: Ints, G: Floats) -> Ints:
        return best_of(model, actions, G)
