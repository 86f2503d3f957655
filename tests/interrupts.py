"""Interrupts at a line of choice."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

from cogmap.agent import Agent


class Interrupt(BaseException):
    """As Ctrl-C is: no `Exception`."""


def interrupted(work: Callable[[], object], line: int) -> int:
    """Do the work, with an `Interrupt` before the line of that number (from 1); answers how many lines there were."""
    count, before = 0, sys.gettrace()

    def in_function(frame: FrameType, event: str, arg: Any) -> Any:
        nonlocal count
        if event == "line":
            count += 1
            if count == line:
                sys.settrace(before)
                raise Interrupt
        return in_function

    def everywhere(frame: FrameType, event: str, arg: Any) -> Any:
        return in_function if str(frame.f_globals.get("__name__")).startswith("cogmap.") else None

    sys.settrace(everywhere)
    try:
        work()
    finally:
        sys.settrace(before)
    return count


def was_interrupted(work: Callable[[], object], line: int) -> bool:
    """Whether the work got as far as that line: the next time it may have fewer, as something was looked up."""
    try:
        interrupted(work, line)
    except Interrupt:
        return True
    return False


def lines_of(work: Callable[[], object]) -> int:
    """How many lines the work has."""
    return interrupted(work, -1)


def content(agent: Agent) -> tuple[Any, ...]:
    """All that the next steps of an agent depend on, in an order that does not depend on how it came about."""
    header, arrays = agent.state()
    rest: Any = json.loads(json.dumps(header))
    tracker = agent._recognition.tracker
    of_tracker = rest["recognition"].pop("tracker")
    hypotheses = [
        (
            (h.weight, h.here, h.size, h.links, h.kinds, h.undo, h.periods, [*h.counts.yes], [*h.counts.no]),
            {number: h.places[number] for number in sorted(h.places)},
            {key: h.at[key] for key in sorted(h.at)},
            {key: sorted(h.shown[key]) for key in sorted(h.shown)},
        )
        for h in tracker.hypotheses
    ]
    own = {name: values.tobytes() for name, values in arrays.items() if not name.startswith("tracker.")}
    tried = {key: tracker._tried[key] for key in sorted(tracker._tried)}
    return rest, own, hypotheses, tried, tracker.time, of_tracker["numbers"], of_tracker["evidence"]
