"""The command as a user types it."""

from __future__ import annotations

from typing import Any

from cogmap.experiments.cli import app
from typer.testing import CliRunner


def cogmap(*args: object) -> Any:
    """The result of a command that ended without a traceback."""
    result: Any = CliRunner().invoke(app, [str(arg) for arg in args])
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result
