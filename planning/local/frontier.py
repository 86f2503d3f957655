"""The options of a plan: ways to places never entered."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Frontier:
    """The best options, best first."""

    paths: tuple[tuple[int, ...], ...]  # the actions of each
    places: tuple[int, ...]  # the places of the map on these ways, ascending
    # for the place that each of them ends in, how far it is from there to what else was never entered, on
    # average, as ways are measured
    back: Mapping[int, float]
    # of each step on them, by its place and action, as ways are measured; one of others
    costs: Mapping[tuple[int, int], float] = field(default_factory=dict[tuple[int, int], float])
