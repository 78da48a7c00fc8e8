"""The deformation graph of a surface, and its motion in every frame."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Optional

import numpy as np

from .errors import PathLike, RunError, refuse
from .files import read_bytes, read_json

#: Newest version of `motions.bin`, the last two bytes of its first eight.
MOTIONS_VERSION = 4


@dataclass
class Part:
    """Nodes from `node` to the next part's, in use in some frames only."""

    node: int  #: Index of the first node.
    first_frame: int  #: Frame index.
    end_frame: Optional[int]  #: Behind the last frame; None: no end.

    def holds(self, frame: int) -> bool:
        """Whether the part is in use in a frame."""
        return self.first_frame <= frame and (
            self.end_frame is None or frame < self.end_frame
        )


@dataclass
class Graph:
    """Nodes of a surface in its canonical frame: `graph.json`."""

    node_spacing: float  #: Metres; 0: rigid, one node.
    neighbors_per_point: int  #: Nodes that carry a point, at most.
    positions: np.ndarray  #: N x 3 float64, canonical, metres.
    edges: list[list[int]]  #: Neighbours of every node.
    #: N int, frame in which each was placed; None: all count from the start.
    first_seen: Optional[np.ndarray] = None
    parts: list[Part] = field(default_factory=list)  #: Empty: all in use.

    def __len__(self) -> int:
        return len(self.positions)

    def in_use(self, frame: int) -> np.ndarray:
        """Which nodes are in use in a frame, N bool."""
        used = np.ones(len(self), dtype=bool)
        for number, part in enumerate(self.parts):
            later = self.parts[number + 1 :]
            end = later[0].node if later else len(self)
            used[part.node : end] = part.holds(frame)
        return used


def _array(
    place: str, value: Any, shape: tuple[int, ...], kind: type
) -> np.ndarray:
    """An array of that shape (-1: any); RunError if it is none."""
    try:
        array = np.asarray(value if len(value) else np.zeros((0,) + shape[1:]))
        good = array.dtype.kind in "if" and array.ndim == len(shape)
    except (TypeError, ValueError):
        return refuse(place, value, "numbers")
    good = good and all(s in (-1, n) for s, n in zip(shape, array.shape))
    if not good or not np.isfinite(array.astype(np.float32)).all():
        refuse(place, value, "numbers, " + " x ".join(map(str, shape)))
    return array.astype(kind)


def _edges(place: str, value: Any, nodes: int) -> list[list[int]]:
    good = isinstance(value, list) and len(value) == nodes
    if not good:
        refuse(place, value, f"one list for each of {nodes} nodes")
    for item in value:
        if not isinstance(item, list) or not all(
            type(j) is int and 0 <= j < nodes for j in item
        ):
            refuse(place, item, f"nodes 0..{nodes - 1}")
    return value


def _parts(place: str, value: Any, nodes: int) -> list[Part]:
    parts: list[Part] = []
    for item in value if isinstance(value, list) else [value]:
        good = isinstance(item, list) and len(item) == 3
        good = good and all(type(i) is int and i >= 0 for i in item[:2])
        good = good and (item[2] is None or type(item[2]) is int)
        good = good and (item[2] is None or item[2] > item[1])
        good = good and item[0] < nodes
        good = good and (item[0] > parts[-1].node if parts else item[0] == 0)
        if not good:
            refuse(place, item, "[first node, first frame, end or null]")
        parts.append(Part(*item))
    return parts


def read_graph(path: PathLike) -> Graph:
    """Reads `graph.json`."""
    data = read_json(path)
    for key in ("node_spacing", "neighbors_per_point", "positions", "edges"):
        if key not in data:
            refuse(f"{path}: field '{key}'", "missing", "a value")
    spacing, few = data["node_spacing"], data["neighbors_per_point"]
    if type(spacing) not in (int, float) or not 0 <= spacing < math.inf:
        refuse(f"{path}: field 'node_spacing'", spacing, "metres >= 0")
    if type(few) is not int or few < 1:
        refuse(f"{path}: field 'neighbors_per_point'", few, "1 or more")
    if data.get("models"):
        refuse(f"{path}: field 'models'", "there", "a run with 'parts'")
    positions = _array(
        f"{path}: field 'positions'", data["positions"], (-1, 3), float
    )
    nodes = len(positions)
    if nodes == 0:
        refuse(f"{path}: field 'positions'", "no node", "one or more")
    first = data.get("first_seen") or None
    if first is not None:
        first = _array(f"{path}: field 'first_seen'", first, (nodes,), int)
    return Graph(
        float(spacing),
        few,
        positions,
        _edges(f"{path}: field 'edges'", data["edges"], nodes),
        first,
        _parts(f"{path}: field 'parts'", data.get("parts", []), nodes),
    )


@dataclass
class Motions:
    """Motions of the nodes of a surface in all frames that it has:
    `motions.bin`.

    A point p (canonical) of node i at g_i goes to R_i (p - g_i) + t_i + g_i in
    the camera frame. A frame has motions of those nodes that are in use in it.
    """

    frames: np.ndarray  #: F int32, frame indices, ascending.
    tracked: np.ndarray  #: F bool; False: the motion was carried over.
    node_count: int  #: Nodes of the graph, N.
    #: F arrays, M x 12 float32: rotation row by row, then translation, metres.
    moved: list[np.ndarray]
    nodes: list[np.ndarray]  #: F arrays, M int: the nodes of these, ascending.
    #: F arrays, M bool: live depth showed the surface at the node; None: not
    #: told, in files of version 1 and 2.
    seen: Optional[list[np.ndarray]] = None

    def index(self, frame: int) -> Optional[int]:
        """Row of a frame; None: the surface has no motion in it."""
        row = int(np.searchsorted(self.frames, frame))
        found = row < len(self.frames) and self.frames[row] == frame
        return row if found else None

    def at(self, row: int) -> tuple[np.ndarray, np.ndarray]:
        """Rotations (N x 3 x 3) and translations (N x 3, metres) in a row,
        float32; nodes that are not in use are not moved."""
        all_nodes = np.zeros((self.node_count, 12), np.float32)
        all_nodes[:, [0, 4, 8]] = 1
        all_nodes[self.nodes[row]] = self.moved[row]
        return all_nodes[:, :9].reshape(-1, 3, 3), all_nodes[:, 9:]

    @property
    def rotations(self) -> np.ndarray:
        """Those of all rows, F x N x 3 x 3: much memory where a surface has
        many parts."""
        none = np.zeros((0, self.node_count, 3, 3), np.float32)
        rows = [self.at(row)[0] for row in range(len(self.frames))]
        return np.stack(rows) if rows else none

    @property
    def translations(self) -> np.ndarray:
        """Those of all rows, F x N x 3, metres."""
        none = np.zeros((0, self.node_count, 3), np.float32)
        rows = [self.at(row)[1] for row in range(len(self.frames))]
        return np.stack(rows) if rows else none


def _motions_version(path: PathLike, data: bytes) -> int:
    head = data[:8]
    digits = head[6:].decode("ascii", "replace")
    if len(data) < 16 or head[:6] != b"SFMOTN" or not digits.isdigit():
        refuse(
            path, head, f"a file that begins with SFMOTN{MOTIONS_VERSION:02}"
        )
    version = int(digits)
    if not 1 <= version <= MOTIONS_VERSION:
        refuse(
            f"{path}: version",
            version,
            f"1..{MOTIONS_VERSION}: written by a newer version, read it with "
            "that one",
        )
    return version


def _check_sum(path: PathLike, data: bytes) -> None:
    """Where the module `xxhash` is installed."""
    try:
        import xxhash
    except ImportError:
        return
    if xxhash.xxh3_64_intdigest(data[:-8]) != int.from_bytes(
        data[-8:], "little"
    ):
        raise RunError(
            f"{path}: is damaged: expected the checksum of its content"
        )


def _check_motions(path: PathLike, motions: Motions) -> None:
    frames = motions.frames
    if len(frames) and (frames[0] < 0 or (np.diff(frames) <= 0).any()):
        refuse(f"{path}: frames", frames, "ascending, from 0")
    for moved in motions.moved:
        r = moved[:, :9].reshape(-1, 3, 3)
        with np.errstate(invalid="ignore", over="ignore"):
            away = np.abs(np.swapaxes(r, -1, -2) @ r - np.eye(3, dtype=r.dtype))
        good = (away < 1e-2).all() and np.isfinite(moved[:, 9:]).all()
        if not good or not (np.linalg.det(r) > 0).all():
            raise RunError(
                f"{path}: is damaged: expected a rotation and a translation of "
                "every node"
            )


class _Bytes:
    """Takes arrays off the content of a file, one after the other."""

    def __init__(self, path: PathLike, data: bytes, begin: int, end: int):
        self.path, self.data, self.next, self.end = path, data, begin, end

    def take(self, kind: str, count: int) -> np.ndarray:
        size = count * np.dtype(kind).itemsize
        if size > self.end - self.next:
            refuse(
                self.path,
                f"{len(self.data)} bytes",
                f"{size - self.end + self.next} more: it is truncated",
            )
        taken = np.frombuffer(self.data, kind, count, offset=self.next)
        self.next += size
        return taken

    def take_nodes(self, version: int, nodes: int) -> np.ndarray:
        """The nodes of which a frame has motions."""
        if version < 4:
            return np.arange(nodes)
        count = int(self.take("<u4", 1)[0])
        ranges = self.take("<u4", 2 * count).reshape(count, 2).astype(int)
        flat = ranges.reshape(-1)
        if (np.diff(flat) < 0).any() or (flat > nodes).any() or count == 0:
            refuse(
                f"{self.path}: nodes", ranges.tolist(), f"ascending, to {nodes}"
            )
        return np.concatenate([np.arange(a, b) for a, b in ranges])


def read_motions(path: PathLike) -> Motions:
    """Reads `motions.bin`, all versions of it up to MOTIONS_VERSION. Its
    checksum is looked at where the module `xxhash` is installed."""
    data = read_bytes(path)
    version = _motions_version(path, data)
    if version >= 2:
        _check_sum(path, data)
    content = _Bytes(path, data, 8, len(data) - (8 if version >= 2 else 0))
    count, nodes = (int(n) for n in content.take("<u4", 2))
    frames, tracked = np.zeros(0, np.int32), np.zeros(0, bool)
    motions = Motions(
        frames, tracked, nodes, [], [], [] if version >= 3 else None
    )
    heads = []
    for _ in range(count):
        heads.append(content.take("<i4", 2))
        which = content.take_nodes(version, nodes)
        motions.nodes.append(which)
        moved = content.take("<f4", 12 * len(which))
        motions.moved.append(moved.reshape(-1, 12))
        if motions.seen is not None:
            motions.seen.append(content.take("u1", len(which)) != 0)
    if content.next != content.end:
        refuse(
            path,
            f"{len(data)} bytes",
            f"{content.end - content.next} less for {count} frames",
        )
    if heads:
        motions.frames = np.stack(heads)[:, 0].astype(np.int32)
        motions.tracked = np.stack(heads)[:, 1] != 0
    _check_motions(path, motions)
    return motions
