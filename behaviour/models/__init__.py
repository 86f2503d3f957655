"""Models of choice, a file each."""

from collections.abc import Sequence

from ...model import CogmapError
from .base import LAPSE, ChoiceModel, Prepared
from .cogmap import COGMAP
from .habit import HABIT
from .habit2 import HABIT2
from .habit_cogmap import HABIT_COGMAP
from .novelty import NOVELTY
from .uniform import UNIFORM

MODELS = {model.name: model for model in (UNIFORM, HABIT, HABIT2, NOVELTY, COGMAP, HABIT_COGMAP)}


def models_named(names: Sequence[str]) -> list[ChoiceModel]:
    """The models of these names, all where none is given. Raises CogmapError: there is none of that name."""
    if unknown := [name for name in names if name not in MODELS]:
        raise CogmapError(f"no model is called {unknown[0]!r}; choose from {', '.join(MODELS)}")
    return [MODELS[name] for name in dict.fromkeys(names or MODELS)]


__all__ = ["LAPSE", "MODELS", "ChoiceModel", "Prepared", "models_named"]
