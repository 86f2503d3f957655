"""The rates of one hypothesis at one step, ready for use."""

from collections.abc import Sequence
from math import log

from .rates import (
    ALIKE,
    ASTRAY,
    BESIDE,
    CHANGED,
    ELSEWHERE,
    FAILS,
    MOVED,
    NEW,
    OPEN,
    RATE_PRIORS,
    RELINKED,
    SIGHT_MISREAD,
    SQUARE,
    UNDONE,
    WAY_MISREAD,
    RateCounts,
)

SUREST, LEAST_SURE = 1e-4, 0.45  # bounds of the rates of misreading: a reading is never proof, and never worth nothing

MOST_MISREAD = 0.33
"""A sight is right twice in three times at least, or a long corridor would be one place, misread over and over."""


class Chances:
    """Expected rates.

    Attributes:
        open, odds: P(a way is open) and its log odds.
        beside: log odds that a way is open beyond which there is a known place.
        wrong, unit: P(a way is misread) and the log odds that one reading is worth.
        wrongs: (probability, P(a way is misread)) of each kind of world: where one reading is wrong, others may be.
        limit, most: the log odds beyond which nothing is believed of a way, since it may change; in readings.
        misread, right, sight_unit: P(a sight is misread as a certain other label), P(it is read right), and the log
            odds that one reading is worth; a sensor each.
        labels: number of labels of each sensor, one never met included.
        pairs: P(two sides are one door), by what was read of each, as far as it was worked out.
        rebuilt: P(all ways of a place are others than they were), which is what one of them has.
        doors: what so many readings of the other side of a door add, as far as it was worked out.
        fails, astray, moved, elsewhere, undone, new, relinked, square, alike: as the rates are called.
    """

    __slots__ = (
        "alike",
        "astray",
        "beside",
        "doors",
        "elsewhere",
        "fails",
        "labels",
        "limit",
        "misread",
        "most",
        "moved",
        "new",
        "odds",
        "open",
        "pairs",
        "rebuilt",
        "relinked",
        "right",
        "sight_unit",
        "square",
        "undone",
        "unit",
        "wrong",
        "wrongs",
    )

    def __init__(self, counts: RateCounts, labels: Sequence[int], *, size: int = 1) -> None:
        mean = counts.mean
        found = size - 1.0  # ways by which places were found say nothing of those between places found otherwise
        beside = (counts.yes[BESIDE] - found, counts.no[BESIDE])
        between = (1.0 + max(beside[0], 0.0)) / (2.0 + max(beside[0], 0.0) + max(beside[1], 0.0))
        self.beside = log(between / (1.0 - between))
        self.open = mean(OPEN)
        self.odds = log(self.open / (1.0 - self.open))
        parts = RATE_PRIORS[WAY_MISREAD].posterior(*counts.of(WAY_MISREAD))
        self.wrongs = tuple((weight, min(max(wrong, SUREST), LEAST_SURE)) for weight, wrong in parts)
        self.wrong = sum(weight * wrong for weight, wrong in self.wrongs)
        self.unit = log((1.0 - self.wrong) / self.wrong)
        self.rebuilt = mean(CHANGED)
        self.limit = -log(self.rebuilt)
        self.most = self.limit / self.unit
        self.fails, self.astray, self.moved = mean(FAILS), mean(ASTRAY), mean(MOVED)
        self.elsewhere, self.undone, self.new = mean(ELSEWHERE), mean(UNDONE), mean(NEW)
        self.relinked, self.square, self.alike = mean(RELINKED), mean(SQUARE), mean(ALIKE)
        error = min(max(mean(SIGHT_MISREAD), SUREST), MOST_MISREAD)
        self.doors: dict[float, float] = {}
        self.pairs: dict[tuple[float, float], float] = {}
        self.labels = tuple(labels)
        self.misread = tuple(error / n for n in labels)
        self.right = tuple(1.0 - error + each for each in self.misread)
        self.sight_unit = tuple(log(r / m) for r, m in zip(self.right, self.misread, strict=True))
