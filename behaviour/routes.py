"""Recorded walks laid over their world, checked step by step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from ..model import CogmapError, Ints
from .ground import Ground
from .walks import Walk


@dataclass(frozen=True, eq=False)
class Route:
    """A walk over the places of a world, by number; home lies between its bouts."""

    individual: str  # who walked
    places: Ints  # `[T]` the place at each step
    bout: Ints  # `[T]` the bout of each step, from 0; the way home at its end belongs to a bout

    def until(self, place: int) -> Route:
        """What comes before the first visit of a place; all where it is never visited."""
        found = np.flatnonzero(self.places == place)
        end = int(found[0]) if len(found) else len(self.places)
        return Route(self.individual, self.places[:end], self.bout[:end])


def routes_of(walks: Sequence[Walk], ground: Ground, *, until: Any = None) -> tuple[list[Route], Ground]:
    """The walks over the places of a world, and the ground with the home that lies between bouts.

    Where no home is given, it is the one dead end that no walk enters and whose way leads to where all bouts begin, and
    back from where they end.

    Args:
        walks: one or more.
        ground: of the world.
        until: a node; what comes before the first visit of it is kept.

    Raises:
        CogmapError: an unknown node, a step that no way joins, bouts that no home joins, or nothing is left.
    """
    if not walks:
        raise CogmapError("walks: none were given; give one or more")
    numbers = [_numbered(walk, ground) for walk in walks]
    end = None if until is None else ground.find(until, "until")
    if ground.home is None:
        ground = ground.with_home(_home_of(numbers, ground))
    routes = [_joined(walk, bouts, ground) for walk, bouts in zip(walks, numbers, strict=True)]
    routes = routes if end is None else [route.until(end) for route in routes]
    if empty := [route.individual for route in routes if len(route.places) < 2]:
        raise CogmapError(f"walks: nothing of {empty[0]} is left before node {until!r}; leave it out, or --until")
    return routes, ground


def _numbered(walk: Walk, ground: Ground) -> list[list[int]]:
    found: list[list[int]] = []
    for n, bout in enumerate(walk.bouts, start=1):
        where = f"{walk.source}: {walk.individual}, bout {n}"
        places = [ground.find(node, f"{where}, step {i}") for i, node in enumerate(bout, start=1)]
        for i, (at, to) in enumerate(pairwise(places), start=2):
            if at != to and ground.way(at, to) is None:
                raise CogmapError(
                    f"{where}, step {i}: no way of {ground.name!r} leads from {bout[i - 2]!r} to {bout[i - 1]!r}; "
                    "mend the walk, or give the world that was walked"
                )
        found.append(places)
    return found


def _home_of(walks: Sequence[list[list[int]]], ground: Ground) -> int | None:
    joins = [(a[-1], b[0]) for bouts in walks for a, b in pairwise(bouts)]
    entered = {place for bouts in walks for bout in bouts for place in bout}
    firsts = {bout[0] for bouts in walks for bout in bouts}
    lasts = {at for at, _ in joins}
    homes = [
        home
        for home in range(len(ground.places))
        if home not in entered
        and len(ground.ways[home]) == 1
        and all(ground.way(home, first) for first in firsts)
        and all(ground.way(last, home) for last in lasts)
    ]
    return homes[0] if joins and len(homes) == 1 else None


def _joined(walk: Walk, bouts: Sequence[list[int]], ground: Ground) -> Route:
    """One row of places: home, the first bout, home, …"""
    home, places, numbers = ground.home, list[int](), list[int]()
    for n, bout in enumerate(bouts):
        if home is not None and bout[0] != home:
            bout = [home, *bout]
        if places and places[-1] == bout[0]:
            bout = bout[1:]
        elif places and home is not None and bout[0] == home:
            numbers.append(n - 1)  # the way home, checked below
            places.append(home)
            bout = bout[1:]
        if places and bout and ground.way(places[-1], bout[0]) is None:
            a, b = (ground.places[at] for at in (places[-1], bout[0]))
            raise CogmapError(
                f"{walk.source}: {walk.individual}, bout {n + 1}, step 1: no way of {ground.name!r} leads from {a!r}, "
                f"where the bout before ended, to {b!r}; name the place between bouts with --home"
            )
        places += bout
        numbers += [n] * len(bout)
    if home is not None and places[-1] != home and ground.way(places[-1], home) is not None:
        places.append(home)
        numbers.append(len(bouts) - 1)
    for at, to in pairwise(places):
        if at != to and ground.way(at, to) is None:
            raise CogmapError(
                f"{walk.source}: {walk.individual}: no way of {ground.name!r} leads from {ground.places[at]!r} to "
                f"{ground.places[to]!r}, which lies between bouts; name another place with --home"
            )
    return Route(walk.individual, np.array(places, dtype=np.int64), np.array(numbers, dtype=np.int64))
