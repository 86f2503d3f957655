"""The options of a plan: ways to places never entered."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Frontier:
    """The best options, the best first.

    Attributes:
        paths: the actions of each.
        places: the places of the map on these ways, ascending.
        back: for the place that each of them ends in, how far it is from there to what else was never entered, on
            average, as ways are measured.
        costs: of each step on them, by its place and action, as ways are measured; one of others.
    """

    paths: tuple[tuple[int, ...], ...]
    places: tuple[int, ...]
    back: Mapping[int, float]
    costs: Mapping[tuple[int, int], float] = field(default_factory=dict[tuple[int, int], float])
