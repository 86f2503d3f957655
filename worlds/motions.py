"""The moves a world offers, as plain data."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Motions:
    """Named actions."""

    # action names, in the order of the action indices; of a world whose ways belong to the place, those that
    # every place has
    names: tuple[str, ...]
    # one vector of `n` integers an action; empty where none are declared
    displacements: tuple[tuple[int, ...], ...] = ()
    reverse: tuple[int, ...] = ()  # the index of the action that undoes each; empty where nobody says so
    takes: tuple[str | None, ...] = ()  # for each action what is carried after it, None where that stays as it is
    local: bool = False  # whether ways belong to the place, so that each observation lists those that are there


GRID = Motions(
    names=("up", "down", "left", "right", "stay"),
    displacements=((-1, 0), (1, 0), (0, -1), (0, 1), (0, 0)),
    reverse=(1, 0, 3, 2, 4),
)
