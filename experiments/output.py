"""Files that are written whole or not at all, and checked before the work is done."""

from __future__ import annotations

import json
import os
import tempfile
import warnings
from collections.abc import Iterable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..model.errors import CogmapError
from ..model.files import write_whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURES = (".png", ".pdf", ".svg")


def check_outputs(paths: Iterable[Path | None]) -> None:
    """Refuse, before anything is computed, what could not be written afterwards.

    Raises:
        CogmapError: a folder is missing or not writable, a path is no regular file, or two are the same.
    """
    seen: set[Path] = set()
    for path in paths:
        if path is None:
            continue
        target = Path(os.path.realpath(path))
        if target in seen:
            raise CogmapError(f"{path} is given for two outputs; give each a file of its own")
        seen.add(target)
        _check(path, target)


def check_picture(path: Path) -> None:
    """Refuse a picture format that cannot be drawn.

    Raises:
        CogmapError: the suffix is not one of `PICTURES`.
    """
    if path.suffix.lower() not in PICTURES:
        raise CogmapError(f"{path} has no picture suffix; use one of {', '.join(PICTURES)}")


def write_json(path: Path, value: Any) -> None:
    """Write `value` as JSON; NaN and infinity are refused, null stands for "none".

    Raises:
        CogmapError: the file cannot be written.
    """
    write_whole(path, (json.dumps(value, indent=2, allow_nan=False) + "\n").encode())


def write_picture(path: Path, figure: Figure) -> None:
    """Write the figure in the format of the suffix.

    Raises:
        CogmapError: the file cannot be written.
    """
    buffer = BytesIO()
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph")  # signs that the font lacks are drawn as boxes
        figure.savefig(buffer, format=path.suffix.lower().removeprefix("."))
    write_whole(path, buffer.getvalue())


def _check(path: Path, target: Path) -> None:
    try:
        if target.exists() and not target.is_file():
            raise CogmapError(f"cannot write {path}: it is a folder or a device; give a file")
        if target.exists() and not os.access(target, os.W_OK):
            raise CogmapError(f"cannot write {path}: it is read-only; choose another file")
        with tempfile.NamedTemporaryFile(dir=target.parent, prefix=f".{target.name[:80]}."):
            pass
    except OSError as error:
        reason = error.strerror or error
        raise CogmapError(f"cannot write {path}: folder {target.parent}: {reason}; choose another file") from error
