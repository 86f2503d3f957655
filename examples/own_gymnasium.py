"""An environment of your own.

A Gymnasium environment becomes a world by saying what its actions are called and where they lead. The agent is given
its observations alone; a callback looks on at every step and sees the truth as well.
"""

from __future__ import annotations

from typing import Any

import gymnasium as gym
from cogmap.agent import trace_table
from cogmap.experiments import Moment, run
from cogmap.worlds import Motions
from gymnasium import spaces

ROOMS = "lobby", "hall", "hall", "lab", "attic", "store"
FLOORS = (0, 1, 2, 3), (4, None, None, 5)  # the attic is above the lobby, the store above the lab


class House(gym.Env[dict[str, Any], int]):
    """Two floors: along a corridor left and right, and up and down at its ends."""

    motions = Motions(("stay", "left", "right", "up", "down"), ((0, 0), (0, -1), (0, 1), (-1, 0), (1, 0)))
    observation_space = spaces.Dict({"sight": spaces.Text(8), "open": spaces.MultiBinary(5)})
    action_space = spaces.Discrete(5)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[dict[str, Any], Any]:
        super().reset(seed=seed)
        self.at = (0, int(self.np_random.integers(4)))
        return self._seen()

    def step(self, action: int) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        self.at = self._ahead(action) or self.at
        observation, info = self._seen()
        return observation, 0.0, False, False, info

    def _ahead(self, action: int) -> tuple[int, int] | None:
        down, along = self.motions.displacements[action]
        floor, room = self.at[0] - down, self.at[1] + along
        return (floor, room) if 0 <= floor < 2 and 0 <= room < 4 and FLOORS[floor][room] is not None else None

    def _seen(self) -> tuple[dict[str, Any], dict[str, Any]]:
        number = FLOORS[self.at[0]][self.at[1]]
        ways = [self._ahead(action) is not None for action in range(5)]
        return {"sight": ROOMS[number or 0], "open": ways}, {"place": number}


def look_on(moment: Moment) -> bool:
    print(f"step {moment.step}: in room {moment.info['place']}, sees {moment.observation['sight']}, ", end="")
    print("goes", House.motions.names[moment.action])
    return moment.agent.certain and len(moment.agent.map.visited_places) == len(ROOMS)  # True ends the run


done = run(House(), steps=30, seed=0, watch=look_on)
print(done.agent.map)
print(trace_table(done.agent, done.records[-3:]).text(most_columns=6))
