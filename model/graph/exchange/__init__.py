"""Factor graphs in the files of other programs."""

from __future__ import annotations

from .bif import read_bif, write_bif

__all__ = ["read_bif", "write_bif"]
