"""How rooms, corridors and doors are measured, in tiles."""

from dataclasses import dataclass

from ..errors import WorldError

LEAST, MOST = 2, 24
DOORS = ("middle", "anywhere")


@dataclass(frozen=True, slots=True, kw_only=True)
class Geometry:
    """The authors' geometry unless told otherwise: rooms of 4 by 4 tiles, passages of 5, the door in the middle.

    Raises:
        WorldError: a number out of range: rooms too small for their doors, or too large.
    """

    least: int = 4  # tiles that a side of a room has at least; each side of each room is drawn evenly
    most: int = 4  # and at most
    passage: int = 5  # tiles between the floors of two rooms whose sides are the longest: 1 is a door in a common wall
    door: str = "middle"  # in the `"middle"` of its passage, or `"anywhere"` in it
    # how many doors are locked. A key of its colour for each lies somewhere, and every room can be reached
    # without any
    locked: int = 0

    def __post_init__(self) -> None:
        for name, low, high in (("least", LEAST, MOST), ("most", LEAST, MOST), ("passage", 1, MOST), ("locked", 0, 6)):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
                small = "; smaller rooms have no wall for a door" if name != "locked" and value in range(low) else ""
                raise WorldError(f"geometry: {name} is {value!r}; use {low} to {high}{small}")
        if self.least > self.most:
            raise WorldError(f"geometry: rooms have {self.least} tiles at least, {self.most} at most; turn them round")
        if self.door not in DOORS:
            raise WorldError(f"geometry: door is {self.door!r}; use {' or '.join(DOORS)}")
