"""MiniGrid is imported where it is used, and named where it is missing."""

import os
from importlib import import_module

from ..errors import WorldError

INSTALL = "pip install 'cogmap[minigrid]'"


def need_minigrid() -> None:
    """Import MiniGrid, which registers its environments; pygame, which comes with it, keeps its greeting to itself.

    Raises:
        WorldError: it is not installed; the message has the command that installs it.
    """
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    try:
        import_module("minigrid")
    except ImportError as error:
        raise WorldError(f"worlds of MiniGrid need its package ({error}); install it with {INSTALL}") from error
