"""Teaches the map what the agent is certain of, and lets it grow."""

from collections.abc import Collection

from ..inference import Belief
from ..model import CognitiveMap, Growth, Percept, Ways, Whereabouts
from .counterparts import Counterparts
from .doors import Doors
from .settings import Settings


class Mapper:
    """Learning and growth of one map.

    Args:
        map_: the map.
        growth: its growth rule.
        ways: what teaches the map which ways are open.
        counterparts: its rooms in other contexts.
        settings: how certain one must be, and how much fades.
    """

    def __init__(
        self, map_: CognitiveMap, growth: Growth, ways: Ways, counterparts: Counterparts, settings: Settings
    ) -> None:
        self._map = map_
        self._growth = growth
        self._ways = ways
        self._counterparts = counterparts
        self._settings = settings

    def enter(self, belief: Whereabouts, action: int, *, step: int) -> None:
        """Before inference: the agent took a door that was open."""
        self._map.recall(self._growth.enter(self._map, belief, action, step=step))

    def arrive(self, place: int, percept: Percept, *, step: int) -> None:
        """Before inference: what was measured of the move from a place."""
        self._map.pose.arrive(self._map, place, percept, step=step)

    def fade(self) -> None:
        """What was learned long ago fades, where the settings say so."""
        if self._settings.forgetting:
            self._map.transitions.forget(1.0 - self._settings.forgetting)

    def learn(
        self, belief: Belief, percept: Percept, doors: Doors, *, step: int, one_way: Collection[int] = ()
    ) -> None:
        """What a certain belief teaches: transitions, what was sensed, and the places behind open doors.

        Only the place that passed the gate learns: the prior of A_o is so small that even a hundredth of a count
        would fix the sight of a place where the agent never was.

        Args:
            belief: where the agent is.
            percept: what the step brought.
            doors: of the most probable place, as all looks at them say.
            one_way: the actions whose ways from there are open on one side alone.
            step: the time step.
        """
        map_, place, weight = self._map, belief.place, belief.message.certainty
        self._counterparts.note(place, percept, step=step)
        doors = self._counterparts.corrected(place, doors)
        open_ = self._counterparts.beyond(doors)
        if percept.action is not None:
            for previous, next_, walked in zip(*(part.tolist() for part in belief.pairwise), strict=True):
                if previous != next_ or not open_[percept.action]:  # else the move failed
                    back = next_ != place or map_.motions.inverse[percept.action] not in one_way
                    map_.transitions.learn(previous, percept.action, next_, walked, back=back)
        map_.mark_visited(place)
        map_.pose.look(map_, place, percept, step=step)
        map_.recall(self._growth.look(map_, Whereabouts(belief.places), open_, step=step))
        map_.learn(place, {name: told for name, told in percept.readings.items() if name != self._ways.name}, weight)
        self._ways.learn(place, doors, weight, one_way=one_way)
        self._counterparts.share(place, step=step)
