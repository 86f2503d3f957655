"""A robot's loop: perceive, decide, act; what went wrong is told; the agent goes on elsewhere.

The loop is in your hands: `perceive` what the sensors say, as little as it may be, and `act` when it suits. The body
says what it really did (`taken`) and what it could not see (`UNSEEN`). The agent is saved, and walks on from the file
in another process, such as the robot's, or tomorrow's.
"""

from __future__ import annotations

import subprocess
import sys
from typing import Any

from cogmap import UNSEEN, Agent, load_world

TOMORROW = """
from cogmap import Agent
agent = Agent.load("robot.npz")
print("elsewhere:", agent.map, "at step", agent.steps)
agent.prefer({11: 4.0})
print("it would go", ", ".join(agent.map.motions.names[a] for a in agent.plan.policy))
"""

world = load_world("4x4")  # stands for the building, which you drive through
observation, _ = world.reset(seed=2)
agent, names = Agent(world.motions, seed=0), world.motions.names
for step in range(24):
    percept: dict[str, Any] = {**observation}
    if step == 5:
        percept["sight"] = UNSEEN  # the camera was blind: no evidence, and nothing is learned of it
    agent.perceive(percept)
    action = agent.act()
    if step == 9:  # somebody pushes it: the body knows that it went down, not where the agent wanted
        observation, *_ = world.step(names.index("down"))
        observation["taken"] = "down"
    else:
        observation, *_ = world.step(action)
print("here:     ", agent.map, "certain:", agent.certain)

agent.perceive(observation)  # nothing is decided yet: the file goes between perceiving and acting
agent.save("robot.npz")
print(subprocess.run([sys.executable, "-c", TOMORROW], capture_output=True, text=True, check=True).stdout, end="")
