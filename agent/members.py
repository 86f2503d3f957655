"""The arrays of an npz file of anybody: read within limits, whole, and only those that are asked for."""

import os
import re
import struct
import zipfile
from collections.abc import Iterator, Mapping
from math import prod
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

LARGEST = 4 * 2**30  # bytes of all arrays together
RATIO = 100  # how many times larger than the file they may be, besides the first `FREE` bytes

FREE = 2**20
DIRECTORY = 32 * 2**20  # bytes of the list of members

_MAGIC = re.compile(rb"\x93NUMPY(?:\x01\x00(..)|[\x02\x03]\x00(....))", re.S)
_HEADER = re.compile(
    rb"\{'descr': '([<>|])([biuf])([1248])', 'fortran_order': (True|False), 'shape': \(([0-9, ]{0,200})\), \} *\n"
)
_END = struct.Struct("<4s4H2LH")
_MOST_HEADER = 2**12


class Members(Mapping[str, NDArray[Any]]):
    """Arrays by name; each is read to its end, so that its checksum is looked at, and holds no NaN.

    Args:
        file: the npz file, open as long as arrays are asked for.

    Attributes:
        unread: names of those that nobody has asked for yet.

    Raises:
        ValueError, zipfile.BadZipFile: it is no such file, has a member twice or of another kind, or is too large.
    """

    def __init__(self, file: BinaryIO) -> None:
        size = os.fstat(file.fileno()).st_size
        _check_directory(file, size)
        self._zip = zipfile.ZipFile(file)
        members = self._zip.infolist()
        self._members = {member.filename.removesuffix(".npy"): member for member in members}
        _check(members, size)
        if len(self._members) < len(members):
            raise ValueError("two members have one name")
        self._read: dict[str, NDArray[Any]] = {}

    @property
    def unread(self) -> list[str]:
        """In the order of the file."""
        return [name for name in self._members if name not in self._read]

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self._read:
            member = self._members[name]
            with self._zip.open(member) as file:
                content = file.read()
            if len(content) != member.file_size:
                raise ValueError(f"member {name} ends too soon")
            self._read[name] = _array(name, content)
        return self._read[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._members)

    def __len__(self) -> int:
        return len(self._members)


def _check_directory(file: BinaryIO, size: int) -> None:
    """Refuse a list of members that would be large itself; it is read at once."""
    file.seek(max(size - 2**16 - _END.size, 0))
    tail = file.read()
    at = tail.rfind(b"PK\x05\x06")
    if at >= 0 and len(tail) - at >= _END.size:
        _, _, _, _, entries, length, _, _ = _END.unpack_from(tail, at)
        longer = tail[max(at - 20, 0) : at].startswith(b"PK\x06\x07") and size < 2**31
        if length > DIRECTORY or entries == 0xFFFF or longer:
            raise ValueError(f"the list of its members has {length} bytes")
    file.seek(0)


def _check(members: list[zipfile.ZipInfo], size: int) -> None:
    for member in members:
        if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) or member.flag_bits & 1:
            raise ValueError(f"member {member.filename[:80]!r} is packed in another way than save does")
        if not member.filename.endswith(".npy"):
            raise ValueError(f"member {member.filename[:80]!r} is no array")
    stored = sum(member.file_size for member in members if member.compress_type == zipfile.ZIP_STORED)
    total = sum(member.file_size for member in members)
    if stored > size or total > min(LARGEST, RATIO * size + FREE):
        raise ValueError(f"its arrays would have {total:,} bytes, which no file of {size:,} bytes has")


def _array(name: str, content: bytes) -> NDArray[Any]:
    """The array of an npy file, of a number or truth values, and nothing behind it."""
    start = _MAGIC.match(content)
    length = 0 if start is None else int.from_bytes(start[1] or start[2], "little")
    begin = 0 if start is None else start.end()
    head = _HEADER.fullmatch(content, begin, begin + length) if 0 < length <= _MOST_HEADER else None
    if head is None:
        raise ValueError(f"member {name} is no array of numbers")
    order, kind, item, fortran, sizes = (part.decode() for part in head.groups())
    shape = tuple(int(part) for part in sizes.split(",") if part.strip())
    expected = len(content) - head.end()
    if len(shape) > 8 or prod(shape) * int(item) != expected:
        raise ValueError(f"member {name} has shape {shape} and {expected} bytes")
    dtype = np.dtype(f"{order}{kind}{item}")
    array = np.frombuffer(bytearray(memoryview(content)[head.end() :]), dtype=dtype)
    if kind == "b" and array.view(np.uint8).max(initial=0) > 1:
        raise ValueError(f"member {name} has truth values that are none")
    if kind == "f" and np.isnan(array).any():
        raise ValueError(f"member {name} has numbers that are none")
    wide = np.dtype(np.float64) if kind == "f" else dtype.newbyteorder("=")  # shorter ones overflow in comparisons
    array = array.astype(wide, copy=False)
    return array.reshape(shape, order="F" if fortran == "True" else "C")
