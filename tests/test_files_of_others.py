"""Damaged and hostile files: refused in one line, or what is made of them is sound."""

from __future__ import annotations

import gzip
import io
import json
import os
import struct
import zipfile
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.model import CogmapError, load_graph, open_regular, parse_json, read_file
from cogmap.views import Recording
from cogmap.worlds import WorldError, load_world
from fuzzing import KINDS, damaged, outcome
from walks import walked

SMALL = dict.fromkeys(KINDS, 60) | {"agent": 14, "recording": 60, "gzip": 30, "agent600": 0, "agent10000": 0}
SMALL |= {"doubting": 0, "lost": 0, "told": 12, "plane": 16, "no poses": 0}  # benchmarks/damage.py tries them all


@pytest.mark.parametrize("kind", [kind for kind, count in SMALL.items() if count])
def test_damage_is_refused_or_harmless(kind: str, tmp_path: Path) -> None:
    found = Counter((what, outcome(path, attempt)) for what, path, attempt in damaged(kind, tmp_path, SMALL[kind]))
    assert sum(found.values()) == SMALL[kind]
    assert sum(count for (_, result), count in found.items() if result == "refused") > SMALL[kind] // 8


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("saved") / "map.npz"
    walked(load_world("3x3_alias"), 12, displace_every=11, window=2).save(path)
    return path


def unpacked(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    with np.load(path) as file:
        arrays = {name: file[name] for name in file.files}
    return json.loads(arrays.pop("header").tobytes()), arrays


def packed(path: Path, header: Any, arrays: dict[str, Any]) -> Path:
    text = header if isinstance(header, bytes) else json.dumps(header).encode()
    np.savez(path, header=np.frombuffer(text, dtype=np.uint8), **arrays)
    return path


def refusal(path: Path) -> str:
    with pytest.raises(CogmapError) as raised:
        Agent.load(path)
    text = str(raised.value)
    assert text.startswith(f"load: {path} ")
    assert text.isprintable()
    return text


def test_an_array_that_no_agent_has_is_refused(saved: Path, tmp_path: Path) -> None:
    header, arrays = unpacked(saved)
    assert "has an array 'extra'" in refusal(packed(tmp_path / "map.npz", header, {**arrays, "extra": np.zeros(3)}))


def test_an_array_of_zeros_in_a_small_file_is_refused_before_it_is_there(saved: Path, tmp_path: Path) -> None:
    path = tmp_path / "map.npz"
    path.write_bytes(saved.read_bytes())
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as file, file.open("bomb.npy", "w") as member:
        for _ in range(64):
            member.write(bytes(2**20))
    assert "which no file of" in refusal(path)


def test_members_that_overlap_are_refused(saved: Path, tmp_path: Path) -> None:
    """Every entry of the list leads to the one member that is there."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as file:
        file.writestr("a.npy", bytes(100_000))
        first = file.infolist()[0]
        for number in range(50):
            entry = zipfile.ZipInfo(f"b{number}.npy")
            entry.header_offset, entry.CRC = first.header_offset, first.CRC
            entry.file_size = entry.compress_size = 100_000
            file.filelist.append(entry)
            file.NameToInfo[entry.filename] = entry
    path = tmp_path / "map.npz"
    path.write_bytes(content.getvalue())
    assert "which no file of" in refusal(path)


def test_a_flip_in_the_header_of_an_array_is_found(saved: Path, tmp_path: Path) -> None:
    content, path = bytearray(saved.read_bytes()), tmp_path / "map.npz"
    with zipfile.ZipFile(saved) as file:
        at = file.getinfo("visits.order.npy").header_offset
    at = content.index(b"'shape': (9,)", at) + len("'shape': (")
    content[at] = ord("8")
    path.write_bytes(content)
    assert "CRC" in refusal(path)


@pytest.mark.parametrize("places", [10**9, 0, -1, True, 1.5, "9", None, 10**30])
def test_a_number_of_places_that_is_none(places: Any, saved: Path, tmp_path: Path) -> None:
    header, arrays = unpacked(saved)
    header["map"]["places"] = places
    assert "what is known of 9" in refusal(packed(tmp_path / "map.npz", header, arrays))


@pytest.mark.parametrize(
    "text",
    [b"[" * 10_000, b'{"a":' * 10_000, b'{"format": NaN}', b'{"format": "\\ud800"}', b"[" + b"1," * 7_000_000 + b"1]"],
    ids=["lists", "objects", "NaN", "surrogate", "many"],
)
def test_json_that_is_more_than_json(text: bytes, saved: Path, tmp_path: Path) -> None:
    assert "no header" in refusal(packed(tmp_path / "map.npz", text, unpacked(saved)[1]))
    with pytest.raises(ValueError, match=r"JSON|surrogate|Expecting"):
        parse_json(text)


def member(shape: str, descr: str = "<i8", body: bytes = b"") -> bytes:
    head = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}".encode()
    head += b" " * (-(len(head) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head + body


@pytest.mark.parametrize(
    ("shape", "descr"),
    [
        ("(1000000000000,)", "<i8"), ("(1000000, 1000000)", "<i8"), ("(" + "9" * 100 + ",)", "<i8"), ("(0,)", "|O"),
        ("(__import__('os'),)", "<i8"), ("(0,)", "<U8"), ("(0,)", "<M8"), ("(0,)", "<f1"), ("(-1,)", "<i8"),
    ],
)  # fmt: skip
def test_arrays_that_are_none(shape: str, descr: str, saved: Path, tmp_path: Path) -> None:
    path = tmp_path / "map.npz"
    with zipfile.ZipFile(saved) as old, zipfile.ZipFile(path, "w") as new:
        for name in old.namelist():
            new.writestr(name, member(shape, descr) if name == "growth.npy" else old.read(name))
    assert "is damaged" in refusal(path)


WRONG: dict[str, Any] = {
    "masses 5 and -4": ("state.belief.message.mass", lambda a: np.array([5.0, -4.0])),
    "a mass of 5": ("state.belief.message.mass", lambda a: a * 5.0),
    "counts below zero": ("B_s.evidence", lambda a: a - 1.0),
    "an outcome twice": ("B_s.keys", lambda a: np.where(a == -1, a[:, :1], a)),
    "no way back": ("B_s.prior", lambda a: a * 0.0),
    "a place that is elsewhere": ("place_at.values", lambda a: np.roll(a, 1)),
    "ways sensed as 7": ("sensed.values", lambda a: a + np.int8(7)),
    "growth by action 99": ("growth", lambda a: np.where(np.arange(7) == 4, 99, a)),
    "growth without places": ("growth", lambda a: a[a[:, 1] != 3]),
}


@pytest.mark.parametrize("name", WRONG)
def test_numbers_that_no_agent_has(name: str, saved: Path, tmp_path: Path) -> None:
    header, arrays = unpacked(saved)
    array, change = WRONG[name]
    assert "is damaged" in refusal(packed(tmp_path / "map.npz", header, {**arrays, array: change(arrays[array])}))


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("action", 99), ("action", True), ("steps", -1), ("steps", 13), ("acted", 1), ("open", None),
    ],
)  # fmt: skip
def test_states_that_no_agent_is_in(field: str, value: Any, saved: Path, tmp_path: Path) -> None:
    header, arrays = unpacked(saved)
    if field == "open":
        value = {"tuple": [True, False]}
    header["state"][field] = value
    assert "is damaged" in refusal(packed(tmp_path / "map.npz", header, arrays))


@pytest.mark.parametrize("field", ["evidence", "moved", "doubt"])
def test_beliefs_that_are_none(field: str, saved: Path, tmp_path: Path) -> None:
    header, arrays = unpacked(saved)
    header["state"]["belief"][field] = 1e999
    text = json.dumps(header).replace("Infinity", "1e999").encode()
    assert "too large" in refusal(packed(tmp_path / "map.npz", text, arrays))
    header["state"]["belief"][field] = "x"
    assert "is damaged" in refusal(packed(tmp_path / "map.npz", header, arrays))


def test_only_regular_files_are_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "fifo")
    for path in (tmp_path / "fifo", Path("/dev/zero"), tmp_path):
        refusal(path)
        with pytest.raises((CogmapError, OSError)):
            open_regular(path)
    (tmp_path / "long").write_bytes(bytes(100))
    with pytest.raises(CogmapError, match=r"long has 100 bytes; such a file has 10 at most"):
        read_file(tmp_path / "long", most=10)


def test_the_newest_byte_order_is_no_matter(saved: Path, tmp_path: Path) -> None:
    header, arrays = unpacked(saved)
    other = {name: values.astype(values.dtype.newbyteorder(">")) for name, values in arrays.items()}
    loaded = Agent.load(packed(tmp_path / "map.npz", header, other))
    assert loaded.state()[0] == Agent.load(saved).state()[0]


# -- recordings, ledgers, graphs -----------------------------------------------------------------------------------


def test_a_packed_recording_of_any_size_is_refused_before_it_is_unpacked(tmp_path: Path) -> None:
    path = tmp_path / "run.json.gz"
    with gzip.open(path, "wb") as file:
        file.write(b"[")
        for _ in range(40):
            file.write(b"[]," * 2**18)
    with pytest.raises(CogmapError, match="6,000,000 are read at most"):
        Recording.load(path)
    path.write_bytes(gzip.compress(bytes(2**20)) * 300)
    with pytest.raises(CogmapError, match=r"such a file has 268,435,456 at most"):
        Recording.load(path)


@pytest.mark.parametrize("text", ["[" * 10_000, '{"format": NaN}', '{"a": "\\udc00"}', "1e999", "", "null"])
def test_recordings_and_graphs_of_json_that_is_none(text: str, tmp_path: Path) -> None:
    for name, load in (("run.json", Recording.load), ("graph.json", load_graph)):
        path = tmp_path / name
        path.write_text(text)
        with pytest.raises(CogmapError) as raised:
            load(path)
        assert str(raised.value).isprintable()
        assert str(path) in str(raised.value)


def test_a_pipe_is_no_recording_and_no_graph(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a.json")
    with pytest.raises(CogmapError, match="no regular file"):
        Recording.load(tmp_path / "a.json")
    with pytest.raises(CogmapError, match="no regular file"):
        load_graph(tmp_path / "a.json")
    with pytest.raises(WorldError, match="not a regular file"):
        load_world(tmp_path / "a.json")


PARENTS = ", ".join(f"v{i}" for i in range(40))
VARIABLES = "".join(f"variable v{i} {{ type discrete [ 2 ] {{ a b }}; }}\n" for i in range(40))
LAUGHS = "".join(f"<!ENTITY a{i + 1} '{f'&a{i};' * 9}'>" for i in range(9))
HOSTILE = {
    "labels.uai": ("MARKOV 1 1000000000 0", "1,000,000,000 labels"),
    "digits.uai": ("MARKOV 1 " + "9" * 5000, "number of labels"),
    "scope.uai": (f"MARKOV 100 {'1 ' * 100} 1 100 {' '.join(map(str, range(100)))} 1 1", "100 variables"),
    "scope.bif": (VARIABLES + f"probability ( {PARENTS} ) {{ default 1; }}", "40 variables"),
    "table.bif": (VARIABLES + f"probability ( {', '.join(f'v{i}' for i in range(30))} ) {{ default 1; }}", "entries"),
    "digits.bif": (f"variable a {{ type discrete [ {'9' * 5000} ] {{ x }}; }}", "has 1 labels"),
    "rest.bif": ("variable a { " + "type discrete [1] { x " * 20_000 + "}" * 20_001, "expected 'variable NAME"),
    "properties.bif": ("variable a { " + "property x" * 50_000 + "}", "expected 'variable NAME"),
    "laughs.xmlbif": (f"<!DOCTYPE a [<!ENTITY a0 'a'>{LAUGHS}]><a>&a9;</a>", "declares an entity"),
    "deep.xmlbif": ("<a>" * 100_000, "nested too deeply"),
    "time.json": ('{"format": "cogmap factor graph", "schema": 1, "variables": '
                  '[{"name": "a", "domain": [1], "time": {}, "observed": false}], "factors": []}', "time and observed"),
}  # fmt: skip


@pytest.mark.parametrize("name", HOSTILE)
def test_graphs_that_would_take_all_memory_or_time(name: str, tmp_path: Path) -> None:
    text, message = HOSTILE[name]
    (tmp_path / name).write_text(text)
    with pytest.raises(CogmapError, match=message) as raised:
        load_graph(tmp_path / name)
    assert len(str(raised.value)) < 1000


NODES = "\n".join(f"- node: {{name: n{i}, properties: {{sight: a}}, edges: *e}}" for i in range(1000))
EDGES = ", ".join(["{node: n0}"] * 5000)
WORLDS = {
    "aliases.yaml": (f"- node: {{name: n, properties: {{sight: a}}, edges: &e [{EDGES}]}}\n{NODES}", "read at most"),
    "merged.yaml": ("nodes:\n- node: {name: a, <<: {sight: b}}\n", "merge keys"),
    "nested.yaml": ("[" * 100_000, "nesting depth|deep"),
    "labels.yaml": ("- node: {name: a, properties: {sight: " + str([[["x"] * 9] * 9] * 9) + "}}", "short list"),
    "edges.yaml": ("- node: {name: a, properties: {sight: x}, edges: 3}", "edges are 3; give a list"),
    "laughs.graphml": (f"<!DOCTYPE a [<!ENTITY a0 'a'>{LAUGHS}]><graphml>&a9;</graphml>", "declares entities"),
    "surrogate.json": ('{"nodes": [{"id": 1, "sight": "\\ud800"}], "edges": []}', "half of a character"),
    "deep.json": ("[" * 200_000, "nested too deeply"),
    "null\0name.txt": (None, "no world"),
}  # fmt: skip


@pytest.mark.parametrize("name", WORLDS)
def test_worlds_that_would_take_all_memory_or_time(name: str, tmp_path: Path) -> None:
    text, message = WORLDS[name]
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(WorldError, match=message) as raised:
        load_world(tmp_path / name)
    assert str(raised.value).isprintable()


def test_a_name_with_control_characters_is_written_out_in_errors(tmp_path: Path) -> None:
    path = tmp_path / "a\x1b[31m\n.npz"
    for load, error in ((Agent.load, CogmapError), (Recording.load, CogmapError), (load_world, WorldError)):
        with pytest.raises(error) as raised:
            load(path)
        assert str(raised.value).isprintable()
        assert r"\x1b[31m" in str(raised.value)


@pytest.mark.parametrize(
    ("field", "value"),
    [("followed", 99), ("followed", -1), ("followed", True), ("missed", ["x"]), ("moved", 1), ("places", [[0, 10**9]]),
     ("places", []), ("places", [["x", 0]])],
)  # fmt: skip
def test_recognitions_that_no_agent_has(field: str, value: Any, saved: Path, tmp_path: Path) -> None:
    header, arrays = unpacked(saved)
    header["recognition"][field] = value
    assert "is damaged" in refusal(packed(tmp_path / "map.npz", header, arrays))


def test_a_place_that_the_map_was_not_told_of_yet_is_no_damage(saved: Path, tmp_path: Path) -> None:
    header, arrays = unpacked(saved)
    here, known = Agent.load(saved)._recognition.tracker.best.here, header["recognition"]["places"]
    header["recognition"]["places"] = [pair for pair in known if pair[0] != here]
    assert "follows a hypothesis that there is not" in refusal(packed(tmp_path / "map.npz", header, arrays))
    header["recognition"]["missed"] = [here]
    loaded = Agent.load(packed(tmp_path / "map.npz", header, arrays))
    loaded.step({"sight": 0, "open": [True] * 5})
