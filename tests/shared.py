"""Files that lie beside the project, where they are there: cases and worlds that the studies are measured on."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

FOLDER = Path(os.environ.get("COGMAP_SHARED") or Path(__file__).parents[2] / "shared")


def shared(name: str) -> Path:
    """The path of such a file; skips the test where it is missing."""
    path = FOLDER / name
    if not path.exists():
        pytest.skip(f"{path} is not here; set COGMAP_SHARED to the folder that has it")
    return path
