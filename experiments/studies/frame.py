"""What every study has in common: its name, how it is run, and what it leaves in a folder.

The study `x` is the module `x` beside this one with `x_study` and `x_lines`, and the module `x_figures` with
`x_figures`; the name `SETTINGS` in `x`, where there is one, holds the settings that the protocol asks for.
"""

from __future__ import annotations

import os
import platform
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from ...agent import Settings
from ...model.errors import CogmapError
from ..output import check_outputs, write_json, write_picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SUFFIXES = (".png", ".svg")


class Result(Protocol):
    """What a study gives back."""

    def to_dict(self) -> dict[str, Any]:
        """The result as plain JSON values."""
        ...


@dataclass(frozen=True, slots=True)
class Study:
    """A study that can be asked for by name.

    Attributes:
        name: of the study, its module and its functions.
        agents: how many take part unless told otherwise.
    """

    name: str
    agents: int

    def run(
        self,
        *,
        agents: int,
        seed: int = 0,
        look_ahead: int | None = None,
        jobs: int = 1,
        on_done: Callable[[], None] | None = None,
    ) -> Result:
        """Let `agents` agents take part, with the settings of the protocol but for `look_ahead`, if that is given.

        Raises:
            CogmapError: a number is out of range, or a process was killed.
        """
        settings = None if look_ahead is None else self.settings(look_ahead)
        study = getattr(self._module(), f"{self.name}_study")
        return study(agents=agents, seed=seed, settings=settings, jobs=jobs, on_done=on_done)

    def settings(self, look_ahead: int | None = None) -> Settings:
        """The settings of the protocol, with another look-ahead if one is given.

        Raises:
            CogmapError: `look_ahead` is below 1.
        """
        own: Settings = getattr(self._module(), "SETTINGS", None) or Settings()
        return own if look_ahead is None else replace(own, look_ahead=look_ahead)

    def lines(self, result: Result) -> list[str]:
        """What the terminal shows of the result."""
        return getattr(self._module(), f"{self.name}_lines")(result)

    def figures(self, result: Result) -> dict[str, Figure]:
        """The figures, by the stem of their file."""
        module = import_module(f".{self.name}_figures", __package__)
        return getattr(module, f"{self.name}_figures")(result)

    def _module(self) -> Any:
        return import_module(f".{self.name}", __package__)


STUDIES = {
    study.name: study
    for study in (
        Study("localisation", 20),
        Study("goals", 20),
        Study("donut", 20),
        Study("tolman", 10),
        Study("martinet", 40),
        Study("insight", 40),
    )
}


def study_named(name: str) -> Study:
    """The study of that name.

    Raises:
        CogmapError: there is none.
    """
    if name not in STUDIES:
        raise CogmapError(f"no study is called {name!r}; choose one of {', '.join(STUDIES)}")
    return STUDIES[name]


def check_folder(folder: Path, study: str) -> None:
    """Refuse, before anything is computed, a folder in which `save_study` could not write.

    Raises:
        CogmapError: it is a file, or not writable, or cannot be made.
    """
    try:
        if folder.is_dir():
            check_outputs([folder / f"{study}.json"])
            return
        target = above = Path(os.path.realpath(folder))
        while not (above.exists() or above == above.parent):
            above = above.parent
        if not above.is_dir():
            raise CogmapError(f"cannot make folder {folder}: {above} is a file; choose another folder")
        with tempfile.TemporaryDirectory(dir=above, prefix=".cogmap-") as there:
            (Path(there) / target.relative_to(above)).mkdir(parents=True)  # a name may be too long
    except OSError as error:
        raise CogmapError(f"cannot make folder {folder}: {error.strerror or error}; choose another folder") from error


def study_report(study: Study, result: Result, *, agents: int, seed: int, settings: Settings) -> dict[str, Any]:
    """What the study found, and all that it takes to run it again, as plain JSON values."""
    versions = {"cogmap": version("cogmap"), "python": platform.python_version(), "numpy": version("numpy")}
    head = {
        "study": study.name,
        "agents": agents,
        "seed": seed,
        "settings": settings.to_dict(),
        "versions": versions,
    }
    return {**head, **result.to_dict()}


def save_study(folder: Path, study: Study, result: Result, report: dict[str, Any]) -> list[Path]:
    """Write `report` as JSON, and every figure as PNG and SVG; answers with the files, the JSON first.

    Raises:
        CogmapError: a file cannot be written; those before it are whole.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CogmapError(f"cannot make folder {folder}: {error.strerror or error}; choose another folder") from error
    written = [folder / f"{study.name}.json"]
    write_json(written[0], report)
    for stem, figure in study.figures(result).items():
        for suffix in SUFFIXES:
            written.append(folder / f"{stem}{suffix}")
            write_picture(written[-1], figure)
    return written
