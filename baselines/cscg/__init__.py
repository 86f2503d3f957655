"""The clone-structured cognitive graph (George et al. 2021), from its mathematics up to an agent."""

from .agent import CscgAgent
from .bridging import Bridge, Roads, bridge
from .inference import Posterior, filtered, followed, log_likelihood, posterior
from .learning import Fit, baum_welch, log_prior
from .model import CloneModel, empty_model, sprinkled
from .rooms import room_transitions
from .sequence import Triples, Walk
from .settings import CscgSettings
from .viterbi import HardFit, most_probable_path, viterbi_training

__all__ = [
    "Bridge", "CloneModel", "CscgAgent", "CscgSettings", "Fit", "HardFit", "Posterior", "Roads", "Triples", "Walk",
    "baum_welch", "bridge", "empty_model", "filtered", "followed", "log_likelihood", "log_prior", "most_probable_path",
    "posterior", "room_transitions", "sprinkled", "viterbi_training",
]  # fmt: skip
