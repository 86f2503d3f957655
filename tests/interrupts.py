"""Interrupts at a line of choice."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

ROOT = str(Path(__file__).parents[1])


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
        name = frame.f_code.co_filename
        return in_function if name.startswith(ROOT) and "/tests/" not in name and "/.venv/" not in name else None

    sys.settrace(everywhere)
    try:
        work()
    finally:
        sys.settrace(before)
    return count


def lines_of(work: Callable[[], object]) -> int:
    """How many lines the work has."""
    return interrupted(work, -1)
