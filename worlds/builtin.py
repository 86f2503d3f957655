"""The eight mazes of the paper."""

from collections.abc import Mapping
from types import MappingProxyType

from .maze import Maze
from .text import parse_maze

_LAYOUTS = {
    "3x3": """
        0 1 2
        5 4 3
        6 7 8
    """,
    "3x3_alias": """
        0 0 1
        2 0 4
        3 3 3
    """,
    "4x4": """
         0  1  2  3
         7  6  5  4
         8  9 10 11
        12 13 14 15
    """,
    "4x4_alias": """
        0 0 1 4
        2 1 1 3
        3 5 3 0
        1 0 4 0
    """,
    "t_maze": """
        0 1 2 3 7
        . . 4 . .
        . . 5 . .
        . . 6 . .
    """,
    "t_maze_alias": """
        0 1 2 1 0
        . . 3 . .
        . . 3 . .
        . . 3 . .
    """,
    "donut": """
        0  1  2  3  4
        5  .  .  . 13
        6  .  .  . 12
        7  8  9 10  0
    """,
    "tolman": """
        . .  0  .  .  .
        . . 11  3  1  4
        . .  2  .  .  4
        4 1  5  .  . 13
        6 . 10  .  . 12
        3 . 14  .  . 11
        7 8  9 10  5 11
    """,
}

MAZES: Mapping[str, Maze] = MappingProxyType({name: parse_maze(layout, name=name) for name, layout in _LAYOUTS.items()})
