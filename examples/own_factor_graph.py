"""A factor graph of your own, with a table that is learned.

The graph language knows nothing of mazes. Here a patient is healthy or ill on each of twelve days, and reports how
it feels. All days share two tables, one from day to day and one from health to report; both are tied to their factors
and learned from the reports alone by expectation maximisation: infer, give each table its expected counts, repeat.
The log evidence rises until the tables explain the reports.
"""

from __future__ import annotations

import numpy as np
from cogmap.inference import free_energy, infer, most_probable
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

for turn in range(6):
    posterior = infer(graph)
    print(f"turn {turn}: log evidence {posterior.log_evidence:.4f} nats")
    for table in (change, report):
        table.counts = table.prior.copy()  # each turn counts the days anew
        table.learn(posterior.expected_counts(table))  # summed over all factors that are tied to it
    graph = graph.refreshed()  # a new graph with the tables as they are now

posterior, best = infer(graph), most_probable(graph).assignment
print("\nP(today | the day before):", np.round(change.mean(), 2).tolist())
print("P(report | health):", np.round(report.mean(), 2).tolist())
print("\nday report   P(ill)  most probable")
for day, told in enumerate(REPORTS):
    print(f"{day:3} {told:8} {posterior.probability(f'health{day}', 'ill'):6.2f}  {best[f'health{day}']}")
F = free_energy(posterior)
print(f"\nfree energy {F.free_energy:.3f} = complexity {F.complexity:.3f} - accuracy {F.accuracy:.3f} nats")
