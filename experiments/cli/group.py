"""How the commands fail: one line on stderr and an exit code."""

import sys
from typing import Any, NoReturn

import typer
from typer.core import TyperGroup

from ..text import printable

BAD_INPUT, INTERRUPTED = 2, 130

# typer before 0.20 raises the errors of click, later versions bring their own
_UsageError: type[Exception] = next(kind for kind in typer.BadParameter.__mro__ if kind.__name__ == "ClickException")


class CogmapGroup(TyperGroup):
    """Commands that answer bad input with one line and exit code 2, and Ctrl-C with exit code 130."""

    def main(self, *args: Any, standalone_mode: bool = True, **extra: Any) -> Any:
        """Run a command and exit."""
        if not standalone_mode:
            return super().main(*args, standalone_mode=False, **extra)
        for stream in (sys.stdout, sys.stderr):
            if hasattr(stream, "reconfigure"):
                stream.reconfigure(errors="replace")  # type: ignore[union-attr]
        try:
            code = super().main(*args, standalone_mode=False, **extra)
        except (KeyboardInterrupt, typer.Abort):
            code = INTERRUPTED
        except _UsageError as error:
            context: Any = getattr(error, "ctx", None)
            command, said = context.command_path if context else "cogmap", error.format_message()  # type: ignore[attr-defined]
            fail(f"{said.rstrip('.')}; see {command} --help")
        except ValueError as error:
            if not _ours(error):
                raise
            fail(str(error))
        if code == INTERRUPTED:
            fail("interrupted; nothing more was written", code=INTERRUPTED)
        sys.exit(code if isinstance(code, int) else 0)


def fail(message: str, *, code: int = BAD_INPUT) -> NoReturn:
    """Say why in one line on stderr, and exit."""
    print(f"cogmap: {printable(' '.join(message.split()))}", file=sys.stderr)
    sys.exit(code)


def _ours(error: ValueError) -> bool:
    from ...model import CogmapError
    from ...worlds import WorldError

    return isinstance(error, CogmapError | WorldError)
