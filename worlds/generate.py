"""Families of mazes of any size. Corridors keep an empty cell apart, as all adjacent rooms share a door."""

from collections.abc import Iterable

import numpy as np

from .errors import WorldError
from .maze import Label, Maze, Position
from .motions import GRID


def comb(teeth: int, length: int, *, sights: int | None = None, rng: np.random.Generator | None = None) -> Maze:
    """A corridor with `teeth` dead ends of `length` rooms: 2·teeth - 1 + teeth·length rooms.

    In this and the other families `sights=None` makes all sights different, `sights=k` draws each of k
    at random with `rng`.

    Raises:
        WorldError: a size is too small, or `sights` is given without `rng`.
    """
    at_least("comb", teeth=(teeth, 1), length=(length, 0))
    spine = [(0, column) for column in range(2 * teeth - 1)]
    tines = [(row, 2 * tooth) for tooth in range(teeth) for row in range(1, length + 1)]
    return _furnish(f"comb_{teeth}x{length}", spine + tines, sights, rng)


def spiral(side: int, *, sights: int | None = None, rng: np.random.Generator | None = None) -> Maze:
    """One corridor wound inwards from (0, 0) in a square of `side` by `side` cells."""
    at_least("spiral", side=(side, 1))
    rooms: list[Position] = [(0, 0)]
    arms = [side - 1, *(side - 1 - 2 * (i // 2) for i in range(side))]
    for i, arm in enumerate(arms):
        if arm < 2 and i >= 2:
            break  # a shorter arm would touch the one before it
        down, right = ((0, 1), (1, 0), (0, -1), (-1, 0))[i % 4]
        row, column = rooms[-1]
        rooms.extend((row + down * k, column + right * k) for k in range(1, arm + 1))
    return _furnish(f"spiral_{side}", rooms, sights, rng)


def rings(count: int, side: int = 3, *, sights: int | None = None, rng: np.random.Generator | None = None) -> Maze:
    """`count` square rings of `side` by `side` cells in a row, each joined to the next by one room."""
    at_least("rings", count=(count, 1), side=(side, 3))
    ring = [(r, c) for r in range(side) for c in range(side) if {r, c} & {0, side - 1}]
    rooms = [(r, c + k * (side + 1)) for k in range(count) for r, c in ring]
    joints = [(side // 2, k * (side + 1) - 1) for k in range(1, count)]
    return _furnish(f"rings_{count}x{side}", rooms + joints, sights, rng)


def hall(rows: int, columns: int, *, sights: int | None = 3, rng: np.random.Generator | None = None) -> Maze:
    """An open hall of `rows` by `columns` rooms."""
    at_least("hall", rows=(rows, 1), columns=(columns, 1))
    return _furnish(f"hall_{rows}x{columns}", np.ndindex(rows, columns), sights, rng)


def office(corridors: int, length: int, *, doors: float = 0.1, seed: int = 0, sights: int | None = None) -> Maze:
    """Corridors of `length` cells with rooms on both sides, joined at one end by a hall across.

    Every room has a door to its corridor; walls stand between rooms, and between the rows of rooms of two corridors.

    Args:
        corridors: how many, side by side.
        length: cells of each; twice as many rooms lie along it.
        doors: the share of walls between rooms of one row that have a door.
        seed: of these doors, and of repeating sights.
        sights: how many different ones; None makes all of them different.

    Raises:
        WorldError: a size is too small, or `doors` is not from 0 to 1.
    """
    at_least("office", corridors=(corridors, 1), length=(length, 1))
    if not 0.0 <= doors <= 1.0:
        raise WorldError(f"office: doors is {doors}; use a share from 0 to 1")
    rng = np.random.default_rng(seed)
    plan = hall(3 * corridors, length + 1, sights=sights, rng=rng)
    walls: set[tuple[Position, Position]] = set()
    for a, b in plan.doors:
        if min(a[1], b[1]) == 0 and max(a[1], b[1]) == 0:
            continue  # the hall across
        into_hall = a[1] == 0 and a[0] % 3 != 1
        beside = a[1] > 0 and a[0] == b[0] and a[0] % 3 != 1 and rng.random() >= doors
        back_to_back = a[1] > 0 and a[0] % 3 == 2 and b[0] % 3 == 0
        if into_hall or beside or back_to_back:
            walls.add((a, b))
    return Maze(f"office_{corridors}x{length}", plan.sights, frozenset(walls))


def random_maze(rooms: int, *, sights: int | None = None, rng: np.random.Generator) -> Maze:
    """A connected maze of `rooms` rooms, each built on at a free side drawn uniformly."""
    at_least("random_maze", rooms=(rooms, 1))
    taken: set[Position] = {(0, 0)}
    free = _sides((0, 0))
    while len(taken) < rooms:
        pick = int(rng.integers(len(free)))
        free[pick], free[-1] = free[-1], free[pick]
        room = free.pop()
        if room not in taken:
            taken.add(room)
            free.extend(side for side in _sides(room) if side not in taken)
    top, left = min(row for row, _ in taken), min(column for _, column in taken)
    return _furnish(f"random_{rooms}", ((row - top, column - left) for row, column in taken), sights, rng)


def _sides(room: Position) -> list[Position]:
    return [(room[0] + down, room[1] + right) for down, right in GRID.displacements if down or right]


def _furnish(name: str, rooms: Iterable[tuple[int, ...]], sights: int | None, rng: np.random.Generator | None) -> Maze:
    places = sorted({(room[0], room[1]) for room in rooms})
    if sights is None:
        labels: list[int] = list(range(len(places)))
    elif sights < 1:
        raise WorldError(f"{name}: {sights} sights are too few; use at least 1, or None for all different")
    elif rng is None:
        raise WorldError(f"{name}: repeating sights are drawn at random; give rng, or sights=None")
    else:
        labels = rng.integers(sights, size=len(places)).tolist()
    drawn: dict[Position, Label] = dict(zip(places, labels, strict=True))
    return Maze(name, drawn)


def at_least(family: str, **sizes: tuple[int, int]) -> None:
    """Refuse sizes that are too small: each is given with the least it may be. Raises WorldError: one is."""
    for what, (size, least) in sizes.items():
        if size < least:
            raise WorldError(f"{family}: {what} is {size}; use at least {least}")
