"""The command as a user types it."""

from __future__ import annotations

import signal
from typing import Any

from cogmap.experiments.cli import app
from typer.testing import CliRunner


def cogmap(*args: object) -> Any:
    """The result of a command that ended without a traceback."""
    result: Any = CliRunner().invoke(app, [str(arg) for arg in args])
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


def heeding_ctrl_c() -> None:
    """In a process just started: heed Ctrl-C even where this one, run in the background by a shell, does not."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
