"""The terms of expected free energy, one a file, and the list of them."""

from .base import KINDS, Term
from .collision import Collision
from .cost import Cost
from .learned import Learned
from .plain import Step
from .position_information import PositionInformation
from .rolled import Rollout, Staying
from .sight_information import SightInformation
from .state_information import StateInformation
from .structure_information import StructureInformation
from .transition_information import TransitionInformation
from .utility import Utility
from .way_back import WayBack
from .way_there import WayThere

TERMS: tuple[Term, ...] = (
    StateInformation(),
    SightInformation(),
    PositionInformation(),
    TransitionInformation(),
    StructureInformation(),
    Utility(),
    Collision(),
)
"""The terms of the paper, and one about the map as a whole, in the order in which they are shown."""

__all__ = [
    "KINDS", "TERMS", "Collision", "Cost", "Learned", "PositionInformation", "Rollout", "SightInformation",
    "StateInformation", "Staying", "Step", "StructureInformation", "Term", "TransitionInformation", "Utility",
    "WayBack", "WayThere",
]  # fmt: skip
