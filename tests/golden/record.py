"""Walks all golden walks and records them: python tests/golden/record.py [--overwrite].

The recordings say what agents did before the library was rebuilt. Record anew only what is meant to change, and say
why in the commit.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

if __name__ == "__main__":
    sys.path[0] = str(Path(__file__).resolve().parents[1])  # `golden` is a package of the tests

from golden.recordings import FILE, write_recordings
from golden.walking import walked
from golden.walks import WALKS


def main(arguments: Sequence[str] | None = None, *, path: Path = FILE) -> None:
    """Record every walk, unless that would overwrite a recording unasked."""
    parser = argparse.ArgumentParser(description="Record the golden walks.")
    parser.add_argument("--overwrite", action="store_true", help="replace the recordings that are there")
    overwrite = parser.parse_args(arguments).overwrite
    if path.exists() and not overwrite:
        parser.exit(1, f"{path} is there already; --overwrite replaces it\n")
    write_recordings({name: list(walked(walk)) for name, walk in WALKS.items()}, path)
    print(f"{len(WALKS)} walks recorded: {path}, {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
