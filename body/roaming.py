"""A body that remembers where it has been: its ways are doors, it runs errands, and fetches keys."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model import NOTHING as EMPTY_HANDED
from ..worlds import minigrid as mg
from .errand import Errand
from .minigrid import Limbs, MiniGridBody
from .outlook import Outlook
from .protocol import Percept
from .room_map import around, shifted
from .routes import distances, route
from .vocabulary import BOX, vocabulary
from .whereabouts import DROP, NOTHING, PICKUP, TOGGLE

DOORS = 32
"""Doors that a body tells apart; those that it sees later it does not tell of."""
_TRIES = 400
_BEHIND = 3  # things in a row behind which a key is looked for
COLOURS = ("red", "green", "blue", "purple", "yellow", "grey")


class RoamingBody(MiniGridBody):
    """Goes through any world of MiniGrid and forgets nothing of it, which takes legs that do not slip.

    Ways are doors and gaps, numbered as they are seen first, the same from both sides: several may lie in one wall. It
    looks at the whole of a room before it answers. What it is sent for comes first, as soon as it is seen; what lies in
    the way of that, of a key or of a locked door is put aside. Keys it takes when it is told to: it says which lie in
    the room, and which of its doors are locked.

    Attributes:
        held: what it carries, in words; None of nothing.
    """

    def __init__(self, limbs: Limbs) -> None:
        super().__init__(limbs)
        self._errand: Errand | None = None
        self._doors: dict[mg.Tile, int] = {}
        self._carried: int | None = None
        self._lifted: set[mg.Tile] = set()
        self._rooms: list[frozenset[mg.Tile]] = []
        self._idle = False
        self._passed: tuple[set[mg.Tile], int] = set(), 0

    def begin(self, observation: Any, *, errand: Errand | None = None) -> None:
        """As `MiniGridBody.begin`; with an errand it runs that as soon as it sees what is wanted."""
        self._errand, self._carried = errand, None
        self._doors.clear()
        self._lifted.clear()
        self._rooms.clear()
        super().begin(observation)

    def wake(self) -> Percept:
        """Look round once, at all of the room."""
        begin = self.steps
        return self._attended(None, begin)

    def stay(self) -> Percept:
        """Look round, and see to what hides something."""
        self._idle, begin = True, self.steps
        told = self._attended(None, begin)
        self._idle = False
        return told

    def take(self, colour: int) -> Percept:
        """Fetch the key of a colour; what is carried instead is put down."""
        begin = self.steps
        while self._known.key != colour and self.steps < begin + _TRIES and not (self.ended or self._confused):
            plan = self._to_key(colour)
            if not plan:
                break
            self._handle(plan[0])
        return self._attended("arrived" if self._known.key == colour else "blocked", begin)

    def cost_of(self, colour: int) -> float | None:
        """Low-level steps that taking a key is expected to take; None where there is no way to it."""
        plan = self._to_key(colour)
        return None if plan is None else float(len(plan))

    @property
    def keys(self) -> frozenset[int]:
        """The colours of keys that lie in the room, in the open or behind other things."""
        things, here = vocabulary().thing[self._known.tile], self._known.room(self._seed)
        for _ in range(_BEHIND):
            here |= things & (shifted(here, 0) | shifted(here, 1) | shifted(here, 2) | shifted(here, 3))
        found = vocabulary().key[self._known.tile[here]]
        return frozenset(int(colour) for colour in found if colour >= 0)

    @property
    def locks(self) -> dict[int, int]:
        """The colour of the key that each locked door of the room takes."""
        tiles = vocabulary().locked[self._known.tile]
        return {self._doors[x, y]: int(tiles[y, x]) for x, y in self._locked() if (x, y) in self._doors}

    def perform(self, way: int, *, budget: int | None = None) -> Percept:
        """Go through a door by its number, in `budget` low-level steps at most, and look at all of the room beyond."""
        begin, limit = self.steps, self.steps + (_TRIES if budget is None else budget)
        outcome = self._through(way, limit)
        if outcome == "arrived":
            self._arrive(self.steps - begin)
        return self._attended(outcome, begin)

    def cost(self, way: int) -> float:
        """Low-level steps that the door is expected to take: to the tile before it, to open it, and through."""
        now = self._outlook()
        aims = self._exits(now, way)
        steps = distances(self.pose, self._known, now.room)
        near = [n for (x, y, h), n in steps.items() if (x + mg.AHEAD[h][0], y + mg.AHEAD[h][1]) in aims]
        return min(near, default=self._far) + 2.0

    @property
    def room(self) -> str:
        """The room that it is in, by the order in which they were entered: it knows again where it has been."""
        here = self._outlook().room
        number = next((i for i, room in enumerate(self._rooms) if room & here), len(self._rooms))
        self._rooms[number : number + 1] = [here]
        return f"room {number}"

    @property
    def held(self) -> str | None:
        """See the class."""
        return None if self._carried is None else _words(self._carried)

    @property
    def key(self) -> str:
        """The key that it carries, in words, or `nothing`."""
        return EMPTY_HANDED if self._known.key < 0 else f"{COLOURS[self._known.key]} key"

    @property
    def bars(self) -> tuple[str, ...]:
        """What it could not get past, in words: locked doors that it knows of, and of which no key was seen."""
        tiles, words = self._known.tile[self._known.tile >= 0], vocabulary()
        locked = sorted({int(colour) for colour in words.locked[tiles] if colour >= 0 and colour != self._known.key})
        keys = {int(colour) for colour in words.key[tiles]}
        return tuple(
            f"a locked {COLOURS[c]} door; its key was {'seen, and not reached' if c in keys else 'not seen'}"
            for c in locked
        )

    # -- ways ----------------------------------------------------------------------------------------------

    def _targets(self, now: Outlook, ways: Iterable[int]) -> frozenset[mg.Tile]:
        return frozenset[mg.Tile]().union(*now.unknown)

    def _exits(self, now: Outlook, way: int) -> set[mg.Tile]:
        return {tile for tile in _all_exits(now) if self._doors.get(tile) == way}

    def _locked(self) -> set[mg.Tile]:
        """The locked doors of the room."""
        room, doors = self._known.room(self._seed), vocabulary().locked[self._known.tile] >= 0
        return {tile for heading in range(4) for tile in _tiles(shifted(room, heading) & doors)}

    def _percept(self, outcome: str | None, begin: int) -> Percept:
        told = super()._percept(outcome, begin)
        exits = _all_exits(self._outlook())
        for tile in sorted((exits | self._locked()) - self._doors.keys()):
            number = len(set(self._doors.values()))
            if number < DOORS:
                self._doors[tile] = number
        open_ = {self._doors[tile] for tile in exits - self._barred if tile in self._doors}
        return replace(told, ways={way: way in open_ for way in range(DOORS)})

    def _arrive(self, steps: int) -> None:
        """Be in the next room; a passage has one number at both its ends."""
        gone, way = self._passed
        self._settle_in()
        for tile in _all_exits(self._outlook()) & gone:
            self._doors.setdefault(tile, way)

    def _settle_in(self) -> None:
        """The room is the one that it stands in."""
        if not self._known.narrow(self.pose[:2]):
            self._seed = self.pose[:2]
        self._given_up.clear()
        self._barred.clear()

    def _through(self, way: int, limit: int) -> str:
        exits = self._exits(self._outlook(), way)
        outcome = super()._through(way, limit)
        self._passed = self._beyond(exits, self._outlook().room), way
        return outcome

    # -- errands -------------------------------------------------------------------------------------------

    @property
    def _called(self) -> bool:
        return self._wanted() is not None

    def _attended(self, outcome: str | None, begin: int) -> Percept:
        """Look at all of the room, do what is wanted, and so on; where that leads elsewhere, say so."""
        room = self._outlook().room
        while self.steps < begin + _TRIES:
            self._look(())
            if not self._run_errand():
                break
            self._settle_in()
        return replace(self._percept(outcome, begin), moved=not self._outlook().room & room)

    def _run_errand(self) -> bool:
        """Go where it is wanted, and do what is to be done there; whether there was anything."""
        done = False
        for _ in range(_TRIES):
            plan = self._wanted()
            if not plan or self.ended or self._confused:
                break
            done = True
            self._handle(plan[0])
            if plan == [NOTHING] and not self.ended:  # it is there, and nobody says so
                self._errand = None
        return done and not self.ended

    def _wanted(self) -> list[int] | None:
        """The actions that bring it nearest to what is wanted, as far as that was seen; None where nothing was."""
        if self.ended:
            return None
        words = vocabulary()
        if self._carried is not None and words.key[self._carried] < 0:
            return self._put_down()
        plan = self._to_errand()
        if not plan and (self._idle or self._errand is not None):
            plan = self._to_locked() or self._to_boxes()
        return self._to_hidden() if not plan and self._idle else plan

    def _to_errand(self) -> list[int] | None:
        errand = self._errand
        if errand is None:
            return None
        wanted, key = errand.wanted, self._known.key
        if errand.action == "toggle":  # doors that are locked take their keys
            locked = vocabulary().locked[:-1]
            wanted = wanted & ((locked < 0) | (locked == key))
        plan = self._towards(wanted, upon=errand.upon)
        if plan is None:
            return self._clear(wanted)
        final = {"pickup": [PICKUP], "toggle": [TOGGLE], None: [] if errand.upon else [NOTHING]}[errand.action]
        full = self._carried is not None and errand.action == "pickup"
        return self._put_down() if full and TOGGLE not in plan else plan + final

    def _to_key(self, colour: int) -> list[int] | None:
        """To the nearest key of a colour, and take it up; what is carried, or lies in the way, is put aside first."""
        key = vocabulary().key[:-1] == colour
        way = self._towards(key, upon=False)
        return self._clear(key) if way is None else self._lifting([*way, PICKUP])

    def _to_locked(self) -> list[int] | None:
        """Take up what lies in the way to a locked door whose key was seen."""
        words, tiles = vocabulary(), self._known.tile
        keys = {int(colour) for colour in words.key[tiles[tiles >= 0]]} | {self._known.key}
        for colour in sorted({int(c) for c in words.locked[tiles[tiles >= 0]] if c >= 0} & keys):
            door = words.locked[:-1] == colour
            if self._towards(door, upon=False) is None and (plan := self._clear(door)) is not None:
                return plan
        return None

    def _to_boxes(self) -> list[int] | None:
        """To a box, to open it, where the key of a locked door was not seen: it may lie in there."""
        words, tiles = vocabulary(), self._known.tile
        kinds = np.unique(tiles[tiles >= 0])
        keys = {int(key) for key in words.key[kinds]} | {self._known.key}
        if not {int(colour) for colour in words.locked[kinds]} - keys - {-1}:
            return None
        boxes = words.codes[:, 0] == BOX
        plan = self._towards(boxes if self._errand is None else boxes & ~self._errand.wanted, upon=False)
        return None if plan is None else [*plan, TOGGLE]

    def _to_hidden(self) -> list[int] | None:
        """To a thing behind which there is floor that cannot be reached, or that was not seen."""
        known, masks = self._known, self._known.masks()
        free, things = set(_tiles(masks.free | masks.shut)), set(_tiles(vocabulary().thing[known.tile]))
        things -= self._lifted
        reached = {(x, y) for x, y, _ in distances(self.pose, known, free)}
        beside = {other for tile in reached for _, other in around(tile)}
        behind = {tile for tile in things & beside if any(not known.known(other) for _, other in around(tile))}
        cut_off = {tile for tile in free - reached if known.free(tile)}
        goals = behind | cut_off
        plan = route(self.pose, known, goals, within=free, lift=things) if things and goals else None
        return self._lifting(plan) if plan is not None and PICKUP in plan else None

    def _towards(self, wanted: NDArray[np.bool_], *, upon: bool, lift: bool = False) -> list[int] | None:
        """The way to the nearest tile of some kinds: upon it, or before it and looking at it; None if there is none."""
        words, tiles, masks = vocabulary(), self._known.tile, self._known.masks()
        found = _tiles((tiles >= 0) & wanted[tiles])
        if not found:
            return None
        goals: list[Any] = [
            tile if upon else (tile[0] - dx, tile[1] - dy, heading)
            for tile in found
            for heading, (dx, dy) in enumerate(mg.AHEAD)
        ]
        within = set(_tiles(masks.free | masks.shut))
        things = _tiles(words.thing[tiles]) if lift else ()
        return route(
            self.pose, self._known, goals, within=within if upon else within - set(found), lift=set(things) - set(found)
        )

    def _clear(self, wanted: NDArray[np.bool_]) -> list[int] | None:
        """Take up what lies in the way to a tile of some kinds; None where that does not help."""
        plan = self._towards(wanted, upon=False, lift=True)
        return self._lifting(plan) if plan is not None and PICKUP in plan else None

    def _lifting(self, plan: list[int] | None) -> list[int] | None:
        """A plan as far as the first thing that has to be taken up, which takes empty hands."""
        if plan is None or PICKUP not in plan:
            return plan
        return self._put_down() if self._carried is not None else plan[: plan.index(PICKUP) + 1]

    def _make_way(self, beyond: set[mg.Tile], room: frozenset[mg.Tile]) -> bool:
        """Take up a thing that stands in the passage."""
        things = vocabulary().thing[self._known.tile]
        lift = {(x, y) for tile in beyond for _, (x, y) in around(tile) if things[y, x]} - room
        goals = [(x - dx, y - dy, heading) for x, y in lift for heading, (dx, dy) in enumerate(mg.AHEAD)]
        plan = route(self.pose, self._known, goals, within=(room | beyond) - lift) if goals else None
        if plan is None:
            return False
        if self._carried is not None:
            put = self._put_down()
            plan = plan if put is None else put
        self._handle(plan[0] if plan else PICKUP)
        return True

    def _put_down(self) -> list[int] | None:
        """Put down what is carried where it is in nobody's way, and not where it was; None where there is no such."""
        known, best = self._known, None
        free = set(_tiles(known.masks().free))
        steps = distances(self.pose, known, free)
        for (x, y, heading), cost in steps.items():
            ahead = (x + mg.AHEAD[heading][0], y + mg.AHEAD[heading][1])
            if ahead in free and ahead not in self._lifted and not known.narrow(ahead) and known.known(ahead):
                beside = any(known.narrow(other) or known.door(other) for _, other in around(ahead))
                if best is None or (beside, cost) < best[0]:
                    best = (beside, cost), (x, y, heading)
        if best is None:
            return None
        return [*(route(self.pose, known, [best[1]], within=free) or []), DROP]

    def _handle(self, action: int) -> None:
        """Act, and note what is carried then."""
        x, y, heading = self.pose
        ahead = (x + mg.AHEAD[heading][0], y + mg.AHEAD[heading][1])
        thing = int(self._known.tile[ahead[1], ahead[0]])
        self._act(action)
        if action == PICKUP and self._known.free(ahead):
            self._carried, self._known.key = thing, int(vocabulary().key[thing])
            self._lifted.add(ahead)
        elif action == DROP:
            self._carried, self._known.key = None, -1


def _all_exits(now: Outlook) -> set[mg.Tile]:
    return {tile for exits in now.exits for tile in exits}


def _tiles(mask: NDArray[np.bool_]) -> list[mg.Tile]:
    return [(x, y) for y, x in np.argwhere(mask).tolist()]


def _words(number: int) -> str:
    kind, colour, _ = vocabulary().codes[number].tolist()
    return f"a {COLOURS[colour]} {('key', 'ball', 'box')[kind - 5]}"
