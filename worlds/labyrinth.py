"""Random mazes of any size, from a tree of corridors to an open hall."""

import numpy as np
from numpy.typing import NDArray

from .errors import WorldError
from .maze import Label, Maze, Position

Ints = NDArray[np.int64]


def labyrinth(rooms: int, *, loops: float = 0.0, sights: int | None = None, rng: np.random.Generator) -> Maze:
    """A random maze of exactly `rooms` rooms; a million take seconds.

    Crossings lie on every second row and column of a square, joined to a random spanning tree by a room each
    (Kruskal's maze: the least spanning tree of random weights). The cells left between them are of two kinds: rooms
    that would join crossings, and pillars amid four crossings. `loops` opens that share of them, in a random order
    and the joining rooms first: each of those adds one independent cycle, each pillar three. The last few rooms are
    niches in the outer wall, where the square does not come out even.

    Args:
        rooms: how many.
        loops: 0 is a tree of corridors, 0.5 a grid of streets, 1 an open hall.
        sights: how many different ones, each in as many rooms as the others (or one more) and placed at random; None
            makes all of them different.
        rng: draws all of it.

    Raises:
        WorldError: `rooms` is below 1, `loops` is not from 0 to 1, or `sights` not from 1 to `rooms`.
    """
    _check(rooms, loops, sights)
    columns, crossings, opened = _plan(rooms, loops)
    joints = _joints(columns, crossings)
    tree = _spanning_tree(joints, crossings, rng)
    between = joints[rng.permutation(np.flatnonzero(~tree))]
    pillars = rng.permutation(_pillars(columns, crossings))
    first, second = np.vstack([joints[tree], between, pillars])[: crossings - 1 + opened].T
    halls = (_cell(first, columns) + _cell(second, columns)) // 2
    cells = np.vstack([_cell(np.arange(crossings), columns), halls])
    cells = np.vstack([cells, _niches(columns, crossings)[: rooms - len(cells)]])
    return _maze(f"labyrinth_{rooms}", cells - cells.min(axis=0), sights, rng)


def _check(rooms: int, loops: float, sights: int | None) -> None:
    if rooms < 1:
        raise WorldError(f"labyrinth: rooms is {rooms}; use at least 1")
    if not 0.0 <= loops <= 1.0:
        raise WorldError(f"labyrinth: loops is {loops}; use a share from 0 (a tree) to 1 (an open hall)")
    if sights is not None and not 1 <= sights <= rooms:
        raise WorldError(f"labyrinth: {sights} sights do not fit {rooms} rooms; use 1 to {rooms}, or None")


def _plan(rooms: int, loops: float) -> tuple[int, int, int]:
    """Columns of crossings, as many crossings as there is room for, and cells to open beyond the tree's."""
    columns = max(1, round((rooms / (2.0 + 2.0 * loops)) ** 0.5))
    least, beyond = 1, rooms + 1  # the largest number that fits is sought by halving
    while beyond - least > 1:
        middle = (least + beyond) // 2
        fits = 2 * middle - 1 + round(2 * loops * _faces(columns, middle)) <= rooms
        least, beyond = (middle, beyond) if fits else (least, middle)
    faces = _faces(columns, least)
    spare = rooms - (2 * least - 1)
    return columns, least, min(spare, round(2 * loops * faces))


def _faces(columns: int, crossings: int) -> int:
    """Pillars amid four crossings; as many rooms join crossings beyond a tree."""
    full, rest = divmod(crossings, columns)
    return max(full - 1, 0) * (columns - 1) + (max(rest - 1, 0) if full else 0)


def _joints(columns: int, crossings: int) -> Ints:
    """`[n, 2]` the crossings next to one another, to the right and below."""
    at = np.arange(crossings)
    right = at[(at % columns < columns - 1) & (at + 1 < crossings)]
    down = at[at + columns < crossings]
    return np.vstack([np.column_stack([right, right + 1]), np.column_stack([down, down + columns])])


def _pillars(columns: int, crossings: int) -> Ints:
    """`[n, 2]` opposite corners of each four crossings."""
    at = np.arange(crossings)
    corner = at[(at % columns < columns - 1) & (at + columns + 1 < crossings)]
    return np.column_stack([corner, corner + columns + 1])


def _spanning_tree(joints: Ints, crossings: int, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Which of the joints belong to a random spanning tree."""
    from scipy.sparse import csr_array  # slow to import, and only needed here
    from scipy.sparse.csgraph import minimum_spanning_tree

    weights = rng.permutation(len(joints)) + 1.0  # all different, none of them zero: one tree is the least
    ends = joints.astype(np.int32)  # scipy before 1.17 takes no other indices
    graph = csr_array((weights, (ends[:, 0], ends[:, 1])), shape=(crossings, crossings))
    chosen = np.asarray(minimum_spanning_tree(graph).data, dtype=np.int64) - 1
    by_weight = np.zeros(len(joints), dtype=np.bool_)
    by_weight[chosen] = True
    return by_weight[weights.astype(np.int64) - 1]


def _cell(crossing: Ints, columns: int) -> Ints:
    """`[n, 2]` row and column."""
    return 2 * np.column_stack(np.divmod(crossing, columns))


def _niches(columns: int, crossings: int) -> Ints:
    """`[n, 2]` cells outside the square that touch one crossing each."""
    above = [(-1, 2 * column) for column in range(min(columns, crossings))]
    left = [(2 * row, -1) for row in range(-(-crossings // columns))]
    return np.array(above + left)


def _maze(name: str, cells: Ints, sights: int | None, rng: np.random.Generator) -> Maze:
    rows, columns = cells[np.lexsort(cells.T[::-1])].T
    labels = np.arange(len(cells)) if sights is None else rng.permutation(np.arange(len(cells)) % sights)
    # objects that are shared: a million rooms need only some thousand numbers
    number = np.arange(max(int(cells.max()), int(labels.max())) + 1).astype(object)
    places: list[Position] = list(zip(number[rows].tolist(), number[columns].tolist(), strict=True))
    drawn: dict[Position, Label] = dict(zip(places, number[labels].tolist(), strict=True))
    return Maze(name, drawn)
