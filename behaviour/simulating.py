"""Simulated individuals: walks drawn from a model, with parameters that are known."""

from collections.abc import Mapping

import numpy as np

from ..model import CogmapError
from .choices import Compass, Fork, gathered
from .ground import Ground
from .models import ChoiceModel
from .prospects import LOOK_AHEAD, Foresight, Prospects, new_agent
from .routes import Route


def simulate(
    model: ChoiceModel,
    ground: Ground,
    *,
    steps: int,
    parameters: Mapping[str, float] | None = None,
    seed: int = 0,
    name: str = "simulated",
    look_ahead: int = LOOK_AHEAD,
) -> Route:
    """Draw a walk from a model. It begins at home, or else at the first place; each return there ends a bout.

    Where there are fewer than three ways it goes on, and turns back at dead ends only.

    Args:
        model: what chooses.
        ground: of the world.
        steps: moves to make.
        parameters: by name; those not given are where fits set out.
        seed: of the draws.
        name: of the individual.
        look_ahead: steps that the agent looks ahead that the model needs.

    Raises:
        CogmapError: parameters that the model does not have or that are out of bounds, or `steps` below 1.
    """
    if steps < 1:
        raise CogmapError(f"simulate: steps is {steps}; use 1 or more")
    values, rng, home = model.values(parameters), np.random.default_rng(seed), ground.home or 0
    foresight = Foresight(new_agent(ground, look_ahead=look_ahead), ground) if model.needs_agent else None
    compass, places, bouts = Compass(ground), [home], [0]
    while True:
        fork, prospects = compass.arrive(places[-1]), None
        if foresight is not None:
            before = places[-2] if len(places) > 1 else None
            foresight.arrive(ground.observation(places[-1], before=before))
            prospects = None if fork is None else Prospects.joined([foresight.look(fork.ways)])
        if len(places) > steps:
            return Route(name, np.array(places), np.array(bouts))
        ahead = _onward(ground, places) if fork is None else _drawn(model, ground, values, places, fork, prospects, rng)
        bouts.append(bouts[-1] + (places[-1] == home and len(places) > 1))
        places.append(ahead)


def _onward(ground: Ground, places: list[int]) -> int:
    ways = [way.target for way in ground.ways[places[-1]]]
    back = places[-2] if len(places) > 1 else None
    return next((target for target in ways if target != back), ways[0])


def _drawn(
    model: ChoiceModel,
    ground: Ground,
    values: np.ndarray,
    places: list[int],
    fork: Fork,
    prospects: Prospects | None,
    rng: np.random.Generator,
) -> int:
    route = Route("", np.array(places), np.zeros(len(places), dtype=np.int64))
    prepared = model.prepare(gathered([fork], [0], route, ground, prospects=prospects))
    p = model.probabilities(prepared, values)[0, : len(fork.ways)]
    return fork.ways[int(rng.choice(len(p), p=p / p.sum()))].target
