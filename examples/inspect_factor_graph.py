"""The factor graph of an agent, read and queried.

What an agent believes about its last steps is an ordinary discrete factor graph: named variables with labelled
domains, and factors that say which equation they implement. Here the agent knows its maze, and is then put without
a word into one of two rooms that look alike. Print its graph, ask it where the agent is and where it was, by two
engines, and see the free energy split in three ways.
"""

from __future__ import annotations

from cogmap.agent import Agent, Settings
from cogmap.inference import free_energy, infer, most_probable
from cogmap.worlds import load_world

world = load_world("t_maze_alias")
observation, _ = world.reset(seed=0)
settings = Settings(window=3, hypotheses=None)  # three steps are kept, and the map is never in question
agent = Agent(world.motions, settings=settings, seed=0)
for _ in range(19):
    observation, *_ = world.step(agent.step(observation))
agent.step(world.displace((1, 2)))  # (1, 2) and (2, 2) are alike: the same sight, the same doors

graph, now = agent.graph, f"s{agent.steps - 1}"
print(graph)  # the product of all its factors
print("\nthe factors of the last step:")
for factor in graph.factors:
    if any(variable.time == agent.steps - 1 for variable in factor.scope):
        print(f"  {factor.label:28} {factor.kind:12} {factor.shape!s:10} {factor.equation}")

print(f"\nwhere is it? Q({now}) by")
for engine in ("numpy", "gtsam"):
    posterior = infer(graph, engine=engine)
    belief = {place: round(posterior.probability(now, place), 4) for place in graph.variable_named(now).domain}
    print(f"  {engine}  {belief}  log evidence {posterior.log_evidence:.9f}")

posterior, best = infer(graph), most_probable(graph).assignment
print(f"was it moved? {posterior.probability(f'moved{agent.steps - 1}', True):.4f}")
print("the most probable walk:", [best[variable.name] for variable in graph.variables if variable.name[0] == "s"])

F = free_energy(posterior)
print(f"\nfree energy {F.free_energy:.4f} nats, in three ways:")
print(f"  energy {F.energy:.4f} less entropy {F.entropy:.4f}")
print(f"  divergence {F.divergence:.4f} less log evidence {F.log_evidence:.4f}")
print(f"  complexity {F.complexity - F.log_prior_normaliser:.4f} less accuracy {F.accuracy:.4f}")
