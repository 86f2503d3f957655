"""Our side: exact inference in a factor graph of one step, and G of the same policies over the same dense tables."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from cogmap.inference import infer
from cogmap.model import FactorGraph, Motions
from cogmap.planning import LocalModel, Policies, Transitions, evaluate, policy_posterior
from problem import MOVES, NAMES, Arrays
from timing import main


def graph_of(problem: Arrays) -> FactorGraph:
    """P(s0) P(s1 | s0, a) P(o1 | s1)."""
    sights, places = problem["A"].shape
    graph = FactorGraph()
    graph.variable("s0", range(places), time=0)
    graph.variable("s1", range(places), time=1)
    graph.variable("o1", range(sights), time=1)
    graph.factor("D", ["s0"], problem["D"])
    graph.factor("B", ["s1", "s0"], problem["B"][:, :, int(problem["action"])])
    graph.factor("A", ["o1", "s1"], problem["A"])
    return graph


def model_of(problem: Arrays) -> LocalModel:
    """The tables as planning takes them: nothing left to learn, no walls to run into."""
    sights, places = problem["A"].shape
    length = problem["policies"].shape[1]
    nothing = np.zeros((places, length + 1))
    return LocalModel(
        motions=Motions.of(dict(zip(NAMES, MOVES, strict=True))),
        look_ahead=length,
        places=np.arange(places),
        belief=problem["D"],
        A=problem["A"],
        multiplicity=np.ones(sights),
        log_C=problem["log_C"],
        log_C_place=np.zeros(places),
        B=Transitions.of(problem["B"]),
        blocked=np.zeros((places, len(MOVES))),
        collision_cost=0.0,
        information=dict.fromkeys(("sight", "position", "transition"), nothing),
        successor=np.full((places, len(MOVES)), -1),
        entered=np.ones(places, dtype=np.bool_),
        position=np.full((places, 2), np.nan),
    )


def side(problem: Arrays):
    """The two calls."""
    graph, model, policies = graph_of(problem), model_of(problem), Policies(problem["policies"])
    evidence = {"o1": int(problem["sight"])}
    last = {}

    def inference() -> None:
        last["posterior"] = infer(graph, evidence=evidence).marginal("s1")

    def planning() -> None:
        last["G"] = evaluate(replace(model, belief=last["posterior"]), policies).G
        policy_posterior(last["G"])

    return inference, planning, lambda: (last["posterior"], -last["G"])


if __name__ == "__main__":
    main(side, ("cogmap", "numpy"))
