"""Every package of the library is declared, so that a wheel has it; `cogmap` itself says what most people need."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest

import cogmap
from cogmap import agent, worlds

ROOT = Path(__file__).resolve().parents[1]
HOUSE = ("worlds", "model", "inference", "planning", "body", "agent", "views", "baselines", "behaviour", "experiments")


def test_every_package_is_declared() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["setuptools"]
    folders = {file.parent.relative_to(ROOT).as_posix() for top in HOUSE for file in (ROOT / top).rglob("__init__.py")}
    mapped = {name: folder for name, folder in declared["package-dir"].items() if folder.split("/")[0] in HOUSE}
    assert set(mapped.values()) == folders
    assert mapped == {"cogmap." + folder.replace("/", "."): folder for folder in folders}
    assert set(mapped) <= set(declared["packages"])


def test_the_package_itself_has_what_most_people_need() -> None:
    assert cogmap.__version__ == version("cogmap")
    assert (cogmap.Agent, cogmap.Settings) == (agent.Agent, agent.Settings)
    assert cogmap.load_world is worlds.load_world
    assert set(cogmap.__all__) <= set(dir(cogmap))
    with pytest.raises(AttributeError, match="'Agnet'"):
        cogmap.Agnet  # noqa: B018


def test_the_package_itself_is_light() -> None:
    code = "import sys, cogmap; print(*(name for name in ('numpy', 'gymnasium', 'gtsam') if name in sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
