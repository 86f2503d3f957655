"""Colours of floors: MiniGrid has six, mazes up to sixteen sights."""

from collections.abc import Hashable, Iterable, Mapping

from ..errors import WorldError

Colour = tuple[int, int, int]

# Chosen greedily: as shown in a lit tile each is at least 48 of 255 from every other, from walls, goals, lava and the
# bare floor, whatever the light (a gain of 0.82 to 1.2)
COLOURS: tuple[Colour, ...] = (
    (0, 0, 255),
    (0, 255, 255),
    (255, 0, 255),
    (170, 255, 0),
    (255, 0, 85),
    (0, 170, 85),
    (0, 85, 170),
    (85, 0, 170),
    (255, 85, 170),
    (255, 255, 85),
    (85, 255, 255),
    (255, 0, 0),
    (255, 85, 85),
    (85, 85, 0),
    (170, 170, 255),
    (170, 255, 170),
    (255, 170, 170),
    (255, 255, 255),
)
"""RGB of each floor; the last is white, the tile that is a goal."""

SIGHTS = len(COLOURS) - 1
"""How many sights a maze may have."""
WHITE = SIGHTS
"""The number of the white floor."""

_BASE = 6  # colours of MiniGrid, of which there is a row for each state from 1 on; state 0 is MiniGrid's own floor
FLOOR = 3  # what MiniGrid calls a floor in its encoding


def encode_floor(number: int) -> tuple[int, int, int]:
    """A floor as (object, colour, state), in the numbers that MiniGrid's own `WorldObj.decode` can read.

    MiniGrid's cache of tiles, shared by the whole process, goes by these: its own floors have state 0, ours others.
    """
    return FLOOR, number % _BASE, 1 + number // _BASE


def decode_floor(colour: int, state: int) -> int | None:
    """The number of the floor of that colour and state; None of MiniGrid's own."""
    return (state - 1) * _BASE + colour if state else None


def floors_of(name: str, sights: Iterable[Hashable]) -> Mapping[Hashable, int]:
    """The floor of each sight, in the order of the labels. Raises WorldError: there are more sights than colours."""
    labels = sorted(set(sights), key=lambda label: (isinstance(label, str), label))
    if len(labels) > SIGHTS:
        raise WorldError(f"maze {name!r} has {len(labels)} sights, and floors have {SIGHTS} colours; use fewer sights")
    return {label: number for number, label in enumerate(labels)}
