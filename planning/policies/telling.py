"""Walks that tell hypotheses about the map apart."""

from collections import deque

from ..local import State, Structure
from .far_ways import MORE

Path = tuple[int, ...]

STATES = 1000  # joint states of the hypotheses that the search looks at, at most
ENOUGH = 0.9  # share of what there is to be told from which no longer walk is looked for
LEAST_TOLD = 2e-3  # nats about the map below which a walk is not worth its steps
MANY = 8  # walks that are found, at most


def telling_walks(structure: Structure) -> list[Path]:
    """The shortest walks that tell so much, and more than all that are shorter; the last of them tell most.

    Breadth first over where the agent would be under each hypothesis, however far, so that an agent in doubt goes where
    it will know, when all is visited too. Who cuts the map and who makes policies both ask.
    """
    if "telling" not in structure.asked:
        structure.asked["telling"] = _telling_walks(structure)
    return structure.asked["telling"]


def _telling_walks(structure: Structure) -> list[Path]:
    moves = structure.hypotheses.moves
    queue, seen = deque[tuple[Path, State]]([((), structure.start)]), {structure.start}
    found, best = list[Path](), LEAST_TOLD
    while queue and best < ENOUGH * structure.entropy and len(seen) < STATES:
        path, before = queue.popleft()
        for action in moves:
            state = structure.walk(before, action)
            if state in seen:
                continue
            seen.add(state)
            told = structure.told(state[1])
            if told > MORE * best:
                found, best = [*found, (*path, action)], told
            if None not in state[0]:  # nobody knows what comes after a place never seen
                queue.append(((*path, action), state))
    return found[-MANY:]
