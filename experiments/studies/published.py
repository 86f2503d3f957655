"""What others published or their code comes to, to stand beside ours.

Paper: D. de Tinguy, T. Verbelen, B. Dhoedt, "Learning dynamic cognitive map with autonomous navigation", 2024; its
tables of "the average number of steps required to fully learn the environments" and of computation time. 20 runs a
maze and model; its means leave out the runs that never learned, and do not say how many those were.

Authors' code: the code published with the paper, run by us from random starts, nothing dropped (20 runs of its own
agent; 4 or 5 of CSCG, given up after 400 steps, 3x3 and T mazes only). One thread of a machine with two cores.
"""

from __future__ import annotations

from dataclasses import dataclass

ORACLE = "oracle"


@dataclass(frozen=True, slots=True)
class Figure:
    """A published mean.

    Attributes:
        mean: over the runs that got there.
        std: of the same; None where it was not given, or of one run.
        got: how many those were; None where it was not said.
        of: how many there were; None where it was not said.
    """

    mean: float
    std: float | None = None
    got: int | None = None
    of: int | None = None

    def __str__(self) -> str:
        spread = "" if self.std is None else f" ± {self.std:g}"
        return f"{self.mean:g}{spread}" + ("" if self.got is None else f" ({self.got}/{self.of})")


_MODELS = (ORACLE, "cogmap", "cscg", "cscg_pose", "cscg_random", "cscg_pose_random")
_PAPER: dict[str, tuple[tuple[float, float | None], ...]] = {
    "3x3": ((11, None), (14.4, 2), (231.9, 59), (221.3, 35), (214.6, 44), (205.7, 22)),
    "3x3_alias": ((11, None), (18.1, 2), (376.3, 35), (201.5, 20), (338.8, 30), (210.4, 22)),
    "4x4": ((15, None), (34.0, 4), (375.7, 36), (405.5, 78), (419.6, 98), (380.5, 53)),
    "4x4_alias": ((15, None), (48.9, 9), (509.5, 107), (387.5, 67), (554.1, 70), (391.3, 66)),
    "t_maze": ((9, None), (12.5, 1), (284.5, 69), (297.7, 108), (261.7, 96), (232.5, 73)),
    "t_maze_alias": ((9.5, None), (14.3, 4), (592.5, 28), (282.7, 124), (602.0, 69), (341.0, 75)),
    "donut": ((13, None), (15.6, 2), (519.6, 127), (450.0, 87), (416.3, 105), (493.1, 132)),
}

PAPER_LEARN: dict[str, dict[str, Figure]] = {
    world: {model: Figure(*figure) for model, figure in zip(_MODELS, row, strict=True)} for world, row in _PAPER.items()
}
"""Steps to learn by maze and model, from the paper's table; `cogmap` stands for the paper's own agent."""

_CSCG_AUTHORS: dict[str, tuple[Figure, ...]] = {
    "3x3": (Figure(204, 24, 5, 5), Figure(225, 25, 5, 5), Figure(220, 34, 5, 5), Figure(225, 25, 5, 5)),
    "3x3_alias": (Figure(360, None, 1, 5), Figure(213, 12, 5, 5), Figure(360, None, 1, 5), Figure(213, 12, 5, 5)),
    "t_maze": (Figure(230, 57, 4, 4), Figure(280, 65, 3, 4), Figure(230, 57, 4, 4), Figure(293, 46, 3, 4)),
}
_OWN_AUTHORS: dict[str, tuple[float, float]] = {
    "3x3": (14.2, 1.7),
    "3x3_alias": (19.1, 5.1),
    "4x4": (33.9, 5.7),
    "4x4_alias": (42.9, 10.1),
    "t_maze": (12.5, 1.3),
    "t_maze_alias": (14.6, 5.7),
    "donut": (14.9, 1.4),
}

AUTHORS_LEARN: dict[str, dict[str, Figure]] = {
    world: {
        "cogmap": Figure(*own, 20, 20),
        **dict(zip(_MODELS[2:], _CSCG_AUTHORS.get(world, ()), strict=False)),
    }
    for world, own in _OWN_AUTHORS.items()
}
"""Steps to learn by maze and model, of the authors' code as measured."""

AUTHORS_ROOMS: dict[str, float] = {
    "3x3": 10.2,
    "3x3_alias": 9.8,
    "4x4": 18.8,
    "4x4_alias": 20.2,
    "t_maze": 11.1,
    "t_maze_alias": 12.4,
    "donut": 13.1,
}
"""Steps until every room was visited, of the authors' own agent as measured; 20 of 20 runs."""

FASTER = 0.30
"""The paper's claim for its figure of room discovery: "at least 30 % faster than CSCG". It gives no numbers."""

PAPER_SECONDS = {"cogmap": 14.95, "cscg": 48.35}
"""For 100 forced exploring steps, look-ahead 6; mean of 5 runs. Maze and variant of CSCG are not said."""

AUTHORS_SECONDS = {"cogmap": 31.3, "cscg": 1.9}
"""The same of the authors' code as measured in the 4x4 maze; CSCG compiled by numba, compilation left out."""
