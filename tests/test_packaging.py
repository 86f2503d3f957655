"""Every package of the library is declared, so that a wheel has it."""

from __future__ import annotations

import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HOUSE = ("worlds", "model", "inference", "planning", "agent", "views", "baselines", "experiments")


def test_every_package_is_declared() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["setuptools"]
    folders = {file.parent.relative_to(ROOT).as_posix() for top in HOUSE for file in (ROOT / top).rglob("__init__.py")}
    mapped = {name: folder for name, folder in declared["package-dir"].items() if folder.split("/")[0] in HOUSE}
    assert set(mapped.values()) == folders
    assert mapped == {"cogmap." + folder.replace("/", "."): folder for folder in folders}
    assert set(mapped) <= set(declared["packages"])
