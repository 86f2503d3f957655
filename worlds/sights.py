"""Sights for places that have none of their own."""

from collections.abc import Collection, Hashable, Sequence

import numpy as np

from .errors import WorldError

Sights = int | str  # `"distinct"`, each place its own; `"ways"`, the number of ways; or K, one of K at random


def give_sights(
    sights: Sights, ways: Sequence[int], *, seed: int = 0, taken: Collection[Hashable] = (), where: str = "sights"
) -> list[int]:
    """A whole number for each place.

    Args:
        sights: see `Sights`; a K may be written in digits.
        ways: how many ways each place has.
        seed: of the draws where there are K sights.
        taken: labels that distinct ones must not repeat.
        where: subject of the error.

    Raises:
        WorldError: none of the three, or a seed below 0.
    """
    if sights == "ways":
        return list(ways)
    if sights == "distinct":
        spoken = {str(label) for label in taken}
        free = (number for number in range(len(ways) + len(spoken)) if str(number) not in spoken)
        return [next(free) for _ in ways]
    count = int(sights) if str(sights).isdecimal() else 0
    if isinstance(sights, bool) or count < 1:
        raise WorldError(f"{where}: sights {sights!r} cannot be given; use 'distinct', 'ways', or how many at random")
    if seed < 0:
        raise WorldError(f"{where}: seed is {seed}; use 0 or more")
    return np.random.default_rng(seed).integers(count, size=len(ways)).tolist()
