"""Runs every check of this repository, stops at none, and exits with 1 if any failed.

Format, lint, types, import rules, tests, the documentation site, and the Python examples of README.md and docs/. Needs
the test extra: pip install -e '.[test]'. Arguments go to pytest: check.py --study

From Python 3.12 on, which counts lines at little cost, the tests must cover most lines too; before it that would nearly
double their time.

check.py --floors runs the tests alone, in an environment of its own with the oldest version of every package that
pyproject.toml allows.

Where the variable CI is set, the programs that some tests need, a browser and Graphviz, are installed first; elsewhere
those tests are skipped if they are missing.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent
LEAST_COVERAGE = 95  # per cent of the lines of the folders in [tool.coverage.run]
JOBS = 2
PROGRAMS = {"chromium": "chromium", "dot": "graphviz"}  # and the Debian packages that have them

_LINT_IMPORTS = "from importlinter.cli import lint_imports_command; lint_imports_command(['--no-cache'])"
_COVERAGE = ("--cov", f"--cov-fail-under={LEAST_COVERAGE}", "--cov-report=term:skip-covered")
_SHARED = ("--dist", "loadfile", "--no-loadscope-reorder")  # what the tests of a file share is made once
_COUNTED = _COVERAGE if sys.version_info >= (3, 12) else ()
CHECKS: dict[str, Sequence[str]] = {
    "format": ("-m", "ruff", "format", "--check", "."),
    "lint": ("-m", "ruff", "check", "."),
    "types": ("-m", "pyright", "--pythonpath", sys.executable),
    "import rules": ("-c", _LINT_IMPORTS),
    "tests": ("-m", "pytest", "-n", str(JOBS), *_SHARED, *_COUNTED),
}


def python_examples() -> dict[str, str]:
    """The ```python blocks of README.md and docs/, those of one file joined, by the file's name."""
    pages = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    blocks = {page: re.findall(r"^```python\n(.*?)^```", page.read_text("utf-8"), re.M | re.S) for page in pages}
    return {str(page.relative_to(ROOT)): "\n".join(found) for page, found in blocks.items() if found}


def install_programs() -> None:
    """Install with apt-get what is missing of `PROGRAMS`; the tests say what they lack where that fails."""
    missing = [package for program, package in PROGRAMS.items() if shutil.which(program) is None]
    if missing and shutil.which("apt-get"):
        quiet = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
        for words in (("update",), ("install", "--yes", "--no-install-recommends", *missing)):
            subprocess.run(["apt-get", "--quiet", *words], env=quiet, stdin=subprocess.DEVNULL)


def laid_out(folder: Path) -> dict[str, str]:
    """An environment in which the mapped folders are one package on disk, as import-linter reads it."""
    mapped = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["setuptools"]["package-dir"]
    package = folder / "cogmap"
    package.mkdir()
    for name, source in mapped.items():
        if name.count(".") == 1:
            (package / name.partition(".")[2]).symlink_to(ROOT / source)
    for file in (ROOT / mapped["cogmap"]).iterdir():
        (package / file.name).symlink_to(file)
    return {**os.environ, "PYTHONPATH": str(folder)}


def run(
    name: str,
    arguments: Sequence[str],
    *,
    folder: Path = ROOT,
    env: Mapping[str, str] | None = None,
    python: str = sys.executable,
) -> bool:
    """Run Python with `arguments` in `folder`, say how it went, and whether it went well."""
    print(f"\n== {name}", flush=True)
    begin = time.perf_counter()
    code = subprocess.run([python, *arguments], cwd=folder, env=env, stdin=subprocess.DEVNULL).returncode
    seconds = time.perf_counter() - begin
    print(f"== {name}: {'ok' if code == 0 else f'FAILED (exit code {code})'}, {seconds:.1f} s", flush=True)
    return code == 0


def floors(project: Mapping[str, Any]) -> list[str]:
    """The oldest version of each package that a project names, as pip's constraints: `numpy==2.0` for `numpy>=2.0`."""
    named = [*project["dependencies"], *chain.from_iterable(project["optional-dependencies"].values())]
    found = (re.fullmatch(r"([\w.-]+)(?:\[[\w,]+\])?>=([\w.]+)", requirement) for requirement in named)
    return sorted({f"{one[1]}=={one[2]}" for one in found if one})


def check_floors(for_pytest: Sequence[str]) -> int:
    """The tests with the oldest versions of everything; 1 if they fail, or cannot be installed together."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "floors.txt").write_text("\n".join(floors(project)) + "\n")
        python = str(folder / "venv" / ("Scripts" if os.name == "nt" else "bin") / "python")
        made = run("environment", ("-m", "venv", str(folder / "venv")))
        words = ("-m", "pip", "install", "--quiet", "--constraint", str(folder / "floors.txt"), f"{ROOT}[test]")
        fine = made and run("oldest versions", words, python=python)
        return 0 if fine and run("tests", ("-m", "pytest", *for_pytest), python=python) else 1


def main(for_pytest: Sequence[str] = ()) -> int:
    """Every check, then what failed."""
    if "--floors" in for_pytest:
        return check_floors([word for word in for_pytest if word != "--floors"])
    os.environ["PYRIGHT_PYTHON_IGNORE_WARNINGS"] = "1"  # that there is a newer one: ours is pinned
    os.environ["NO_MKDOCS_2_WARNING"] = "1"
    os.environ.setdefault("COVERAGE_CORE", "sysmon")
    if os.environ.get("CI"):
        install_programs()
    results: dict[str, bool] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, arguments in CHECKS.items():
            env = laid_out(Path(folder)) if name == "import rules" else None
            results[name] = run(name, (*arguments, *for_pytest) if name == "tests" else arguments, env=env)
        results["docs"] = run("docs", ("-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", f"{folder}/site"))
        for page, code in python_examples().items():
            name = f"example of {page}"
            results[name] = run(name, ("-c", code), folder=Path(folder))
    failed = [name for name, fine in results.items() if not fine]
    print(
        f"\n{len(results) - len(failed)} of {len(results)} checks ok" + "".join(f"; FAILED: {name}" for name in failed)
    )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
