"""A map that grows, event by event and frame by frame.

Whatever is added to the model is one event in a log: a time step, a sight, a position, a place. Read the log, count
it, and draw the map after each step as an animation: a place is imagined as soon as a door to it was seen.
"""

from __future__ import annotations

from collections import Counter

import matplotlib.pyplot as plt
from cogmap.agent import Agent
from cogmap.views import GrowthFrames
from cogmap.worlds import load_world

world = load_world("3x3")
observation, info = world.reset(seed=2)
agent = Agent(world.motions, seed=2)
frames = GrowthFrames(chart=world.chart, start=info["position"])  # the true rooms, drawn faintly beneath

for _ in range(9):
    action = agent.step(observation)
    frames.add(agent)
    for event in agent.trace[-1].grown:
        if event.kind == "place" and event.source is not None:
            way = world.motions.names[event.action]
            print(f"step {event.step}: place {event.index} at {event.label}, seen {way} of place {event.source}")
        elif event.kind == "sight":
            print(f"step {event.step}: sight {event.label!r}")
    observation, *_ = world.step(action)

print("\nin all:", dict(Counter(event.kind for event in agent.map.growth)))
frames.save_gif("growth.gif")

figure, axes = plt.subplots(1, 3, figsize=(12, 4.9), layout="constrained")
for ax, index in zip(axes, (0, 3, -1), strict=True):
    frames.plot(index, ax=ax)
figure.savefig("growth.png")
print("drawn: growth.gif, growth.png")
