"""Files of others, read within limits: regular ones, no larger than said, JSON that is no more than JSON."""

import gzip
import json
import math
import os
import re
import stat
from collections.abc import Iterable
from io import BytesIO
from os import PathLike
from typing import Any, BinaryIO, cast

from .errors import CogmapError

LARGEST = 256 * 2**20  # bytes of the largest file that is read whole, packed or not

CHUNK = 2**20

MOST_VALUES = 6_000_000  # values of JSON in one file: each takes up to 80 bytes where it is read

_SURROGATE = re.compile(r"[\ud800-\udfff]")


def open_regular(path: str | PathLike[str]) -> BinaryIO:
    """Open a regular file for reading. Pipes and devices are refused.

    Raises:
        CogmapError: it is no regular file.
        OSError: it cannot be opened.
    """
    try:
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0))
    except ValueError as error:  # a null in the name
        raise OSError(22, str(error)) from error
    if stat.S_ISREG(os.fstat(handle).st_mode):
        return os.fdopen(handle, "rb")
    os.close(handle)
    raise CogmapError(f"{path} is a folder or a device, no regular file; give a file")


def read_file(path: str | PathLike[str], *, most: int = LARGEST) -> bytes:
    """The content of a file.

    Raises:
        CogmapError: it is no regular file, or has more than `most` bytes.
        OSError: it cannot be read.
    """
    with open_regular(path) as file:
        check_size(path, os.fstat(file.fileno()).st_size, most)
        content = file.read(most + 1)  # a file may grow
    check_size(path, len(content), most)
    return content


def unpack_gzip(path: str | PathLike[str], content: bytes, *, most: int = LARGEST) -> bytes:
    """Unpack a JSON text. Its size is checked before any of it is kept.

    Raises:
        CogmapError: it would be larger than `most` bytes.
        ValueError: it has more than `MOST_VALUES` values.
        OSError, EOFError, zlib.error: it was not packed with gzip, or its end is missing.
    """
    size = values = 0
    with gzip.GzipFile(fileobj=BytesIO(content)) as file:
        while part := file.read(CHUNK):
            size += len(part)
            values += count_values(part)
            check_size(path, size, most)
            check_values(values)
    return gzip.decompress(content)


def check_size(path: str | PathLike[str], size: int, most: int) -> None:
    """Refuse input that is too large. Raises CogmapError."""
    if size > most:
        raise CogmapError(f"{path} has {size:,} bytes; such a file has {most:,} at most")


def parse_json(content: bytes | str) -> Any:
    """The value that a JSON text stands for, if it is one that can be written again.

    Raises:
        ValueError: it is no JSON, is nested too deeply, has more than `MOST_VALUES` values, a number that
            is not finite, or half of a character.
    """
    content = content.encode(errors="surrogatepass") if isinstance(content, str) else content
    check_values(count_values(content))
    try:
        found = json.loads(content, parse_constant=_refused, parse_float=_finite)
    except RecursionError as error:
        raise ValueError("JSON is nested too deeply") from error
    if b"\\ud" in content or b"\\uD" in content:
        _check_text([found])
    return found


def count_values(content: bytes) -> int:
    """Roughly how many values a JSON text has; never fewer, but for one."""
    return sum(map(content.count, (b",", b"[", b"{", b":")))


def check_values(count: int) -> None:
    """Refuse more values than fit into memory. Raises ValueError."""
    if count > MOST_VALUES:
        raise ValueError(f"JSON of {count:,} values or so; {MOST_VALUES:,} are read at most")


def _refused(constant: str) -> float:
    raise ValueError(f"JSON has no number {constant}")


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"the number {text[:40]} is too large")
    return value


def _check_text(values: Iterable[Any]) -> None:
    """Refuse half a character anywhere: it can be neither written nor shown."""
    left = list(values)
    while left:
        value = left.pop()
        if isinstance(value, dict):
            left.extend(cast(dict[str, Any], value))
            left.extend(cast(dict[str, Any], value).values())
        elif isinstance(value, list):
            left.extend(cast(list[Any], value))
        elif isinstance(value, str) and _SURROGATE.search(value):
            raise ValueError("a text has half of a character (a lone surrogate)")
