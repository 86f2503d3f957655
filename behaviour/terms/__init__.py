"""Terms of choice models, a file each."""

from .base import Parameter, Term
from .habit import Habit
from .home import Home
from .novelty import Novelty
from .recency import Recency
from .value import Value

__all__ = ["Habit", "Home", "Novelty", "Parameter", "Recency", "Term", "Value"]
