"""A factor graph of your own, with a table that is learned.

The graph language knows nothing of mazes. Here a patient is healthy or ill on each of twelve days, and reports how
it feels. All days share two tables, one from day to day and one from health to report; both are tied to their factors
and learned from the reports alone, by variational Bayes: all reports are one row of data. The evidence lower bound
rises until the tables explain the reports.
"""

from __future__ import annotations

from cogmap.inference import fit, free_energy, infer, most_probable
from cogmap.model import ConditionalTable, FactorGraph

REPORTS = ["fine", "fine", "cold", "fine", "fever", "fever", "cold", "fever", "fever", "fine", "fine", "fine"]

change = ConditionalTable([[3.0, 1.0], [1.0, 3.0]])  # prior counts [today, the day before]: health lasts
report = ConditionalTable([[2.0, 1.0], [1.5, 1.5], [1.0, 2.0]])  # [report, health]: a hint of what fever means

graph = FactorGraph()
for day, told in enumerate(REPORTS):
    graph.variable(f"health{day}", ("healthy", "ill"), time=day)
    graph.variable(f"report{day}", ("fine", "cold", "fever"), time=day)
    if day == 0:
        graph.factor("P", ["health0"], [0.9, 0.1], kind="prior")
    else:
        graph.conditional(f"health{day}", [f"health{day - 1}"], change, kind="transition")
    graph.conditional(f"report{day}", [f"health{day}"], report, kind="likelihood")
    graph = graph.observe(f"report{day}", told)

found = fit(graph, [{}], method="variational")  # what was seen is evidence of the graph: the row adds nothing
for turn, bound in enumerate(found.objective[:6]):
    print(f"turn {turn}: evidence lower bound {bound:.4f} nats")

posterior, best = infer(found.graph), most_probable(found.graph).assignment
print("\nP(today | the day before):", found.graph.factor_named("P(health1, health0)").dense().round(2).tolist())
print("P(report | health):", found.graph.factor_named("P(report0, health0)").dense().round(2).tolist())
print("\nday report   P(ill)  most probable")
for day, told in enumerate(REPORTS):
    print(f"{day:3} {told:8} {posterior.probability(f'health{day}', 'ill'):6.2f}  {best[f'health{day}']}")
F = free_energy(posterior)
print(f"\nfree energy {F.free_energy:.3f} = complexity {F.complexity:.3f} - accuracy {F.accuracy:.3f} nats")
