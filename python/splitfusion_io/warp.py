"""Points that are carried by a deformation graph.

Equations 1 to 3 of the paper, as lib/deformation/skinning.cc computes them: in
single precision and in the same order, so that warped points agree with
`warped/FRAME.ply` to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .graph import Graph

_MAX_CANDIDATES = 128


def nearest(queries: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """Index of the target nearest to each query, the lowest among equals.

    Queries Q x 3 and targets N x 3 (N > 0), float32, metres; Q int. Exact: the
    queries of a cell are compared with all targets that can be nearest there.
    """
    found = np.zeros(len(queries), dtype=np.int64)
    if len(queries) == 0:
        return found
    low, high = queries.min(axis=0), queries.max(axis=0)
    size = max(float((high - low).max()) / 32, 1e-6)
    cells = np.floor((queries - low) / size).astype(np.int64)
    keys = (cells[:, 0] << 20) + (cells[:, 1] << 10) + cells[:, 2]
    order = np.argsort(keys, kind="stable")
    bounds = np.flatnonzero(np.diff(keys[order], prepend=-1, append=-1))
    for begin, end in zip(bounds[:-1], bounds[1:]):
        inside = order[begin:end]
        center = low + (cells[inside[0]] + 0.5) * size
        away = np.linalg.norm(targets - center, axis=1)
        # The cell's corners are 0.87 sizes off its centre; some for rounding.
        reach = away.min() + 2 * 0.88 * size + 1e-5
        some = np.flatnonzero(away <= reach)
        step = max(1, 4_000_000 // len(some))
        for at in range(0, len(inside), step):
            part = inside[at : at + step]
            d = queries[part][:, None] - targets[some][None]
            squared = d[..., 0] ** 2 + d[..., 1] ** 2 + d[..., 2] ** 2
            found[part] = some[np.argmin(squared, axis=1)]
    return found


@dataclass
class Skinning:
    """Nodes that carry points, and their weights (Eq. 3)."""

    nodes: np.ndarray  #: P x K int, ascending; 0 where the weight is 0.
    weights: np.ndarray  #: P x K float32, sum 1.

    def __getitem__(self, points: np.ndarray) -> "Skinning":
        """Those of some of the points."""
        return Skinning(self.nodes[points], self.weights[points])


def _candidates(graph: Graph, node: int, wanted: int) -> np.ndarray:
    """Nodes within two edges of `node`, ascending; within more edges where
    these are fewer than `wanted`."""
    found = [node]
    known = {node}
    ring, edges = 0, 1
    while ring < len(found) and not (edges > 2 and len(found) >= wanted):
        end = len(found)
        for i in range(ring, end):
            for j in graph.edges[found[i]]:
                if j not in known:
                    known.add(j)
                    found.append(j)
        ring, edges = end, edges + 1
    nodes = np.array(sorted(found))
    if len(nodes) > _MAX_CANDIDATES:
        away = graph.positions[nodes] - graph.positions[node]
        order = np.argsort((away**2).sum(axis=1), kind="stable")
        nodes = np.sort(nodes[order[:_MAX_CANDIDATES]])
    return nodes


def _weigh(
    points: np.ndarray, nodes: np.ndarray, positions: np.ndarray, few: int
) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of points that have the same candidates."""
    used = min(few, len(nodes))
    d = points[:, None] - positions[nodes][None]
    squared = d[..., 0] ** 2 + (d[..., 1] ** 2 + d[..., 2] ** 2)
    order = np.argsort(squared, axis=1, kind="stable")[:, : used + 1]
    distance = np.sqrt(np.take_along_axis(squared, order, axis=1))
    farthest = distance[:, -1:]
    d_max = farthest if len(nodes) > used else np.float32(2) * farthest
    with np.errstate(invalid="ignore", divide="ignore"):
        closeness = np.float32(1) - distance[:, :used] / d_max
    weights = np.fmax(closeness * closeness, np.float32(1e-8))
    by_node = np.argsort(order[:, :used], axis=1)
    order = np.take_along_axis(order[:, :used], by_node, axis=1)
    weights = np.take_along_axis(weights, by_node, axis=1)
    total = np.zeros(len(points), np.float32)
    for k in range(used):
        total += weights[:, k]
    return nodes[order], weights / total[:, None]


def skin(graph: Graph, points: np.ndarray) -> Skinning:
    """The nodes that carry points (P x 3, canonical, metres), by Eq. 3."""
    points = np.asarray(points, np.float32).reshape(-1, 3)
    few = graph.neighbors_per_point
    nodes = np.zeros((len(points), few), dtype=np.int64)
    weights = np.zeros((len(points), few), dtype=np.float32)
    if len(graph) == 1:
        weights[:, 0] = 1
        return Skinning(nodes, weights)
    positions = graph.positions.astype(np.float32)
    closest = nearest(points, positions)
    order = np.argsort(closest, kind="stable")
    bounds = np.flatnonzero(np.diff(closest[order], prepend=-1, append=-1))
    for begin, end in zip(bounds[:-1], bounds[1:]):
        inside = order[begin:end]
        candidates = _candidates(graph, int(closest[inside[0]]), few + 1)
        found, share = _weigh(points[inside], candidates, positions, few)
        nodes[inside, : found.shape[1]] = found
        weights[inside, : share.shape[1]] = share
    return Skinning(nodes, weights)


class WarpField:
    """Motions of the nodes of one frame, for warping many points."""

    def __init__(
        self, graph: Graph, rotations: np.ndarray, translations: np.ndarray
    ) -> None:
        """`rotations` N x 3 x 3 and `translations` N x 3 (metres) of the
        graph's nodes, camera from canonical."""
        g = graph.positions
        moved = np.einsum("nij,nj->ni", rotations.astype(float), -g)
        offset = moved + (translations.astype(float) + g)
        self.linear = rotations.astype(np.float32)
        self.offset = offset.astype(np.float32)

    def points(self, skinning: Skinning, points: np.ndarray) -> np.ndarray:
        """Eq. 2: P x 3 canonical to P x 3 float32 in the camera frame, m."""
        points = np.asarray(points, np.float32).reshape(-1, 3)
        warped = np.zeros_like(points)
        for k in range(skinning.nodes.shape[1]):
            node, weight = skinning.nodes[:, k], skinning.weights[:, k, None]
            linear = self.linear[node]
            moved = linear[:, :, 0] * points[:, :1]
            moved += linear[:, :, 1] * points[:, 1:2]
            moved += linear[:, :, 2] * points[:, 2:]
            warped += weight * (moved + self.offset[node])
        return warped

    def normals(self, skinning: Skinning, normals: np.ndarray) -> np.ndarray:
        """Unit normals, P x 3 canonical to P x 3 float32, camera frame."""
        blended = self._blend(skinning)
        turned = np.einsum(
            "pij,pj->pi", blended, np.asarray(normals, np.float32)
        )
        length = np.linalg.norm(turned, axis=1, keepdims=True)
        return turned / np.where(length > 0, length, np.float32(1))

    def rotations(self, skinning: Skinning) -> np.ndarray:
        """The rotation nearest to the blended one at each point, P x 3 x 3."""
        u, _, vt = np.linalg.svd(self._blend(skinning).astype(float))
        u[:, :, 2] *= np.sign(np.linalg.det(u @ vt))[:, None]
        return u @ vt

    def _blend(self, skinning: Skinning) -> np.ndarray:
        blended = np.zeros((len(skinning.nodes), 3, 3), np.float32)
        for k in range(skinning.nodes.shape[1]):
            weight = skinning.weights[:, k, None, None]
            blended += weight * self.linear[skinning.nodes[:, k]]
        return blended
