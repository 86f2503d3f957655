"""What a study was run with and on: versions and machine."""

from __future__ import annotations

import os
import platform
import subprocess
from importlib.metadata import version
from pathlib import Path
from typing import Any

PACKAGES = ("cogmap", "numpy", "scipy", "gtsam")


def versions() -> dict[str, str]:
    """Versions of Python, of the packages that compute, and of the platform."""
    packages = {name: version(name) for name in PACKAGES}
    return {**packages, "python": platform.python_version(), "platform": platform.platform()}


def machine() -> dict[str, Any]:
    """Processor, cores, operating system and the threads that numpy was allowed."""
    return {
        "processor": processor(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.release()}",
        "OMP_NUM_THREADS": os.environ.get("OMP_NUM_THREADS"),
    }


def processor(cpuinfo: Path = Path("/proc/cpuinfo")) -> str:
    """The model of the processor, as far as the system tells."""
    try:
        lines = cpuinfo.read_text(errors="replace").splitlines()
        return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return _asked() or platform.processor() or platform.machine() or "unknown"


def _asked() -> str:
    """What macOS answers; nothing elsewhere."""
    if platform.system() != "Darwin":
        return ""
    try:
        asked = ("sysctl", "-n", "machdep.cpu.brand_string")
        return subprocess.run(asked, capture_output=True, text=True, check=False, timeout=5.0).stdout.strip()
    except (OSError, subprocess.TimeoutExpired):
        return ""
