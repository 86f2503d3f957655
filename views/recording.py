"""A walk as it was believed, step by step: recorded beside the agent, kept in a file, shown by `views.replay`."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator
from dataclasses import dataclass
from os import PathLike
from typing import Any

from ..agent import Agent, StepRecord
from ..model import CogmapError, decode, encode, plain, shown, window_graph
from ..planning import Term
from ..worlds import Chart, Place
from .map_picture import KNOWN, MapPicture
from .pixels import small_png
from .recording_check import check
from .recording_file import FORMAT, SCHEMA, read, upgraded, write
from .recording_frames import NUMBERS, WindowWatch, plan_frame, term_json, world_json
from .speaking import Spoken, spoken
from .world_plot import as_place, world_picture

DIGITS = 4
MOST_PIXELS = 8_000_000  # bytes
MOST_PLACES = 8  # places of the belief that are kept, the most probable ones


@dataclass(frozen=True, slots=True)
class Recording:
    """A recorded walk."""

    data: dict[str, Any]  # the content of the file, as JSON values

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Recording:
        """The recording that `save` wrote, now or in an earlier version.

        Raises:
            CogmapError: no such file, no recording, truncated, damaged, or of another schema.
        """
        data = read(path)
        try:
            data = upgraded(data)
            check(data)
        except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
            why = " ".join(f"{type(error).__name__}: {error}".split())[:300]
            raise CogmapError(f"recording: {path} is damaged ({why}); record it again") from error
        return cls(data)

    def save(self, path: str | PathLike[str]) -> None:
        """Write it as JSON, packed where the name ends in .gz; the file is replaced whole, or not at all.

        Raises:
            CogmapError: it cannot be written.
        """
        write(self.data, path)

    @property
    def frames(self) -> list[dict[str, Any]]:
        """The steps, in order."""
        return self.data["frames"]

    @property
    def sights(self) -> list[Hashable]:
        """Labels of what places show, by number."""
        return [decode(label) for label in self.data["sights"]]

    @property
    def places(self) -> list[Hashable]:
        """What the true places are called, by number."""
        return [decode(place) for place in self.data["places"]]

    def maps(self) -> Iterator[MapPicture]:
        """The map after each step: always the same object, changed in place."""
        picture = MapPicture.recorded(self.data)
        for frame in self.frames:
            picture.apply(frame["map"])
            yield picture

    def __len__(self) -> int:
        return len(self.frames)


class Recorder:
    """Records an agent; call `add` after every `agent.step`.

    Args:
        chart: the true map, where it is to be shown: `world.chart`, or a maze.
        title: what the walk is called.
        goals: labels of the preferred sights, to be marked.
    """

    def __init__(self, chart: Chart | None = None, *, title: str = "", goals: Iterable[Hashable] = ()) -> None:
        self._chart, self._world = chart, None if chart is None else world_json(world_picture(chart))
        self._places: dict[Place, int] = {} if chart is None else {place: n for n, place in enumerate(chart.places)}
        self._title = str(title)
        self._goals = [encode(label) for label in goals]
        self._agent: Agent | None = None
        self._frames: list[dict[str, Any]] = []
        self._origin: int | None = None
        self._seen = 0  # bytes of pictures
        self._window = WindowWatch()
        self._terms: dict[str, Term] = {}  # of all plans
        self._named: list[tuple[str, ...]] = []  # those of each

    def __len__(self) -> int:
        return len(self._frames)

    def add(
        self,
        agent: Agent,
        *,
        place: Place = None,
        pixels: Any = None,
        closed_rooms: Iterable[Any] = (),
        closed_doors: Iterable[Any] = (),
    ) -> None:
        """Record the step that the agent has just made, before its action is carried out.

        Args:
            agent: always the same.
            place: the true place it is in, for showing only.
            pixels: `[height, width, 3]` what a body sees there, kept in the first `MOST_PIXELS` bytes of such pictures.
            closed_rooms: places closed at present.
            closed_doors: doors closed by themselves, as pairs of places.

        Raises:
            CogmapError: another agent, one that has made no step since the last call, a place that the chart does
                not have, pixels that are no RGB, or a label that JSON has not.
        """
        record = self._fresh(agent)
        frame = _frame(agent, record)
        if place is not None:
            frame["at"] = self._number(place)
            if record.step == 0:  # the agent calls the place where it wakes the origin
                self._origin = frame["at"]
        if pixels is not None and self._seen < MOST_PIXELS:
            frame["pixels"] = small_png(pixels)
            self._seen += len(frame["pixels"])
        if rooms := sorted(map(self._number, closed_rooms)):
            frame["closed_rooms"] = rooms
        if doors := sorted(sorted(map(self._number, door)) for door in closed_doors):
            frame["closed_doors"] = doors
        frame |= {
            "map": self._map.update(agent.map),
            "plan": plan_frame(agent.plan),
            "window": self._window.delta(window_graph(agent.map, agent.window)),
        }
        terms = agent.plan.expected_free_energy.terms
        self._terms |= {term.name: term for term in terms if term.name not in self._terms}
        self._named.append(tuple(term.name for term in terms))
        self._frames.append(frame)

    def _fresh(self, agent: Agent) -> StepRecord:
        if self._agent is None:
            self._agent, self._map = agent, MapPicture(agent.map.motions, agent.map.sights)
        if agent is not self._agent:
            raise CogmapError("recorder: this is another agent; use a recorder of its own for each")
        if not agent.trace:
            raise CogmapError("recorder: the agent has made no step; call add after agent.step")
        if self._frames and agent.trace[-1].step <= self._frames[-1]["step"]:
            raise CogmapError(f"recorder: step {agent.trace[-1].step} is recorded already; call add once a step")
        return agent.trace[-1]

    def _number(self, place: Place) -> int:
        place = as_place(place)
        if self._chart is not None and place not in self._places:
            raise CogmapError(f"recorder: {place!r} is no place of {self._chart.name!r}; see chart.places")
        return self._places.setdefault(place, len(self._places))

    def recording(self) -> Recording:
        """All that was recorded so far. Raises CogmapError: nothing was."""
        if self._agent is None or not self._frames:
            raise CogmapError("recorder: nothing was recorded; call add after agent.step")
        map_, motions = self._agent.map, self._agent.map.motions
        vectors = [list(vector) for vector in motions.displacements] if motions.placed else []
        data = {
            "format": FORMAT,
            "schema": SCHEMA,
            "title": self._title,
            "motions": {"names": list(motions.names), "displacements": vectors, "stay": motions.stay},
            "settings": self._agent.settings.to_dict(),
            "terms": [term_json(term) for term in self._terms.values()],
            "known": list(KNOWN),
            "sights": [encode(label) for label in map_.sights],
            "places": [encode(plain(place)) for place in self._places],
            "world": self._world,
            "origin": self._origin,
            "goals": self._goals,
            "frames": [_of_all(f, names, self._terms) for f, names in zip(self._frames, self._named, strict=True)],
        }
        return Recording(data)

    def save(self, path: str | PathLike[str]) -> None:
        """`recording().save(path)`."""
        self.recording().save(path)


def _way(reading: bool | float | None) -> float | None:
    """1, 0, P(open), or None where a way was not looked at."""
    return None if reading is None else int(reading) if reading in (0, 1) else round(reading, DIGITS)


def _voice(voice: Spoken) -> list[Any]:
    """Nats for the place believed in, None where nothing was seen, and what was expected there."""
    expected = None if voice.expected is None else shown(voice.expected)
    return [round(voice.nats, DIGITS) if voice.seen else None, expected]


def _frame(agent: Agent, record: StepRecord) -> dict[str, Any]:
    """What was sensed, grown and believed."""
    grown = [event for event in record.grown if event.kind != "time"]
    places = [[place, round(q, DIGITS)] for place, q in list(record.places.items())[:MOST_PLACES]]
    return {
        "step": record.step,
        "seen": {sensor: encode(label) for sensor, label in record.sensed.items()},
        **({"open": [_way(is_open) for is_open in record.open]} if record.open else {}),
        "spoke": {voice.sensor: _voice(voice) for voice in spoken(agent)},
        "grown": [[event.kind, event.index, event.source, event.action] for event in grown],
        "revised": record.revised,
        "belief": places,
        "rest": round(max(0.0, 1.0 - sum(q for _, q in places)), DIGITS),
        "certain": record.certain,
        **{name: round(float(getattr(record, name)), DIGITS) for name in NUMBERS},
    }


def _of_all(frame: dict[str, Any], names: tuple[str, ...], terms: Iterable[str]) -> dict[str, Any]:
    """A frame with a value for every term that any plan had, 0 of those that its own has not."""
    terms = tuple(terms)
    if names == terms:
        return frame

    def padded(values: list[float]) -> list[float]:
        of = dict(zip(names, values, strict=True))
        return [of.get(name, 0.0) for name in terms]

    plan = frame["plan"]
    return {**frame, "plan": {**plan, "terms": [padded(row) for row in plan["terms"]], "mean": padded(plan["mean"])}}
