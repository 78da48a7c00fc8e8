"""Meshes: PLY files."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from .errors import PathLike, RunError, brief, refuse
from .files import read_bytes

_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1",
    "short": "<i2", "int16": "<i2", "ushort": "<u2", "uint16": "<u2",
    "int": "<i4", "int32": "<i4", "uint": "<u4", "uint32": "<u4",
    "float": "<f4", "float32": "<f4", "double": "<f8", "float64": "<f8",
}  # fmt: skip
_KNOWN = {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"}


@dataclass
class Mesh:
    """A triangle mesh, or points without triangles."""

    vertices: np.ndarray  #: V x 3 float32, metres.
    triangles: np.ndarray  #: T x 3 int32, indices of vertices.
    normals: Optional[np.ndarray] = None  #: V x 3 float32, unit length.
    colors: Optional[np.ndarray] = None  #: V x 3 uint8, red, green, blue.
    #: Further properties of the vertices by name, V float each, as the `sigma`
    #: (metres) of uncertainty/.
    extra: dict[str, np.ndarray] = field(default_factory=dict)


@dataclass
class _Element:
    name: str
    count: int
    #: Name, type, and of a list the type of its count (else empty).
    properties: list[tuple[str, str, str]]


def _header(path: PathLike, data: bytes) -> tuple[list[_Element], int]:
    """The elements, and where what follows begins."""
    marker = b"end_header"
    end = data.find(marker)
    if not data.startswith(b"ply") or end < 0:
        refuse(path, "no header of a PLY file", "'ply' ... 'end_header'")
    begin = data.find(b"\n", end) + 1 or len(data)
    elements: list[_Element] = []
    file_format = ""
    for line in data[:end].decode("ascii", "replace").splitlines()[1:]:
        words = line.split()
        try:
            if words[:1] == ["format"]:
                file_format = words[1]
            elif words[:1] == ["element"]:
                elements.append(_Element(words[1], int(words[2]), []))
            elif words[:2] == ["property", "list"]:
                elements[-1].properties.append(
                    (words[4], _TYPES[words[3]], _TYPES[words[2]])
                )
            elif words[:1] == ["property"]:
                elements[-1].properties.append((words[2], _TYPES[words[1]], ""))
        except (IndexError, KeyError, ValueError):
            refuse(f"{path}: header", line, "a line of a PLY header")
    if file_format != "binary_little_endian":
        refuse(f"{path}: format", file_format, "binary_little_endian")
    return elements, begin


def _record(path: PathLike, element: _Element) -> np.dtype:
    """The layout of one entry; lists are those of three corners."""
    fields: list[tuple] = []
    for name, kind, count in element.properties:
        if count:
            fields.append((name + "_count", count))
            fields.append((name, kind, (3,)))
        else:
            fields.append((name, kind))
    try:
        return np.dtype(fields)
    except ValueError as error:
        raise RunError(f"{path}: {error}: expected each once") from None


def _stack(rows: np.ndarray, names: str, kind: type) -> Optional[np.ndarray]:
    keys = names.split()
    if not all(key in (rows.dtype.names or ()) for key in keys):
        return None
    return np.stack([rows[key] for key in keys], axis=1).astype(kind)


def _triangles(path: PathLike, rows: np.ndarray, vertices: int) -> np.ndarray:
    for name in ("vertex_indices", "vertex_index"):
        if name in (rows.dtype.names or ()):
            break
    else:
        refuse(
            f"{path}: element face", brief(rows.dtype.names), "vertex_indices"
        )
    triangles = rows[name].astype(np.int32)
    if (rows[name + "_count"] != 3).any():
        refuse(
            f"{path}: element face", "faces of other kinds", "triangles alone"
        )
    if (
        triangles.size
        and not 0 <= triangles.min() <= triangles.max() < vertices
    ):
        refuse(
            f"{path}: element face",
            f"vertex {triangles.max()}",
            f"indices of {vertices} vertices",
        )
    return triangles


def read_ply(path: PathLike) -> Mesh:
    """Reads a mesh in binary little-endian form, as the programs write it."""
    data = read_bytes(path)
    elements, begin = _header(path, data)
    found: dict[str, np.ndarray] = {}
    for element in elements:
        record = _record(path, element)
        end = begin + record.itemsize * element.count
        if element.count < 0 or end > len(data):
            refuse(path, f"{len(data)} bytes", f"at least {end}")
        found[element.name] = np.frombuffer(
            data, record, element.count, offset=begin
        )
        begin = end
    vertex = found.get("vertex", np.zeros(0, np.dtype([("x", "<f4")])))
    vertices = _stack(vertex, "x y z", np.float32)
    if vertices is None:
        return refuse(f"{path}: element vertex", vertex.dtype.names, "x, y, z")
    triangles = np.zeros((0, 3), np.int32)
    if "face" in found and len(found["face"]):
        triangles = _triangles(path, found["face"], len(vertices))
    extra = {n: vertex[n] for n in vertex.dtype.names or () if n not in _KNOWN}
    return Mesh(
        vertices,
        triangles,
        _stack(vertex, "nx ny nz", np.float32),
        _stack(vertex, "red green blue", np.uint8),
        extra,
    )
