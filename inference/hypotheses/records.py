"""What a hypothesis holds of a place and of its ways; records are never changed, but replaced."""

from typing import NamedTuple

NOWHERE = -1
"""Where a way leads that was never walked."""

RECENT = 8  # visits whose time is kept with a place

Position = tuple[int, ...]
SightCounts = dict[int, float]


class Way(NamedTuple):
    """One way out of a place.

    Attributes:
        net: evidence that it is open, in readings (open ones minus blocked ones, within bounds, since a way may
            change); a move that fails counts as the part of a reading that it is worth.
        open: times it was read as open since it changed last.
        blocked: times it was read as blocked since then.
        walks: times it was walked.
        to: the place it leads to, or `NOWHERE`; with no walk it is known from the way back.
        stays: times the agent was to take it and stayed where it was, where nothing says why.
    """

    net: float = 0.0
    open: float = 0.0
    blocked: float = 0.0
    walks: int = 0
    to: int = NOWHERE
    stays: float = 0.0


class Share(NamedTuple):
    """What one place contributes to the counts of the rates, as expected numbers.

    `stayed` are the times that the agent did not get through a way that was open, and `strayed` the share of other
    actions that would have kept it there, summed over these.
    """

    open: float = 0.0
    blocked: float = 0.0
    ways_wrong: float = 0.0
    ways_right: float = 0.0
    sights_wrong: float = 0.0
    sights_right: float = 0.0
    beside_open: float = 0.0
    beside_blocked: float = 0.0
    undone: float = 0.0
    one_way: float = 0.0
    stayed: float = 0.0
    strayed: float = 0.0


class Place(NamedTuple):
    """One place of a hypothesis.

    Attributes:
        sights: counts of labels, a sensor each.
        ways: by action.
        frame: the chart its position is in; a silent move to a place never seen opens a new one.
        position: in the chart; `()` without poses.
        recent: times of its last visits.
        into: (place, way) that were walked to get here.
        share: what it adds to the counts of the rates.
    """

    sights: tuple[SightCounts, ...]
    ways: tuple[Way, ...]
    frame: int
    position: Position
    recent: tuple[int, ...]
    into: frozenset[tuple[int, int]]
    share: Share

    def label(self, sensor: int = 0) -> int:
        """The sight it most probably has; -1 where it was never seen."""
        counts = self.sights[sensor]
        return max(counts, key=counts.__getitem__) if counts else -1
