"""What is known beforehand of the ways of a world, and what one step brings."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite

from ...model import CogmapError
from .records import Position

Reading = int | Mapping[int, float] | None  # A label, by number; likelihoods of labels; or None: not seen


@dataclass(frozen=True, slots=True)
class WayScheme:
    """The ways that a place may have, and which of them undo each other.

    Raises:
        CogmapError: the parts do not fit `count` ways.
    """

    count: int  # how many; a way is an action
    inverse: tuple[int, ...] | None = None  # the action that undoes each; None where that is not known
    displacements: tuple[Position, ...] | None = None  # of each way, in Z^n; None without poses. They need `inverse`
    sensors: int = 1  # how many sensors of sights there are

    def __post_init__(self) -> None:
        if self.count < 1 or self.sensors < 0:
            raise CogmapError(
                f"ways: {self.count} ways and {self.sensors} sensors; give 1 way or more, 0 sensors or more"
            )
        if self.inverse is not None and sorted(self.inverse) != list(range(self.count)):
            raise CogmapError(f"ways: inverse is {self.inverse}; name each of the {self.count} ways once")
        if self.displacements is not None and (self.inverse is None or len(self.displacements) != self.count):
            raise CogmapError(f"ways: displacements need an inverse, and one vector for each of the {self.count} ways")

    @property
    def origin(self) -> Position:
        """The position that a chart starts from."""
        return (0,) * len(self.displacements[0]) if self.displacements else ()


@dataclass(frozen=True, slots=True)
class Sensed:
    """The readings of one step."""

    sights: tuple[Reading, ...]  # a reading of each sensor
    ways: tuple[float | None, ...]  # P(open) of each way as it was read, or None where it was not looked at
    action: int | None = None  # the way that was to be taken; None for staying where it is
    certain: bool = False  # the action is known to have been carried out (`taken`), so none went astray
    told: bool = False  # the agent is told that it was moved
    # log-likelihood of what further sensors read, neither labels nor ways, at the place of a number; at a place
    # never seen for None
    others: Callable[[int | None], float] | None = None
    # log-likelihood of what was measured or said of the move: of having taken each way, and last of none; the
    # largest is 0. None where nothing was
    went: tuple[float, ...] | None = None
    fails: float = 0.0  # the move failed at least so probably, if its way was open, as the body has it

    def of_taking(self, way: int) -> float:
        """Log-likelihood of what was measured or said of the move, if this way was taken; `NOWHERE` for none."""
        return 0.0 if self.went is None else self.went[way]

    def check(self, scheme: WayScheme) -> None:
        """Refuse what such ways and sensors cannot bring.

        Raises:
            CogmapError: too many or too few readings, no probability, no likelihood, or no such action.
        """
        if len(self.sights) != scheme.sensors or len(self.ways) != scheme.count:
            given = f"{len(self.sights)} sights and {len(self.ways)} ways"
            raise CogmapError(f"sensed: {given}; give {scheme.sensors} and {scheme.count}, None for what was not seen")
        if self.action is not None and not 0 <= self.action < scheme.count:
            raise CogmapError(f"sensed: action is {self.action}; give 0 to {scheme.count - 1}, or None for staying")
        for way in self.ways:
            if way is not None and not 0.0 <= way <= 1.0:
                raise CogmapError(f"sensed: P(open) is {way}; give a number from 0 to 1, or None")
        if self.went is not None and not (
            len(self.went) == scheme.count + 1 and max(self.went) == 0.0 and all(map(isfinite, self.went))
        ):
            raise CogmapError(f"sensed: went is {self.went}; give {scheme.count + 1} finite numbers, the largest 0")
        if not 0.0 <= self.fails <= 1.0:
            raise CogmapError(f"sensed: fails is {self.fails}; give a number from 0 to 1")
        for sight in self.sights:
            if not (sight is None or isinstance(sight, (int, Mapping))):  # pyright: ignore[reportUnnecessaryIsInstance]
                raise CogmapError(f"sensed: sight is {sight!r}; give the number of a label, likelihoods, or None")
            values = list(sight.values()) if isinstance(sight, Mapping) else []
            if isinstance(sight, Mapping) and not (values and max(values) > 0.0 and all(map(_likelihood, values))):
                raise CogmapError(f"sensed: {sight} are no likelihoods; give finite numbers, one of them above 0")


def _likelihood(value: float) -> bool:
    return isfinite(value) and value >= 0.0
