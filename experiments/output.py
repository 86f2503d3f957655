"""Files that are written whole or not at all, and checked before the work is done."""

from __future__ import annotations

import json
import os
import tempfile
import warnings
from collections.abc import Iterable
from io import BytesIO
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..model import CogmapError, write_whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure, SubFigure

PICTURES = (".png", ".pdf", ".svg")


def check_outputs(
    paths: Iterable[Path | None], *, inputs: Iterable[Path | str] = (), picture: Path | None = None
) -> None:
    """Refuse, before anything is computed, what could not be written afterwards.

    Args:
        paths: the outputs, all different.
        inputs: what is read, none of which may be written.
        picture: which of them is a picture, with a suffix of `PICTURES`.
    """
    read, seen = {os.path.realpath(path) for path in inputs}, set[Path]()
    for path in paths:
        if path is None:
            continue
        target = Path(os.path.realpath(path))
        if target in seen:
            raise CogmapError(f"{path} is given for two outputs; give each a file of its own")
        if str(target) in read and target.exists():
            raise CogmapError(f"{path} is the file that is read; write to another")
        seen.add(target)
        _check(path, target)
    if picture is not None and picture.suffix.lower() not in PICTURES:
        raise CogmapError(f"{picture} has no picture suffix; use one of {', '.join(PICTURES)}")


def unused(path: Path) -> Path:
    """A file that was not named, or where it is there already the first of NAME-2, NAME-3, … that is not."""
    names = (path.with_stem(f"{path.stem}-{number}") for number in count(2))
    return path if not path.exists() else next(name for name in names if not name.exists())


def write_json(path: Path, value: Any) -> None:
    """Write `value` as JSON; NaN and infinity are refused, null stands for "none"."""
    write_whole(path, (json.dumps(value, indent=2, allow_nan=False) + "\n").encode())


def write_picture(path: Path, figure: Figure) -> None:
    """Write the figure in the format of the suffix."""
    write_whole(path, picture_of(figure, path.suffix.lower().removeprefix(".")))


def picture_of(figure: Figure | SubFigure, kind: str) -> bytes:
    """The figure as the content of a file of that kind."""
    buffer = BytesIO()
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph")  # signs that the font lacks are drawn as boxes
        figure.figure.savefig(buffer, format=kind)
    return buffer.getvalue()


def _check(path: Path, target: Path) -> None:
    try:
        if target.exists() and not target.is_file():
            raise CogmapError(f"cannot write {path}: it is a folder or a device; give a file")
        if target.exists() and not os.access(target, os.W_OK):
            raise CogmapError(f"cannot write {path}: it is read-only; choose another file")
        tempfile.NamedTemporaryFile(dir=target.parent, prefix=f".{target.name[:80]}.").close()
    except OSError as error:
        where = f"cannot write {path}: folder {target.parent}: {error.strerror or error}"
        raise CogmapError(f"{where}; choose another file") from error
