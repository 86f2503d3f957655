"""Worlds by name or from a file, and their Gymnasium ids."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

import gymnasium as gym

from .base import PlaceEnv
from .builtin import MAZES
from .environment import MazeEnv
from .errors import WorldError
from .graph import GraphWorld, Layout, is_graph_file, read_graph
from .maze import Maze
from .protocol import Chart
from .sights import Sights, give_sights
from .text_styles import read_maze

_ID = re.compile(r"^cogmap/(\w+)-v0$")


def load_world(
    name_or_path: str | Path,
    *,
    render_mode: str | None = None,
    format: Literal["text", "commas", "ascii"] = "text",
    sights: Sights | None = None,
    seed: int = 0,
    sensors: Sequence[str] | None = None,
    pose: Literal["motions", "displacement", "lengths", "bearing", "none"] | None = None,
    strong: bool = True,
) -> PlaceEnv:
    """The world of a built-in name, or else of a maze or graph file: a `MazeEnv` or a `GraphWorld`.

    Args:
        name_or_path: a name of `MAZES`, or its id such as `cogmap/3x3-v0`; a graph file (JSON, GraphML, YAML, see
            `read_graph`); or a maze text file.
        render_mode: of mazes; see `MazeEnv`.
        format: of a maze file: `"text"`, `"commas"` or `"ascii"`; see `read_maze`.
        sights: for places without a sight of their own: `"distinct"`, `"ways"`, or how many at random.
        seed: of sights at random.
        sensors: of graphs, and so are `pose` and `strong`; see `GraphWorld.from_networkx`.
        pose: what is told of a pose.
        strong: refuse graphs that are not strongly connected.

    Raises:
        WorldError: sights that cannot be given, a pose of a maze, neither a name nor a file, or a file that has no such
            world in it.
    """
    if sights is not None:
        give_sights(sights, ())  # is it any of the three
    if isinstance(name_or_path, str) and (name := _ID.sub(r"\1", name_or_path)) in MAZES:
        _refuse_pose(pose, name)
        return MazeEnv(MAZES[name], render_mode=render_mode)
    if not isinstance(name_or_path, (str, Path)):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise WorldError(f"{name_or_path!r} is no world; give a name or a path, or MazeEnv(maze)")
    if not _exists(Path(name_or_path)):
        raise WorldError(
            f"no world {str(name_or_path)!r}; use one of {', '.join(MAZES)}, or the path of a maze or graph file"
        )
    if is_graph_file(name_or_path) and not Path(name_or_path).is_dir():
        options: dict[str, Any] = {"sights": sights, "seed": seed, "sensors": sensors, "pose": pose, "strong": strong}
        return GraphWorld(read_graph(name_or_path, **options))
    _refuse_pose(pose, name_or_path)
    drawn = "distinct" if sights is None else sights
    return MazeEnv(read_maze(name_or_path, format=format, sights=drawn, seed=seed), render_mode=render_mode)


def _refuse_pose(pose: str | None, world: str | Path) -> None:
    if pose not in (None, "motions"):
        raise WorldError(
            f"pose {pose!r} is for graph files, not for the maze {str(world)!r}, whose moves are told: leave it out"
        )


def world_of(chart: Chart) -> PlaceEnv:
    """A world whose true map is `chart`. Raises WorldError: neither a `Maze` nor a `Layout`."""
    if isinstance(chart, Maze):
        return MazeEnv(chart)
    if isinstance(chart, Layout):
        return GraphWorld(chart)
    raise WorldError(f"no world can be made of a {type(chart).__name__}; give a Maze or the Layout of a graph")


def register_worlds() -> None:
    """Register `cogmap/<name>-v0` for every built-in maze, and `cogmap/World-v0` for any file, once.

    `cogmap/MiniGrid-<name>-v0` is the maze as an environment of MiniGrid, which is imported when one is made.
    """
    ids = {f"cogmap/{name}-v0": {"name_or_path": name} for name in MAZES}
    for name, arguments in {**ids, "cogmap/World-v0": {}}.items():
        if name not in gym.registry:
            gym.register(name, entry_point="cogmap.worlds.load:load_world", kwargs=arguments)
    for maze in MAZES:
        if (name := f"cogmap/MiniGrid-{maze}-v0") not in gym.registry:
            gym.register(name, entry_point="cogmap.worlds.minigrid:rooms_env", kwargs={"maze": maze})


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:  # no permission, a name too long: the reader says which
        return True
