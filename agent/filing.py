"""An agent as a file, and back."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from os import PathLike
from typing import Any, Self

from numpy.typing import NDArray

from ..model import CogmapError, Growth, Motions, Pose, Sensor, map_state, restore_map
from ..planning import Planner
from . import storage
from .packing import Arrays, pack, unpacked_state
from .parts import MissingPart, made_of
from .settings import Settings
from .wholeness import Whole

KEEP = 10_000  # steps of which the trace and the log of growth keep everything, unless told otherwise


class Filed(Whole):
    """An agent that can be saved, and loaded."""

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything the agent knows to an npz file (JSON header, schema version, no pickle).

        Raises:
            CogmapError: a label or a setting cannot be written, or the folder cannot be.
        """
        storage.write(path, *self.state())

    @classmethod
    def load(
        cls,
        path: str | PathLike[str],
        *,
        sensors: Iterable[Sensor] | None = None,
        pose: Pose | None = None,
        growth: Growth | None = None,
        planner: Planner | None = None,
        settings: Settings | None = None,
    ) -> Self:
        """The agent that `save` wrote; it walks on exactly as that one would have.

        Args:
            path: of the file.
            sensors: new ones like those that it was made with, where some are not of this library.
            pose, growth, planner: the same.
            settings: others than those that it was saved with, to go by from now on.

        Raises:
            CogmapError: no such file, or it is no saved map, truncated, or from a newer schema.
        """
        if not isinstance(settings, Settings | None):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise CogmapError(f"load: settings is {settings!r}; give Settings(...), or none for those in the file")
        with storage.reading(path) as (header, arrays):
            return cls.from_state(
                header, arrays, sensors=sensors, pose=pose, growth=growth, planner=planner, settings=settings
            )

    def state(self) -> tuple[dict[str, Any], Arrays]:
        """Everything that the next steps depend on: a JSON header and arrays (the trace is left out).

        Raises:
            CogmapError: the agent is torn, or a label cannot be written.
        """
        self._check_whole()
        _ = self.steps and self.expected  # the log of changes, which tells it, is not saved
        map_, arrays = map_state(self.map)
        header = {
            "motions": _told(self.map.motions),
            "settings": self.settings.to_dict(),
            "parts": self.parts,
            "rng": self.rng.bit_generator.state,
            "map": map_,
            "state": pack(replace(self._state, begun=0), arrays, "state"),
        }
        if self._recognising:
            header["recognition"] = self._recognition.state(arrays)
        return header, arrays

    @classmethod
    def from_state(
        cls,
        header: Mapping[str, Any],
        arrays: Mapping[str, NDArray[Any]],
        *,
        settings: Settings | None = None,
        **parts: Any,
    ) -> Self:
        """The agent that `state` took apart; see `load`."""
        turning = header.get("turning", {})
        if turning.get("turn") or turning.get("sought"):
            raise MissingPart("load: the file is of an agent whose frame has turned; use TurningAgent.load")
        agent = cls.__new__(cls)
        made = made_of(header["parts"], **parts)
        motions = _motions(header["motions"])
        saved = Settings.from_dict(header["settings"])
        agent._assemble(motions, *made, settings or saved, None)
        agent.keep = KEEP
        restore_map(agent.map, header["map"], arrays)
        agent.rng.bit_generator.state = header["rng"]
        agent._state = unpacked_state(header["state"], arrays, agent.map, agent.settings.window)
        recognition = agent._recognition
        if "recognition" in header:
            recognition.restore(header["recognition"], arrays)
            recognition.looked = None if agent._state.percept is None else agent._state.percept.open
        if not agent._recognising:
            recognition.forget()
        elif recognition.followed is None and agent._state.belief is not None:
            recognition.know(agent._state.belief.place, step=agent._state.steps)
        return agent


def _told(motions: Motions) -> dict[str, Any]:
    """Actions as plain JSON values; where they have no displacements, who undoes whom is said instead."""
    reverse = {} if motions.placed else {"reverse": motions.inverse}
    takes = {"takes": motions.takes} if motions.takes else {}
    return {"names": motions.names, "displacements": motions.displacements, **reverse, **takes}


def _motions(told: Mapping[str, Any]) -> Motions:
    if "reverse" in told:
        return Motions(tuple(told["names"]), (), tuple(told["reverse"]), tuple(told.get("takes", ())))
    return Motions.of(dict(zip(told["names"], told["displacements"], strict=True)))
