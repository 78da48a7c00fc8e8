"""A surface of a run: its mesh, its graph, and where both are in a frame."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from .errors import PathLike, RunError, refuse
from .graph import Graph, Motions, read_graph, read_motions
from .hdf5 import read_hdf5
from .ply import Mesh, read_ply
from .warp import Skinning, WarpField, nearest, skin

#: An edge of a warped mesh beyond this is stretched, metres.
STRETCHED_EDGE = 0.03


def _longest_edges(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The longest edge of each triangle, metres."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    sides = [np.linalg.norm(p - q, axis=1) for p, q in ((a, b), (b, c), (c, a))]
    return np.max(sides, axis=0)


@dataclass
class Attachment:
    """Points that ride on vertices of a surface."""

    vertices: np.ndarray  #: P int, indices of vertices of `mesh`.
    #: P x 3, from the vertex to the point, turned back to the canonical frame.
    offsets: np.ndarray
    distances: np.ndarray  #: P, metres from the vertex when attached.


class Surface:
    """The folder `surfaces/NNN_LABEL`. Files are read when they are needed."""

    def __init__(self, folder: PathLike, whole: bool = False) -> None:
        """`whole`: warped meshes have what was seen only later, too, as of a
        run with `--warped_whole`."""
        self.folder = Path(folder)
        number, underscore, self.label = self.folder.name.partition("_")
        if not underscore or not number.isdigit():
            refuse(folder, self.folder.name, "a folder NNN_LABEL")
        self.id = int(number)
        self.whole = whole

    def __repr__(self) -> str:
        return f"Surface({str(self.folder)!r})"

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh in the canonical frame, metres."""
        mesh = read_ply(self.folder / "mesh.ply")
        if not np.isfinite(mesh.vertices).all():
            refuse(self.folder / "mesh.ply", "a vertex", "finite metres")
        return mesh

    @cached_property
    def graph(self) -> Graph:
        """Nodes in the canonical frame."""
        return read_graph(self.folder / "graph.json")

    @cached_property
    def motions(self) -> Motions:
        """Motions of all nodes, camera from canonical."""
        motions = read_motions(self.folder / "motions.bin")
        if len(motions.frames) and motions.node_count != len(self.graph):
            refuse(
                self.folder / "motions.bin",
                f"{motions.node_count} nodes",
                f"those of graph.json, {len(self.graph)}",
            )
        for frame, nodes in zip(motions.frames, motions.nodes):
            missing = self.graph.in_use(int(frame))
            missing[nodes] = False
            if missing.any():
                refuse(
                    self.folder / "motions.bin",
                    f"frame {frame} without node {int(missing.argmax())}",
                    "a motion of it, as graph.json has it in use",
                )
        return motions

    @cached_property
    def skinning(self) -> Skinning:
        """What carries the vertices of the mesh."""
        return skin(self.graph, self.mesh.vertices)

    @property
    def frames(self) -> np.ndarray:
        """Indices of the frames in which the surface has a motion."""
        return self.motions.frames

    def tracked(self, frame: int) -> bool:
        """Whether the surface was tracked in a frame, not carried over."""
        return bool(self.motions.tracked[self._row(frame)])

    def field(self, frame: int) -> WarpField:
        """The warp of a frame. RunError if the surface has no motion in it."""
        return WarpField(self.graph, *self._motions_at(frame))

    def warp(self, points: np.ndarray, frame: int) -> np.ndarray:
        """Points (P x 3, canonical, metres) in a frame: P x 3 float32, camera
        frame, metres."""
        return self.field(frame).points(skin(self.graph, points), points)

    def vertices_at(self, frame: int) -> np.ndarray:
        """The vertices of the mesh in a frame, V x 3 float32, camera frame."""
        return self.field(frame).points(self.skinning, self.mesh.vertices)

    def nodes_at(self, frame: int) -> np.ndarray:
        """Places of the nodes in a frame, N x 3, camera frame, metres."""
        return self.graph.positions + self._motions_at(frame)[1]

    def mesh_at(self, frame: int) -> Mesh:
        """The mesh in a frame as in `warped/FRAME.ply`: all vertices, and the
        triangles that are in use, had been seen and are not stretched."""
        field = self.field(frame)
        mesh = self.mesh
        vertices = field.points(self.skinning, mesh.vertices)
        normals = mesh.normals
        if normals is not None:
            normals = field.normals(self.skinning, normals)
        seen = self._seen(frame)
        triangles = mesh.triangles[seen[mesh.triangles].all(axis=1)]
        longest = _longest_edges(vertices, triangles)
        triangles = triangles[longest <= self._stretched_from]
        return Mesh(vertices, triangles, normals, mesh.colors)

    def warped(self, frame: int) -> Mesh:
        """What the run itself wrote of a frame, `warped/FRAME.ply`."""
        return read_ply(self.folder / "warped" / f"{frame:06}.ply")

    @property
    def warped_frames(self) -> list[int]:
        """Frames of which there is a file in `warped/`, ascending."""
        return sorted(
            int(p.stem) for p in self.folder.glob("warped/[0-9]*.ply")
        )

    def residuals(self) -> dict[str, np.ndarray]:
        """`residuals.h5` (needs h5py): arrays `frame`, `node` and `depth`, the
        mean distance from the live depth in metres."""
        found = read_hdf5(self.folder / "residuals.h5").arrays
        return {name.rsplit("/", 1)[-1]: rows for name, rows in found.items()}

    def attach(self, points: np.ndarray, frame: int) -> Attachment:
        """Ties points (P x 3, camera frame of `frame`, metres) to the nearest
        vertices that the model shows in that frame."""
        points = np.asarray(points, np.float32).reshape(-1, 3)
        mesh = self.mesh_at(frame)
        shown = np.unique(mesh.triangles)
        if len(shown) == 0:
            raise RunError(
                f"{self.folder}: frame {frame} shows no triangle: expected some"
            )
        vertices = shown[nearest(points, mesh.vertices[shown])]
        away = points - mesh.vertices[vertices]
        turned = self.field(frame).rotations(self.skinning[vertices])
        offsets = np.einsum("pji,pj->pi", turned, away.astype(float))
        return Attachment(vertices, offsets, np.linalg.norm(away, axis=1))

    def follow(self, attachment: Attachment, frame: int) -> np.ndarray:
        """Where attached points are in a frame: P x 3, camera frame, metres."""
        field = self.field(frame)
        carried = self.skinning[attachment.vertices]
        places = field.points(carried, self.mesh.vertices[attachment.vertices])
        turned = field.rotations(carried)
        return places + np.einsum("pij,pj->pi", turned, attachment.offsets)

    def _motions_at(self, frame: int) -> tuple[np.ndarray, np.ndarray]:
        """Rotations and translations of all nodes; those that are not in use
        have the nearest motion that they had."""
        rotations, translations = self.motions.at(self._row(frame))
        parts = self.graph.parts
        for part, later in zip(parts, parts[1:] + [None]):
            end = later.node if later else len(self.graph)
            nearest = max(frame, part.first_frame)
            if part.end_frame is not None:
                nearest = min(nearest, part.end_frame - 1)
            row = self.motions.index(nearest)
            if nearest == frame or row is None:
                continue
            at = np.searchsorted(self.motions.nodes[row], part.node)
            moved = self.motions.moved[row][at : at + end - part.node]
            rotations[part.node : end] = moved[:, :9].reshape(-1, 3, 3)
            translations[part.node : end] = moved[:, 9:]
        return rotations, translations

    def _row(self, frame: int) -> int:
        row = self.motions.index(frame)
        if row is not None:
            return row
        frames = self.frames
        span = f"{frames[0]}..{frames[-1]}" if len(frames) else "none"
        return refuse(
            f"{self.folder}: frame", frame, f"one that has motions: {span}"
        )

    @cached_property
    def _stretched_from(self) -> float:
        longest = _longest_edges(self.mesh.vertices, self.mesh.triangles)
        return max(STRETCHED_EDGE, 2 * float(longest.max(initial=0)))

    @cached_property
    def _node_distances(self) -> np.ndarray:
        """Of every vertex to the nodes that carry it, V x K, metres."""
        nodes = self.graph.positions[self.skinning.nodes]
        return np.linalg.norm(nodes - self.mesh.vertices[:, None], axis=2)

    def _seen(self, frame: int) -> np.ndarray:
        """Which vertices had been seen by a frame and are in use, V bool: the
        nearest node of each, or another one within the node spacing, was."""
        graph = self.graph
        known = graph.in_use(frame)
        if graph.first_seen is not None and not self.whole:
            known &= graph.first_seen <= frame
        if known.all():
            return np.ones(len(self.mesh.vertices), dtype=bool)
        weights = self.skinning.weights
        near = self._node_distances < graph.node_spacing
        near &= weights > 0
        near[np.arange(len(near)), weights.argmax(axis=1)] = True
        return (near & known[self.skinning.nodes]).any(axis=1)
