"""pymdp before it moved to JAX: `Agent.infer_states` and `Agent.infer_policies`."""

from __future__ import annotations

import numpy as np
from problem import Arrays
from pymdp.agent import Agent
from pymdp.utils import to_obj_array
from timing import main


def side(problem: Arrays):
    """The two calls."""
    agent = Agent(
        A=to_obj_array(problem["A"]),
        B=to_obj_array(problem["B"]),
        C=to_obj_array(problem["log_C"]),
        D=to_obj_array(problem["D"]),
        policies=[policy[:, None] for policy in problem["policies"]],
        policy_len=problem["policies"].shape[1],
    )
    before, action, sight = to_obj_array(problem["D"]), np.array([int(problem["action"])]), [int(problem["sight"])]

    def inference() -> None:
        agent.qs, agent.action = before, action
        agent.infer_states(sight)

    return inference, agent.infer_policies, lambda: (agent.qs[0], agent.G)


if __name__ == "__main__":
    main(side, ("inferactively-pymdp", "numpy"))
