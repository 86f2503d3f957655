"""Worlds with a body in them by name, as the command line calls them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..worlds import MAZES, Maze, WorldError, hall, load_world
from ..worlds import minigrid as mg

if TYPE_CHECKING:
    from .world import EmbodiedWorld

BODILY = ("pixels", "gain", "slips")
"""The kinds of noise that are of the body."""

_HALL = re.compile(r"([1-9]\d?)x([1-9]\d?)")
COLOURS = 4
"""Floor colours of the authors' mazes."""


def load_embodied(
    name: str,
    *,
    view: str | None = None,
    tiles: str | None = None,
    white: bool = False,
    noise: Mapping[str, float] | None = None,
    turned: bool = False,
    format: str = "text",
    sights: int | str | None = None,
    seed: int = 0,
) -> EmbodiedWorld:
    """A room maze in MiniGrid with a body in it.

    Args:
        name: of a built-in maze; else rows and columns of a hall, such as `3x4`, in the authors' four colours at random
            (or as `sights` says); else a maze file.
        view: `"symbolic"`, which it is unless given, or `"rgb"`.
        tiles: a side of a room, `"4"`, or from `"4-12"`.
        white: whether one tile, in a room drawn by `seed`, is white.
        noise: of pixels, gain and slips.
        turned: whether a silent move turns the body.
        format, sights, seed: as for `load_world`.

    Raises:
        WorldError: MiniGrid is missing, there is no such maze, or an option makes no sense.
    """
    mg.need_minigrid()
    from .world import embodied

    maze = _maze(name, format, sights, seed)
    least, most = _sizes(tiles)
    room = maze.rooms[int(np.random.default_rng([seed, 2]).integers(len(maze.rooms)))] if white else None
    how: Any = {"view": view or "symbolic", "white": room, "noise": noise, "turned": turned}
    return embodied(maze, **how, least=least, most=most)


def _maze(name: str, format: Any, sights: int | str | None, seed: int) -> Maze:
    size = _HALL.fullmatch(name)
    if size is not None and name not in MAZES:
        rows, columns = map(int, size.groups())
        if sights not in (None, "distinct") and not isinstance(sights, int):
            raise WorldError(f"sights {sights!r} cannot be given to a hall of rooms; use 'distinct' or how many")
        kinds = None if sights == "distinct" else COLOURS if sights is None else int(sights)
        made = hall(rows, columns, sights=kinds, rng=np.random.default_rng(seed))
        return Maze(name, dict(made.sights), made.walls)
    return load_world(name, format=format, sights=sights, seed=seed).maze


def _sizes(tiles: str | None) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,3})(?:-(\d{1,3}))?", (tiles or "4").strip())
    if found is None:
        raise WorldError(f"tiles: {tiles!r} is no size of rooms; give a number, such as 4, or a range, such as 4-12")
    return int(found[1]), int(found[2] or found[1])
