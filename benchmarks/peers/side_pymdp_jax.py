"""pymdp on JAX: `Agent.update_empirical_prior` with `infer_states`, and `infer_policies`, each compiled as one."""

from __future__ import annotations

import equinox
import jax
import jax.numpy as jnp
import numpy as np
from problem import Arrays
from pymdp.agent import Agent
from timing import main


def side(problem: Arrays):
    """The two calls."""
    policies = jnp.array(problem["policies"])[:, :, None]
    agent = Agent(
        A=[jnp.array(problem["A"])[None]],
        B=[jnp.array(problem["B"])[None]],
        C=[jnp.array(problem["log_C"])[None]],
        D=[jnp.array(problem["D"])[None]],
        policies=policies,
        gamma=16.0,
        batch_size=1,
    )
    before, action, sight = (
        [agent.D[0][:, None]],
        jnp.array([[int(problem["action"])]]),
        [jnp.array([problem["sight"]])],
    )
    last = {}

    @equinox.filter_jit
    def perceive(agent: Agent, action: jax.Array, before: list[jax.Array], sight: list[jax.Array]):
        prior = agent.update_empirical_prior(action, before)
        return agent.infer_states(sight, prior)

    @equinox.filter_jit
    def plan(agent: Agent, qs: list[jax.Array]):
        return agent.infer_policies(qs)

    def inference() -> None:
        last["qs"] = jax.block_until_ready(perceive(agent, action, before, sight))

    def planning() -> None:
        last["q_pi"], last["G"] = jax.block_until_ready(plan(agent, last["qs"]))

    return inference, planning, lambda: (np.asarray(last["qs"][0]).ravel(), np.asarray(last["G"]).ravel())


if __name__ == "__main__":
    main(side, ("inferactively-pymdp", "jax", "numpy"))
