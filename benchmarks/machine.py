"""What a figure was measured on, and how it is written down."""

import argparse
import json
import os
import platform
from collections.abc import Callable, Collection, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

PACKAGES = ("cogmap", "numpy", "scipy", "gtsam")


def machine() -> dict[str, Any]:
    """Processor, cores, Python and the versions that matter, as plain JSON values."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "load": [round(load, 2) for load in os.getloadavg()],
        "system": platform.platform(),
        "python": platform.python_version(),
        **{name: version(name) for name in PACKAGES},
    }


def arguments(about: str | None, **some: Collection[str]) -> argparse.ArgumentParser:
    """What every benchmark can be told: which of `some` to do (all unless given), and `--json`."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    for what, names in some.items():
        about = f"some of {', '.join(map(repr, names))}; all unless given"
        parser.add_argument(what, nargs="*", type=one_of(names), default=list(names), help=about)
    parser.add_argument("--json", type=json_path, metavar="FILE", help="of what was found")
    return parser


def one_of(names: Collection[str]) -> Callable[[str], str]:
    """One of these names, for argparse."""

    def named(text: str) -> str:
        if text not in names:
            raise argparse.ArgumentTypeError(f"there is no {text!r}; there are {', '.join(map(repr, names))}")
        return text

    return named


def positive(text: str) -> int:
    """A whole number of one or more, for argparse."""
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{number} is too few; give 1 or more")
    return number


def json_path(text: str) -> Path:
    """The file that `--json` names; refused before anything is measured where it cannot be written."""
    path = Path(text)
    if path.is_dir() or not os.access(path.parent, os.W_OK):
        raise argparse.ArgumentTypeError(f"{text} cannot be written; name a file in a folder that is there")
    return path


def write_json(path: Path | None, result: Mapping[str, Any]) -> None:
    """Write the result, with the machine it was measured on, where a file is given."""
    if path is not None:
        path.write_text(json.dumps({"machine": machine(), **result}, indent=2) + "\n")


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "unknown")
