"""Files that are written whole or not at all, and checked before the work is done."""

from __future__ import annotations

import json
import os
import re
import warnings
from collections.abc import Iterable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..model import CogmapError, check_folder, check_writable, write_whole
from ..model import unused as unused

if TYPE_CHECKING:
    from matplotlib.figure import Figure, SubFigure

PICTURES = (".png", ".pdf", ".svg")
_NO_XML = re.compile(rb"[\x00-\x08\x0b\x0c\x0e-\x1f]")
_NO_NAME = re.compile(r"[^\w.+-]|^\.+")


def check_outputs(
    paths: Iterable[Path | None], *, inputs: Iterable[Path | str] = (), picture: Path | None = None
) -> None:
    """Refuse output files that could not be written, before anything is computed.

    Args:
        paths: the outputs, all different.
        inputs: what is read, none of which may be written.
        picture: which of them is a picture, with a suffix of `PICTURES`.

    Raises:
        CogmapError: one of them is read, is named twice, is no file, or has a suffix of no picture.
    """
    read, seen = [Path(path) for path in inputs], set[Path]()
    for path in paths:
        if path is None:
            continue
        target = Path(os.path.realpath(path))
        if target in seen:
            raise CogmapError(f"{path} is given for two outputs; give each a file of its own")
        if any(_is_same(path, other) for other in read):
            raise CogmapError(f"{path} is the file that is read; write to another")
        seen.add(target)
        _check(path, target)
    if picture is not None and picture.suffix.lower() not in PICTURES:
        raise CogmapError(f"{picture} has no picture suffix; use one of {', '.join(PICTURES)}")


def file_named(name: str, suffix: str) -> Path:
    """A file name in this folder for a world of that name, whatever characters are in it."""
    return Path((_NO_NAME.sub("_", name)[:80] or "_") + suffix)


def write_json(path: Path, value: Any) -> None:
    """Write `value` as JSON. NaN and infinity are refused; null stands for none."""
    write_whole(path, (json.dumps(value, indent=2, allow_nan=False) + "\n").encode())


def write_picture(path: Path, figure: Figure, *, new: bool = False) -> Path:
    """Write the figure in the format of the suffix, and return its path (`new`: see `write_through`)."""
    return write_whole(path, picture_of(figure, path.suffix.lower().removeprefix(".")), new=new)


def picture_of(figure: Figure | SubFigure, kind: str) -> bytes:
    """The figure as the content of a file of that kind."""
    buffer = BytesIO()
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph")  # signs that the font lacks are drawn as boxes
        figure.figure.savefig(buffer, format=kind)
    content = buffer.getvalue()
    return _NO_XML.sub(b"?", content) if kind == "svg" else content  # its comments have texts as they are


def _is_same(one: Path, other: Path) -> bool:
    """Whether they are one file, by links of either kind too."""
    try:
        return os.path.samefile(one, other)
    except (OSError, ValueError):  # one is not there
        return False


def _check(path: Path, target: Path) -> None:
    try:
        check_writable(path)
        check_folder(path)
    except (OSError, ValueError) as error:
        if isinstance(error, CogmapError):
            raise
        why = getattr(error, "strerror", None) or error
        raise CogmapError(f"cannot write {path}: folder {target.parent}: {why}; choose another file") from error
