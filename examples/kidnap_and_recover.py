"""Moved without a word.

An agent explores a maze whose rooms look alike. Then it is put into another room, and nobody tells it. That it may
have been displaced is a variable of its factor graph, so finding out where it is needs no special rule: it is
inference. Its map is not harmed.
"""

from __future__ import annotations

from cogmap.agent import Agent
from cogmap.worlds import load_world

world = load_world("4x4_alias")
observation, info = world.reset(seed=3)
home = info["position"]  # the agent calls it (0, 0)
agent = Agent(world.motions, seed=3)
while not agent.steps or not agent.map.visited.all():
    observation, _, _, _, info = world.step(agent.step(observation))
agent.step(observation)
print(f"explored in {agent.steps - 1} steps: {agent.map}")


def show(position: tuple[int, int]) -> None:
    own = (position[0] - home[0], position[1] - home[1])  # where that is in the agent's own terms
    belief = {agent.map.position(place): round(q, 3) for place, q in list(agent.belief.places.items())[:3]}
    right = agent.map.position(agent.belief.place) == own
    mark = "certain" if agent.certain else "not certain"
    print(f"is at {own!s:8} P(moved) {agent.belief.moved:.3f}  {mark:11} {'right' if right else 'wrong':5}  {belief}")


places = len(agent.map.places)
for room in ((1, 1), (2, 2), (0, 0)):
    observation = world.displace(room)
    print(f"\nput into {room} without a word: sees {observation['sight']}")
    for _ in range(3):
        action = agent.step(observation)
        show(world.position)
        observation, _, _, _, info = world.step(action)
    agent.step(observation)
assert len(agent.map.places) == places  # nothing was added to the map by mistake
print(f"\nstill {places} places")
