"""Where in its room a body is, and what the room is like: a filter over both, for legs that slip."""

from collections.abc import Callable, Collection
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..worlds import minigrid as mg
from .eyes import View
from .room_map import CENTRE, SIDE, UNKNOWN, Pose, RoomMap

LEFT, RIGHT, FORWARD, PICKUP, DROP, TOGGLE, NOTHING = range(7)
"""MiniGrid's actions."""

UP = 3  # The way a body faces where it wakes up, whatever that is in the world
SURE = 0.7  # Belief in one pose from which on it counts as known
_KEEP, _FEW = 1e-4, 48  # of each way to face: where it stands shows sooner, and matters less
_TELLING = 3  # tiles that differ, from which on a view tells two beliefs apart


class Guess(NamedTuple):
    """One of the possibilities: how probable it is, where it puts the body, and the room as it then must be."""

    weight: float
    pose: Pose
    known: RoomMap


class Whereabouts:
    """A belief over poses and rooms together, and how often actions go astray.

    In a large plain room a turn that slips is seen by nothing until a wall comes into view, and then by how that lies
    to the walls known before. So each possibility keeps a map of its own: a Rao-Blackwellised filter, of one
    particle for each pose and room that is not improbable.

    Attributes:
        pose: the most probable.
        known: the room as it is then.
        certainty: how probable that pose is.
        straight: how probable the way is in which it faces there.
        misfit: nats by which the last view fits the best pose worse than one of which nothing is known.
    """

    def __init__(self) -> None:
        self._slips, self._moves = 0.04, 4.0
        self.set((CENTRE, CENTRE, UP), RoomMap())

    def set(self, pose: Pose, known: RoomMap) -> None:
        """Be there for sure."""
        self._believe([Guess(1.0, pose, known)])
        self.misfit = 0.0

    @property
    def slip(self) -> float:
        """How often an action is taken to go astray."""
        return self._slips / self._moves

    def update(self, action: int, view: View, *, most: float) -> None:
        """Take in what is seen after an action; `NOTHING` where none was taken. What was toggled is forgotten.

        A view that fits worse than by `most` nats teaches nothing of the room.
        """
        parts: list[tuple[RoomMap, list[Pose], NDArray[np.float64]]] = []
        right = -np.inf
        intended = action if action in (LEFT, RIGHT, FORWARD) else NOTHING
        for weight, pose, known in self._guesses:
            if action in (PICKUP, DROP, TOGGLE):  # it stood in the way until then
                known.unlearn(ahead_of(pose))
            prior: dict[Pose, float] = {}
            for each in (LEFT, RIGHT, FORWARD, NOTHING):
                new = moved(pose, each, known)
                prior[new] = prior.get(new, 0.0) + (1.0 - self.slip if each == intended else self.slip / 3.0)
            likely = np.log(weight) + known.log_likelihood(np.array([*prior]), view)
            parts.append((known, [*prior], likely + np.log(np.maximum([*prior.values()], 1e-300))))
            right = np.logaddexp(right, likely[[*prior].index(moved(pose, intended, known))] + np.log1p(-self.slip))
        log_p = np.concatenate([part for *_, part in parts])
        best = float(log_p.max())
        self.misfit = self.known.novelty(view) - best
        total = best + float(np.log(np.exp(log_p - best).sum()))
        if action in (LEFT, RIGHT, FORWARD):
            self._moves, self._slips = self._moves + 1.0, self._slips + 1.0 - float(np.exp(right - total))
        self._branch(parts, total, view if self.misfit <= most else None)

    def _branch(
        self, parts: list[tuple[RoomMap, list[Pose], NDArray[np.float64]]], total: float, view: View | None
    ) -> None:
        """Go on with what is not improbable; each has a map of its own, which learns what it would have seen."""
        every = [
            (float(np.exp(p - total)), pose, known)
            for known, poses, log_p in parts
            for pose, p in zip(poses, log_p, strict=True)
        ]
        every = sorted((one for one in every if one[0] >= _KEEP), key=lambda one: (-one[0], one[1]))
        every = [one for way in range(4) for one in [some for some in every if some[1][2] == way][:_FEW]]
        taken, new = set[int](), list[Guess]()
        for weight, pose, known in every:
            mine = known if id(known) not in taken else known.copy()
            taken.add(id(known))
            new.append(Guess(weight, pose, mine))
        if view is not None:
            for guess in new:
                guess.known.add(guess.pose, view)
        self._believe(new)

    def _believe(self, guesses: list[Guess]) -> None:
        """Keep them, those that came to the same as one."""
        kept: list[Guess] = []
        for guess in guesses:
            for at, other in enumerate(kept):
                if other.pose == guess.pose and other.known.same(guess.known):
                    kept[at] = other._replace(weight=other.weight + guess.weight)
                    break
            else:
                kept.append(guess)
        kept.sort(key=lambda guess: (-guess.weight, guess.pose))
        total = sum(guess.weight for guess in kept)
        self._guesses = [guess._replace(weight=guess.weight / total) for guess in kept]
        _, self.pose, self.known = self._guesses[0]
        self.certainty = sum(guess.weight for guess in self._guesses if guess.pose == self.pose)
        self.straight = sum(guess.weight for guess in self._guesses if guess.pose[2] == self.pose[2])

    def share(self, true: Callable[[mg.Tile, RoomMap], bool]) -> float:
        """How probable it is that something is true of where it stands."""
        return sum(guess.weight for guess in self._guesses if true(guess.pose[:2], guess.known))

    def telling(self, poses: Collection[Pose]) -> NDArray[np.bool_]:
        """`[n]` whether what is seen from a pose tells the best guess from the best that faces otherwise."""
        mine = np.array([*poses])
        rival = next((guess for guess in self._guesses if guess.pose[2] != self.pose[2]), None)
        if rival is None:
            return np.zeros(len(mine), dtype=np.bool_)
        turn = rival.pose[2] - self.pose[2]
        (dx, dy), (rx, ry) = (mg.AHEAD[turn % 4], mg.AHEAD[(turn + 1) % 4])
        away = mine[:, :2] - self.pose[:2]
        its = away @ np.array([[dx, dy], [rx, ry]]) + rival.pose[:2]
        its = np.column_stack([its, (mine[:, 2] + turn) % 4]).astype(np.int64)
        one, other = self.known.at(mine), rival.known.at(its)
        return ((one != UNKNOWN) & (other != UNKNOWN) & (one != other)).sum(axis=1) >= _TELLING


def ahead_of(pose: Pose) -> mg.Tile:
    """The tile before it."""
    x, y, heading = pose
    return x + mg.AHEAD[heading][0], y + mg.AHEAD[heading][1]


def moved(pose: Pose, action: int, known: RoomMap) -> Pose:
    """Where an action leads; one cannot step where something is known to stand."""
    x, y, heading = pose
    if action == LEFT:
        return x, y, (heading - 1) % 4
    if action == RIGHT:
        return x, y, (heading + 1) % 4
    if action == FORWARD:
        ahead = ahead_of(pose)
        inside = 0 < ahead[0] < SIDE - 1 and 0 < ahead[1] < SIDE - 1
        if inside and (known.free(ahead) or not known.known(ahead)):
            return (*ahead, heading)
    return pose
