"""`cogmap walk`: somebody walks by the keys, and sees the agent's map grow."""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..text import Screen, count, place_text, say, say_saved
from . import options as opt

if TYPE_CHECKING:
    from ...agent import Agent
    from .. import Moment
    from .tracing import Tracing

Save = Annotated[Path | None, typer.Option(metavar="FILE.npz", help="Save the agent.")]
ARROWS = {"A": "up", "B": "down", "C": "right", "D": "left"}  # the last sign of what a terminal sends for an arrow
QUIT, NEXT = "q", "?"
_END = "\x04"


@opt.spread
def walk_command(at: opt.Where, save: Save = None, trace: opt.Trace = None) -> None:
    """Walk through a world yourself, by arrow keys or letters, and see the map grow that an agent makes of it.

    You see what it sees, and what it would do. Keys may also come from a pipe: `echo 'rrd?' | cogmap walk 3x3`.
    """
    from ... import experiments as lab
    from .tracing import Tracing

    place = at.made()
    chart = lab.chart_of(place)
    lab.check_outputs([save, trace], inputs=[at.world])
    parts = lab.Parts.named(look_ahead=at.look_ahead, pose=at.pose)
    tracing = Tracing(trace, chart, title=f"{chart.name}, by hand, seed {at.seed}")
    session = lab.set_out("walk", place, at.seed, agent=parts)
    with keys() as key:
        walker = _Walker(session.agent, chart.name, key, tracing)
        session.agent = walker
        session.run(sys.maxsize, walker.look)
    where, size = place_text(session.place), count(walker.steps, "step")
    if not Screen().is_terminal:
        walker.draw()
    say(f"{size} through {chart.name}, truly at {where} in the end; {walker.agent.map!r}")
    if save is not None:
        walker.agent.save(save)
    tracing.save()
    say_saved(agent=save, trace=trace)


class _Walker:
    """Somebody at the keys, with an agent that looks on: it is told what was done, and says what it would do."""

    def __init__(self, agent: Agent, name: str, key: Callable[[], str], tracing: Tracing) -> None:
        self.agent, self.name, self.steps = agent, name, 0
        self._key, self._tracing, self._screen = key, tracing, Screen()
        self._keys = keys_of(agent.map.motions.names)
        self._done, self._last = False, ""

    def step(self, observation: Mapping[str, Any]) -> int:
        """Show what there is to see, and ask for the next action; where there is none, it stays."""
        taken = {"taken": self._last} if self._last else {}
        suggested = self.agent.step({**taken, **observation})
        names = self.agent.map.motions.names
        self._show(observation, names[suggested])
        action = self._asked(names[suggested])
        self._done = action is None
        self._last = names[self.agent.map.motions.stay] if action is None else action
        self.steps += not self._done
        return names.index(self._last)

    def look(self, moment: Moment) -> bool:
        """Record the step; True ends the walk."""
        self._tracing(replace(moment, agent=self.agent))
        return self._done

    def _asked(self, suggested: str) -> str | None:
        """The action of the next key that is one; None at the end."""
        from ...model import CogmapError

        while (key := self._key()) not in ("", _END, QUIT):
            if key == NEXT:
                return suggested
            if key in self._keys:
                return self._keys[key]
            wrong = f"walk: {key!r} is no key; {self._legend()}"
            if not sys.stdin.isatty():
                raise CogmapError(wrong)
            self._screen.print(wrong, markup=False, highlight=False)
        return None

    def _legend(self) -> str:
        letters = {name: key for key, name in self._keys.items() if len(key) == 1}
        own = ", ".join(f"{key} {name}" for name, key in letters.items())
        arrows = "arrows, " * (len(letters) < len(self._keys))
        return f"{arrows}{own}, {NEXT} what it would do, {QUIT} end"

    def draw(self) -> None:
        """The map as it is."""
        from .map_text import map_text
        from .walk_text import has_unicode

        self._screen.print(map_text(self.agent, self._screen.width, unicode=has_unicode(self._screen)))

    def _show(self, observation: Mapping[str, Any], suggested: str) -> None:
        agent, screen = self.agent, self._screen
        at, names = agent.map.position(agent.belief.place), agent.map.motions.names
        ways = [name for name, is_open in zip(names, observation.get("open", ()), strict=False) if is_open]
        seen = ", ".join(f"{sensor} {label}" for sensor, label in agent.trace[-1].sensed.items())
        believed = f"place {agent.belief.place}" + (f" at {tuple(at)}" if at is not None else "")
        lines = (
            f"step {self.steps}{f', {self._last}' * bool(self._last)}: {seen or 'nothing seen'}"
            + (f"; open: {', '.join(ways)}" if ways else ""),
            f"it believes to be in {believed} at {agent.belief.certainty:.2f}; "
            f"free energy {agent.belief.free_energy:.2f} nats; {agent.map!r}",
            f"it would go: {suggested}",
        )
        if screen.is_terminal:
            screen.clear()
            say(title=self.name)
            self.draw()
            say(*lines)
            say(self._legend(), style="dim")
        else:
            say(*lines)


def keys_of(names: Sequence[str]) -> dict[str, str]:
    """Actions by key: arrows where they have these names, first letters that only one has, else numbers and letters."""
    first = Counter(name[:1].lower() for name in names)
    own = {name[0].lower(): name for name in names if first[name[:1].lower()] == 1 and name[0].isalpha()}
    own.pop(QUIT, None)
    free = (sign for sign in "123456789abcdefghijklmnoprstuvwxyz" if sign not in own)
    rest = zip(free, (name for name in names if name not in own.values()), strict=False)
    return {**{f"arrow {name}": name for name in ARROWS.values() if name in names}, **own, **dict(rest)}


@contextmanager
def keys() -> Generator[Callable[[], str]]:
    """Yields what waits for the next key: a sign, `arrow up` and so on, "" at the end of the input."""
    if not sys.stdin.isatty():
        yield lambda: _key(lambda: sys.stdin.read(1))
        return
    import termios
    import tty

    stream = sys.stdin.fileno()
    before = termios.tcgetattr(stream)
    tty.setcbreak(stream)
    try:
        yield lambda: _key(lambda: os.read(stream, 1).decode(errors="replace"))
    finally:
        termios.tcsetattr(stream, termios.TCSADRAIN, before)


def _key(read: Callable[[], str]) -> str:
    while (sign := read()).isspace():
        pass
    if sign != "\x1b":
        return sign.lower()
    last = read() and read()  # a terminal sends Esc [ A, or Esc O A
    return f"arrow {ARROWS[last]}" if last in ARROWS else "Esc"
