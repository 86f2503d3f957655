"""Recorded walks ready to be fitted, in whatever process; what an agent expected along them is kept in a folder."""

import hashlib
import io
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ..model import CogmapError, write_whole
from .choices import Choices, choices_of
from .ground import Ground
from .prospects import LOOK_AHEAD, Followings, Prospects, follow_route
from .routes import Route

_VERSION = 1  # of what is kept; another is made anew
_ARRAYS = ("choice", "way", "gain", "extra", "age")


@dataclass(frozen=True, eq=False)
class Source:
    """Walks, their world, and the folder that keeps what an agent expected along them."""

    routes: Sequence[Route]  # of each individual
    ground: Ground  # of their world
    folder: Path  # a folder that is there; what it keeps of the same walks is used again
    look_ahead: int = LOOK_AHEAD  # steps that the agent looks ahead

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Source) and (self.folder, self.digest) == (other.folder, other.digest)

    def __hash__(self) -> int:
        return hash((self.folder, self.digest))

    @cached_property
    def digest(self) -> str:
        """Changes with the walks, the world and the look-ahead."""
        parts = "".join(self._digest(i) for i in range(len(self.routes)))
        return hashlib.sha256(parts.encode()).hexdigest()[:16]

    def follow(self, individual: int) -> None:
        """Lead an agent along one walk and keep what it expected, unless that was done before."""
        if self.followed(individual) is None:
            found = follow_route(self.routes[individual], self.ground, look_ahead=self.look_ahead)
            arrays: dict[str, Any] = {name: getattr(found.prospects, name) for name in _ARRAYS}
            facts = np.array([found.astray, found.entered, found.nodes])
            buffer = io.BytesIO()
            np.savez_compressed(buffer, digest=np.array(self._digest(individual)), facts=facts, **arrays)
            write_whole(self._file(individual), buffer.getvalue())

    def followed(self, individual: int) -> Followings | None:
        """How that went; None where it was not done yet, or with other walks."""
        try:
            with np.load(self._file(individual), allow_pickle=False) as kept:
                if str(kept["digest"]) != self._digest(individual):
                    return None
                astray, entered, nodes = kept["facts"].tolist()
                return Followings(Prospects(*(kept[name] for name in _ARRAYS)), astray, entered, nodes)
        except (OSError, KeyError, ValueError, zipfile.BadZipFile):
            return None

    def choices(self, *, agent: bool = False) -> tuple[Choices, ...]:
        """The choices of each individual.

        Args:
            agent: with what an agent expected at each; `follow` has to be called before.

        Raises:
            CogmapError: no agent has followed one of them.
        """
        return _choices(self, agent)

    def choices_of(self, individual: int, *, agent: bool = False) -> Choices:
        """The same of one individual.

        Raises:
            CogmapError: the agent is asked for, and none has followed this individual.
        """
        route, prospects = self.routes[individual], None
        if agent:
            followings = self.followed(individual)
            if followings is None:
                raise CogmapError(f"walks: no agent has followed {route.individual} yet; call follow first")
            prospects = followings.prospects
        return choices_of(route, self.ground, prospects=prospects)

    def _file(self, individual: int) -> Path:
        return self.folder / f"followed-{individual:03d}.npz"

    def _digest(self, individual: int) -> str:
        route, ground = self.routes[individual], self.ground
        ways = [[(way.target, way.action) for way in ways] for ways in ground.ways]
        words = (_VERSION, self.look_ahead, ground.sights, ways, dict(ground.motions), route.places.tolist())
        return hashlib.sha256(repr(words).encode()).hexdigest()


@lru_cache(maxsize=4)
def _choices(source: Source, agent: bool) -> tuple[Choices, ...]:
    """Kept, so that a process makes them once however many tasks it does."""
    return tuple(source.choices_of(i, agent=agent) for i in range(len(source.routes)))
