"""What is believed of the ways of a place."""

Doors = tuple[bool | float | None, ...]
"""For each action whether its way is believed open, or how much so; None where nothing is known of it."""


def passable(doors: Doors) -> tuple[bool, ...]:
    """For each action whether something may lie beyond: where nothing is known of its way, it may."""
    return tuple(door is None or door > 0.5 for door in doors)
