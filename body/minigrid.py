"""A body for MiniGrid: it sees seven by seven tiles, and finds its way through rooms."""

from collections.abc import Collection, Iterable
from typing import Any, Protocol

import numpy as np

from ..worlds import minigrid as mg
from .eyes import DOUBT, Eyes
from .outlook import Outlook, Sizes, outlook, viewpoint
from .protocol import Percept
from .room_map import CENTRE, Pose, RoomMap, around
from .routes import distances, route
from .vocabulary import vocabulary
from .whereabouts import FORWARD, LEFT, NOTHING, RIGHT, SURE, UP, Whereabouts, moved

_LOOKS, _TRIES, _PATIENCE = 40, 400, 12
_LOST, _LOST_IN_NOISE = 13.0, 20.0
"""Nats by which the best pose must be worse than one of which nothing is known, for nothing that was expected to be
seen; in noise three tiles may have been misread."""
_STRAIGHT = 0.995  # belief in the way it faces, from which on it leaves a room
_CHECKS = 60  # steps that making sure of that may take
_AGAIN = 3  # looks that it takes before it gives a way up that it sees, where its eyes are bad
_PASSAGE = 5.0  # tiles that a passage is expected to have before any was walked


class Limbs(Protocol):
    """What a body drives: anything with `step`."""

    def step(self, action: Any, /) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Take a low-level action."""
        ...


class MiniGridBody:
    """Moves from room to room in any MiniGrid world by its view alone: no compass, no true state, no grid.

    Rooms are chunks of space bounded by doors and gaps. Ways are the four directions of a frame of its own, in which
    it faced up where it woke.

    Args:
        limbs: what it drives.
        glance: low-level steps that looking at walls which it has not seen may cost where it arrives.

    Attributes:
        image: what it saw last.
        steps: low-level steps taken.
        ended: whether the world has ended the episode.
        reward: the sum of what it was given.
    """

    def __init__(self, limbs: Limbs, *, glance: int = 0) -> None:
        self._limbs, self._glance = limbs, glance
        self._barred: set[mg.Tile] = set()
        self._eyes, self._sizes, self._where = Eyes(), Sizes(), Whereabouts()
        self._seed: mg.Tile = (CENTRE, CENTRE)
        self._given_up: set[mg.Tile] = set()
        self._far, self._walked = _PASSAGE, 1
        self.steps, self.ended, self.reward = 0, False, 0.0
        self._confused, self._odd = False, 0

    @property
    def pose(self) -> Pose:
        """Where it takes itself to be in its room, in its own frame."""
        return self._where.pose

    @property
    def _known(self) -> RoomMap:
        return self._where.known

    @property
    def slip(self) -> float:
        """How often its actions go astray, as it has learned."""
        return self._where.slip

    @property
    def lost(self) -> bool:
        """Whether what it saw last fits nothing that it expected."""
        return self._confused

    def begin(self, observation: Any) -> None:
        """Open the eyes in a new world, of which nothing is known; the frame begins with where it faces."""
        self._sizes, self._where = Sizes(), Whereabouts()
        self.steps, self.ended, self.reward = 0, False, 0.0
        self._anew(observation)

    def glimpse(self, observation: Any) -> None:
        """See again without having moved; where nothing fits, it is lost."""
        self._sense(NOTHING, observation)

    def wake(self) -> Percept:
        """Look round once, at all walls."""
        begin = self.steps
        self._look(range(4))
        return self._percept(None, begin)

    def look(self, ways: Iterable[int]) -> Percept:
        """Look at these ways."""
        begin = self.steps
        self._look(ways)
        return self._percept("unsure" if self._confused else None, begin)

    def perform(self, way: int, *, budget: int | None = None) -> Percept:
        """Go through the way in that direction, in `budget` low-level steps at most: look for it, if need be."""
        begin, limit = self.steps, self.steps + (_TRIES if budget is None else budget)
        self._look([way])
        outcome = "unsure" if self._confused else self._through(way, limit)
        if outcome == "arrived":
            self._arrive(self.steps - begin)
        return self._percept(outcome, begin)

    def settle(self, floor: int) -> Percept:
        """Stay: look at what was not looked at, or stand on the tile of floor `floor`, if this room has one."""
        begin = self.steps
        self._barred.clear()  # what could not be passed may have been misread
        aims = {tile for tile in self._outlook().room if self._known.floor(tile) == floor}
        while aims and self.pose[:2] not in aims and not (self.ended or self._confused) and self.steps < begin + _TRIES:
            plan = route(self.pose, self._known, aims, within=self._floor(self._outlook().room))
            if not plan:
                break
            self._act(plan[0])
        return self.look(range(4)) if not aims else self._percept("unsure" if self._confused else None, begin)

    def cost(self, way: int) -> float:
        """Low-level steps that the way is expected to take: over the floor, and a passage like those it has walked."""
        now = self._outlook()
        exits = set(now.exits[way])
        steps = distances(self.pose, self._known, now.room)
        near = [n for (x, y, h), n in steps.items() if h == way and (x + mg.AHEAD[h][0], y + mg.AHEAD[h][1]) in exits]
        turns = min((way - self.pose[2]) % 4, (self.pose[2] - way) % 4)
        return (min(near) if near else turns) + self._far

    # -- what is seen --------------------------------------------------------------------------------------

    def _targets(self, now: Outlook, ways: Iterable[int]) -> frozenset[mg.Tile]:
        """The tiles that have to be looked at before it is known whether these ways are open."""
        return frozenset[mg.Tile]().union(*map(now.needed.__getitem__, ways))

    def _exits(self, now: Outlook, way: int) -> set[mg.Tile]:
        """The doors and gaps of a way."""
        return set(now.exits[way])

    @property
    def _called(self) -> bool:
        """Whether something comes before what it is told to do."""
        return False

    def _outlook(self) -> Outlook:
        return outlook(self._known, self._seed, self._sizes, self._given_up)

    def _percept(self, outcome: str | None, begin: int) -> Percept:
        if self._confused:  # what it knew is of somewhere else
            self._confused = False
            self._look(range(4))
        now = self._outlook()
        if now.whole:
            self._sizes.learn(now.room)
        ways: dict[int, bool | None] = {
            way: True if set(now.exits[way]) - self._barred else None if now.needed[way] else False for way in range(4)
        }
        return Percept(self._sight(now), ways, outcome, self.steps - begin)

    def _sight(self, now: Outlook) -> int | dict[int, float] | None:
        """The colour of the floor: a number where there is no doubt, else likelihoods; None without a coloured floor.

        A white tile is what a room is known by.
        """
        words = vocabulary()
        if any(self._known.floor(tile) == mg.WHITE for tile in now.room):
            return mg.WHITE
        evidence = self._known.evidence(now.room)
        floors = np.flatnonzero(words.floor[:-1] >= 0)
        worth = evidence[floors] - evidence[floors].max()
        if not any(self._known.floor(tile) >= 0 for tile in now.room):
            return None
        if np.sort(worth)[-2] <= -DOUBT:
            return int(words.floor[floors[worth.argmax()]])
        return {int(words.floor[i]): float(np.exp(w)) for i, w in zip(floors, worth, strict=True) if w > -DOUBT}

    def _look(self, ways: Iterable[int]) -> None:
        """Turn and walk until each of the ways is seen open, or surely is none; give up what cannot be seen."""
        ways = list(ways)
        plan: list[int] = []
        before, meant = frozenset[mg.Tile](), self.pose
        for _ in range(_LOOKS):
            now = self._outlook()
            targets = self._targets(now, ways)
            if not targets or self.ended or self._confused or self._called:
                return
            if plan and targets == before and self.pose == meant:
                meant = moved(self.pose, plan[0], self._known)
                self._act(plan.pop(0))
                continue
            floor = self._floor(now.room)
            steps = distances(self.pose, self._known, floor)
            spot = viewpoint(steps, targets)
            if spot is None or spot[1] == 0:  # they are in view, and yet not seen
                self._given_up |= targets if spot is None else self._in_view(targets)
                continue
            plan = route(self.pose, self._known, [spot[0]], within=floor) or []
            plan, before = plan or [NOTHING], targets
            meant = moved(self.pose, plan[0], self._known)
            self._act(plan.pop(0))

    def _in_view(self, targets: Iterable[mg.Tile]) -> set[mg.Tile]:
        return {tile for tile in targets if viewpoint({self.pose: 0}, [tile]) is not None}

    # -- what is done --------------------------------------------------------------------------------------

    def _act(self, action: int) -> None:
        observation, reward, terminated, truncated, _ = self._limbs.step(action)
        self.steps += 1
        self.reward += float(reward)
        self.ended = self.ended or terminated or truncated
        self._sense(action, observation)

    def _sense(self, action: int, observation: Any) -> None:
        self.image = observation["image"]
        view, meant = self._eyes.look(self.image), moved(self.pose, action, self._known)
        limit = _LOST_IN_NOISE if self._eyes.noise else _LOST
        self._where.update(action, view, most=limit)
        self._odd = self._odd + 1 if self._where.misfit > limit else 0
        if self._odd > (self._eyes.noise > 0.0):  # one blurred look may be wrong
            self._anew(observation, meant[2])  # which way it faces may be the same still
            self._confused = True

    def _anew(self, observation: Any, heading: int = UP) -> None:
        """Nothing is known of where it is, but which way it takes itself to face."""
        known = RoomMap()
        known.key = self._known.key
        self._seed, self._odd, self._confused = (CENTRE, CENTRE), 0, False
        self._given_up.clear()
        self._barred.clear()
        self._where.set((*self._seed, heading), known)
        self.image = observation["image"]
        known.add(self.pose, self._eyes.look(self.image))

    def _through(self, way: int, limit: int) -> str:
        """Follow the passage of a way to the floor beyond."""
        now = self._outlook()
        room, exits = now.room, self._exits(now, way)
        left: set[mg.Tile] = set()  # what was tried in vain
        waited = again = checks = 0
        while self.steps < limit and not self.ended:
            if self._confused or self._called:
                return "unsure"
            here = self.pose[:2]
            if here in room and checks < _CHECKS and (check := self._make_sure(room)) is not None:
                checks += 1
                self._act(check)
                continue
            if self._where.share(lambda tile, known: tile not in room and not known.narrow(tile)) >= SURE:
                return "arrived"
            if not exits:
                exits = self._exits(self._outlook(), way) - left
            beyond = self._beyond(exits, room)
            goal = self._next(beyond, room)
            plan = None if goal is None else route(self.pose, self._known, [goal], within=self._floor(room) | beyond)
            if plan:
                self._act(plan[0])
            elif plan is None and again < _AGAIN and exits and self._eyes.noise > 0.0:
                again += 1  # tiles may have been misread
                self._act(NOTHING)
            elif waited < _PATIENCE and (plan is not None or self._where.certainty < SURE):
                waited += 1
                self._act(self._into_the_unknown())
            elif plan is not None:
                left |= exits
                exits = set()
            elif not self._make_way(beyond | exits, room):
                self._barred |= exits
                return "blocked"
        return "unsure"

    def _make_sure(self, room: Collection[mg.Tile]) -> int | None:
        """How to see which way it faces, before it leaves by the wrong way; None where it knows, or nothing tells."""
        if self._where.straight >= _STRAIGHT:
            return None
        steps = distances(self.pose, self._known, room)
        telling = np.flatnonzero(self._where.telling(steps))
        spot = [*steps][telling[0]] if len(telling) else None
        if spot is None:  # nor does what is known tell it: see more
            unseen = frozenset[mg.Tile]().union(*self._outlook().unknown)
            found = viewpoint(steps, unseen) if unseen else None
            spot = None if found is None else found[0]
        plan = None if spot is None else route(self.pose, self._known, [spot], within=room)
        return plan[0] if plan else None

    def _floor(self, room: Collection[mg.Tile]) -> set[mg.Tile]:
        """A room, and the passage in which it stands, if that is where it is: there is a way back."""
        here = self.pose[:2]
        return set(room) if here in room else {*room, *self._beyond({here}, set(room))}

    def _make_way(self, beyond: set[mg.Tile], room: frozenset[mg.Tile]) -> bool:
        """Do something about what stands in a passage; whether anything was done."""
        return False

    def _into_the_unknown(self) -> int:
        """Turn to a tile of which nothing is known, and go there: who is not sure where it is has learned nothing."""
        x, y, heading = self.pose
        unknown = [h for h, other in around((x, y)) if not self._known.known(other)]
        turns = min(((h - heading) % 4 for h in unknown), default=1, key=(0, 1, 3, 2).index)
        return (FORWARD, RIGHT, RIGHT, LEFT)[turns]

    def _beyond(self, exits: set[mg.Tile], room: Collection[mg.Tile]) -> set[mg.Tile]:
        """Tiles that can be reached through the exits, as far as the next floor."""
        found, queue = set(exits), list(exits)
        while queue:
            tile = queue.pop()
            if not self._known.narrow(tile):
                continue
            for _, other in around(tile):
                if other not in found and other not in room and (self._known.free(other) or self._known.shut(other)):
                    found.add(other)
                    queue.append(other)
        return found

    def _next(self, beyond: set[mg.Tile], room: frozenset[mg.Tile]) -> mg.Tile | None:
        """Where to go: the floor beyond, else where the passage was not seen yet; None where it ends."""
        floors = [tile for tile in beyond if not self._known.narrow(tile)]
        edges = [tile for tile in beyond if self._known.shut(tile) or self._open_ended(tile)]
        x, y, _ = self.pose
        for tiles in (floors, edges):
            if tiles:
                return min(tiles, key=lambda tile: (abs(tile[0] - x) + abs(tile[1] - y), tile))
        return None

    def _open_ended(self, tile: mg.Tile) -> bool:
        return any(not self._known.known(other) for _, other in around(tile))

    def _room(self, tile: mg.Tile) -> frozenset[mg.Tile]:
        return outlook(self._known, tile, self._sizes, ()).room

    def _arrive(self, steps: int) -> None:
        """Be in the next room, and remember no more than that."""
        room = self._room(self.pose[:2])
        self._far += (steps - self._far) / self._walked
        self._walked += 1
        keep = {(x + i, y + j) for x, y in room for i in (-2, -1, 0, 1, 2) for j in (-2, -1, 0, 1, 2)}
        x, y, heading = self.pose
        self._seed = (CENTRE, CENTRE)
        self._given_up.clear()
        self._barred.clear()
        self._where.set((*self._seed, heading), self._known.about((x, y), keep))
        if self._glance:
            now = self._outlook()
            for way in range(4):
                steps_to = distances(self.pose, self._known, now.room)
                spot = viewpoint(steps_to, now.needed[way]) if now.needed[way] else None
                if spot is not None and spot[1] <= self._glance:
                    self._look([way])
                    now = self._outlook()
