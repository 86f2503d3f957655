"""An agent in a maze.

Let an agent explore the 4x4 maze whose rooms look alike, and look at the four things that it holds: its map, its
belief about where it is, the factor graph of its last steps, and its plan. Then keep it in a file.
"""

from __future__ import annotations

from cogmap.agent import Agent, Settings
from cogmap.worlds import load_world

world = load_world("4x4_alias")  # or the path of a text file: see own_maze.py
observation, info = world.reset(seed=0)  # {"sight": label, "open": truth values over the actions}
agent = Agent(world.motions, settings=Settings(look_ahead=6), seed=0)

for step in range(20):
    action = agent.step(observation)  # perceive, infer, learn, grow, plan, choose
    if step % 4 == 0:
        places, visited = len(agent.map.places), int(agent.map.visited.sum())
        print(f"step {step:2}: sees {observation['sight']}, goes {world.motions.names[action]:5}  ", end="")
        print(f"{places:2} places, {visited:2} of them visited, free energy {agent.belief.free_energy:.2f} nats")
    observation, _, _, _, info = world.step(action)  # the true position is in `info`; the agent never sees it

print()
print(agent.map)
print("belief:", {place: round(q, 3) for place, q in agent.belief.places.items()})
print("graph:", len(agent.graph.variables), "variables,", len(agent.graph.factors), "factors")
print("plan:", ", ".join(world.motions.names[action] for action in agent.plan.policy), "of", len(agent.plan.policies))
for term, nats in agent.plan.expected_free_energy.row(agent.plan.chosen).items():
    print(f"  {term:23} {nats:7.3f} nats")

agent.save("map.npz")
assert Agent.load("map.npz").steps == agent.steps
