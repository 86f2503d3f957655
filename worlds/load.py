"""Worlds by name or from a file, and their Gymnasium ids."""

from __future__ import annotations

from pathlib import Path

import gymnasium as gym

from .builtin import MAZES
from .environment import MazeEnv
from .errors import WorldError
from .text_styles import read_maze


def load_world(name_or_path: str | Path, *, render_mode: str | None = None) -> MazeEnv:
    """The world of a built-in name, or else of a maze text file.

    Raises:
        WorldError: neither a name nor a file, or a file that is no maze (see `read_maze`).
    """
    if isinstance(name_or_path, str) and name_or_path in MAZES:
        return MazeEnv(MAZES[name_or_path], render_mode=render_mode)
    if not isinstance(name_or_path, (str, Path)):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise WorldError(f"{name_or_path!r} is no world; give a name or a path, or MazeEnv(maze)")
    if not _exists(Path(name_or_path)):
        raise WorldError(
            f"no world {str(name_or_path)!r}; use one of {', '.join(MAZES)}, or the path of a maze text file"
        )
    return MazeEnv(read_maze(name_or_path), render_mode=render_mode)


def register_worlds() -> None:
    """Register `cogmap/<name>-v0` for every built-in maze, once."""
    for name in MAZES:
        if f"cogmap/{name}-v0" not in gym.registry:
            gym.register(
                f"cogmap/{name}-v0",
                entry_point="cogmap.worlds.load:load_world",
                kwargs={"name_or_path": name},
            )


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:  # no permission, a name too long: read_maze says which
        return True
