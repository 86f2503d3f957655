"""What to do: policies, rollouts, expected free energy, choice."""

from .choice import CHOICES, Plan, choose, plan, policy_posterior
from .energy import ExpectedFreeEnergy
from .information import collected_information, dirichlet_information
from .policies import GENERATORS, Policies, exhaustive, l_shaped, map_guided, self_avoiding
from .reach import Reach
from .reference import evaluate_plain
from .rollout import evaluate
from .transitions import Transitions

__all__ = [
    "CHOICES",
    "GENERATORS",
    "ExpectedFreeEnergy",
    "Plan",
    "Policies",
    "Reach",
    "Transitions",
    "choose",
    "collected_information",
    "dirichlet_information",
    "evaluate",
    "evaluate_plain",
    "exhaustive",
    "l_shaped",
    "map_guided",
    "plan",
    "policy_posterior",
    "self_avoiding",
]
