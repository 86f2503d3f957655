"""Dead reckoning: where an agent is and what it has sensed, from its own actions and observations."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..worlds import Motions, WorldError

Place = tuple[int, ...]

MOST_TRACKS = 4


@dataclass(slots=True)
class Track:
    """One account of the walk so far."""

    place: Place  # where the agent is, relative to its start
    # what was seen at each place entered, in the order of first entry
    sights: dict[Place, Hashable] = field(default_factory=dict[Place, Hashable])
    # where each action leads from each place entered, as last sensed; a wall leads back
    edges: dict[tuple[Place, int], Place] = field(default_factory=dict[tuple[Place, int], Place])

    def at(self, place: Place) -> Track:
        """A copy of this account in which the agent is at `place`."""
        return Track(place, dict(self.sights), dict(self.edges))


class Reckoner:
    """Keeps account of the agent's place.

    A move through an open door counts as made, unless what is observed afterwards tells that the door
    was shut in between: the sight is another than was seen there before, or the way back is shut.
    Where that cannot be told at once both accounts are kept, and the first one without a contradiction
    is used. Being moved silently is not noticed.

    Raises:
        WorldError: motions without an action that stays, or with one that no other undoes.
    """

    def __init__(self, motions: Motions) -> None:
        self.vectors = tuple(tuple(vector) for vector in motions.displacements)
        zero = tuple(0 for _ in self.vectors[0])
        if zero not in self.vectors:
            raise WorldError("baselines need an action that stays; add one with a displacement of zeros")
        self.stay = self.vectors.index(zero)
        backwards = [tuple(-x for x in vector) for vector in self.vectors]
        if missing := sorted(set(backwards) - set(self.vectors)):
            raise WorldError(f"baselines need a way back for every action; add one with {missing[0]}")
        self._inverse = [self.vectors.index(vector) for vector in backwards]
        self._tracks = [Track(zero)]

    @property
    def track(self) -> Track:
        """The account in use."""
        return self._tracks[0]

    def sense(self, action: int | None, observation: Mapping[str, Any]) -> list[bool]:
        """Account for what was observed after `action` (None at first); return the open actions.

        Raises:
            WorldError: no sight, or not one flag an action.
        """
        sight, is_open = self._read(observation)
        accounts = [new for track in self._tracks for new in self._outcomes(track, action, sight, is_open)]
        if not accounts:  # moved silently, or a sight changed: keep counting
            accounts = [self.track.at(self._ahead(self.track, action))]
        for track in accounts:
            self._record(track, sight, is_open)
        self._tracks = accounts[:MOST_TRACKS]
        return is_open

    def _outcomes(self, track: Track, action: int | None, sight: Hashable, is_open: Sequence[bool]) -> list[Track]:
        """The accounts that `track` can have turned into: moved and, if the door may have been shut, stayed."""
        ahead = self._ahead(track, action)
        fits_ahead = track.sights.get(ahead, sight) == sight
        if action is None or ahead == track.place:
            return [track] if fits_ahead else []
        blocked = not is_open[action] and track.sights[track.place] == sight
        came_through = is_open[self._inverse[action]]
        stayed = [track.at(track.place)] if blocked and self._only_shut(track, action, is_open) else []
        if not (fits_ahead and came_through):
            return stayed
        moved = track
        moved.place = ahead
        return [moved, *stayed]

    def _only_shut(self, track: Track, action: int, is_open: Sequence[bool]) -> bool:
        # every other door of the room is as it was
        was = [track.edges[track.place, other] != track.place for other in range(len(self.vectors))]
        return all(
            before == now
            for other, (before, now) in enumerate(zip(was, is_open, strict=True))
            if other not in (action, self.stay)
        )

    def _ahead(self, track: Track, action: int | None) -> Place:
        return track.place if action is None else track.edges[track.place, action]

    def _record(self, track: Track, sight: Hashable, is_open: Sequence[bool]) -> None:
        track.sights.setdefault(track.place, sight)
        for action, vector in enumerate(self.vectors):
            beyond = tuple(x + dx for x, dx in zip(track.place, vector, strict=True))
            track.edges[track.place, action] = beyond if is_open[action] else track.place

    def _read(self, observation: Mapping[str, Any]) -> tuple[Hashable, list[bool]]:
        try:
            sight, flags = observation["sight"], np.asarray(observation["open"], dtype=bool)
        except (KeyError, TypeError, ValueError) as error:
            raise WorldError("an observation needs a 'sight' and an 'open' flag for each action") from error
        if flags.shape != (len(self.vectors),):
            raise WorldError(f"'open' has shape {flags.shape}; give one flag an action, {len(self.vectors)}")
        return sight, flags.tolist()
