"""The open question about the map as a variable of the window's graph."""

from collections.abc import Sequence

import numpy as np

from ..model import FactorGraph

ELSEWHERE = "elsewhere"
"""Where the agent is if it is in no place of the map."""


def with_question(
    graph: FactorGraph, weights: Sequence[float], places: Sequence[int | None], *, followed: int, step: int
) -> FactorGraph:
    """The graph of a window with the hypotheses about the map, and where the agent is in each.

    It gains `h{t}`, which hypothesis is right, with its posterior weights, and `here{t}`: place s_t in the hypothesis
    that the map says, and in each other one the place that it has the agent in. The marginal of `here{t}` is what the
    agent believes.

    Args:
        graph: of the window, which speaks of the map alone.
        weights: `[H]` posterior probabilities of the hypotheses.
        places: `[H]` the place of the map where each has the agent; None for one that the map does not have.
        followed: number of the hypothesis that the map says.
        step: the time step t.
    """
    s, h, here = f"s{step}", f"h{step}", f"here{step}"
    known = graph.variable_named(s).domain
    others = {place for number, place in enumerate(places) if number != followed}
    domain = [*known, *sorted(place for place in others if place is not None and place not in known)]
    domain += [ELSEWHERE] if None in others else []
    table = np.zeros((len(domain), len(weights), len(known)))
    for number, place in enumerate(places):
        if number == followed:
            table[range(len(known)), number, range(len(known))] = 1.0
        else:
            table[domain.index(ELSEWHERE if place is None else place), number] = 1.0
    graph.variable(h, range(len(weights)), time=step)
    graph.variable(here, domain, time=step)
    graph.factor("H", [h], np.array(weights), kind="hypotheses", equation="P(hypothesis | o_1..t)")
    graph.factor("here", [here, h, s], table, kind="hypotheses", equation="P(place | hypothesis, s_t)")
    return graph
