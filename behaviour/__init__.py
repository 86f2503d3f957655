"""Recorded walks: followed, explained by models of choice, fitted and compared."""

from .choices import RELATIONS, Choices, Compass, Fork, choices_of, gathered
from .comparing import ALL, How, preferred, result_of, run_task, tasks_of
from .crossing import FOLDS, LEVELS, GroupFit, fit_group, folds_of, held_out
from .fitting import Around, Fit, fit
from .ground import LEAST_WAYS, Ground, Way, load_ground
from .models import LAPSE, MODELS, ChoiceModel, Prepared, models_named
from .prospects import LOOK_AHEAD, Followings, Foresight, Prospects, follow_route, new_agent
from .routes import Route, routes_of
from .simulating import simulate
from .source import Source
from .terms import Habit, Home, Novelty, Parameter, Recency, Term, Value
from .walks import Walk, load_walks

__all__ = [
    "ALL", "FOLDS", "LAPSE", "LEAST_WAYS", "LEVELS", "LOOK_AHEAD", "MODELS", "RELATIONS", "Around", "ChoiceModel",
    "Choices", "Compass", "Fit", "Followings", "Foresight", "Fork", "Ground", "GroupFit", "Habit", "Home", "How",
    "Novelty", "Parameter", "Prepared", "Prospects", "Recency", "Route", "Source", "Term", "Value", "Walk", "Way",
    "choices_of", "fit", "fit_group", "folds_of", "follow_route", "gathered", "held_out", "load_ground", "load_walks",
    "models_named", "new_agent", "preferred", "result_of", "routes_of", "run_task", "simulate", "tasks_of",
]  # fmt: skip
