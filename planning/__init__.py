"""What to do: policies, rollouts, expected free energy, choice."""

from .choices import CHOICES, TIE, Best, Choice, Outward, Sampled, Verdict
from .energy import ExpectedFreeEnergy
from .local import (
    Frontier,
    LocalCache,
    LocalModel,
    MapHypotheses,
    MapView,
    Preferences,
    Structure,
    Surroundings,
    Transitions,
    local_model,
)
from .plan import Plan, policy_posterior
from .planner import Planner
from .policies import (
    BY,
    MAX_LOOK_AHEAD,
    POLICIES,
    Exhaustive,
    LShaped,
    MapGuided,
    Options,
    Policies,
    PolicyGenerator,
    SelfAvoiding,
)
from .reference import evaluate_plain
from .rollout import evaluate
from .terms import (
    TERMS,
    Collision,
    Cost,
    Learned,
    PositionInformation,
    Rollout,
    SightInformation,
    StateInformation,
    Staying,
    Step,
    StructureInformation,
    Term,
    TransitionInformation,
    Utility,
    WayBack,
    WayThere,
)

__all__ = [
    "BY", "CHOICES", "MAX_LOOK_AHEAD", "POLICIES", "TERMS", "TIE", "Best", "Choice", "Collision", "Cost", "Exhaustive",
    "ExpectedFreeEnergy", "Frontier", "LShaped", "Learned", "LocalCache", "LocalModel", "MapGuided", "MapHypotheses",
    "MapView", "Options", "Outward", "Plan", "Planner", "Policies", "PolicyGenerator", "PositionInformation",
    "Preferences", "Rollout", "Sampled", "SelfAvoiding", "SightInformation", "StateInformation", "Staying", "Step",
    "Structure", "StructureInformation", "Surroundings", "Term", "TransitionInformation", "Transitions", "Utility",
    "Verdict", "WayBack", "WayThere", "evaluate", "evaluate_plain", "local_model", "policy_posterior",
]  # fmt: skip
