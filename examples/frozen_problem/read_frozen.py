#!/usr/bin/env python3
"""Reads a frozen problem (docs/solvers.md) with numpy and h5py, and evaluates
two of its terms at the start: read_frozen.py FILE.h5"""

import re
import sys

import h5py
import numpy as np

UNIT = 0.01  # Residuals are compared with 1 cm.


def rho(squared, term):
    """The robust loss of |r|^2 / s^2, as Ceres defines it."""
    scale = float(term["scale"]) / UNIT
    if term["loss"] == "huber":
        root = np.sqrt(squared)
        return np.where(root <= scale, squared, 2 * scale * root - scale**2)
    if term["loss"] == "tukey":
        inner = 1 - (1 - np.minimum(1, squared / scale**2)) ** 3
        return scale**2 / 3 * inner
    if term["loss"] == "cauchy":
        return scale**2 * np.log1p(squared / scale**2)
    return squared


def energy(squared, count, term):
    return float(term["weight"]) / count * np.sum(rho(squared / UNIT**2, term))


def warp(group, graph):
    """Model points in the camera frame, Eq. 1 and 2: M x 3."""
    nodes, weights = group["nodes"][:], group["weights"][:].astype(float)
    weights[np.arange(8)[None] >= group["node_count"][:][:, None]] = 0
    g = graph["position"][:]
    arm = group["point"][:].astype(float)[:, None] - g[nodes]
    turned = np.einsum("mkij,mkj->mki", graph["rotation"][:][nodes], arm)
    carried = turned + g[nodes] + graph["translation"][:][nodes]
    return np.einsum("mk,mki->mi", weights, carried)


def point_to_plane(file, term):
    pairs = file["correspondences"]
    root = np.sqrt(pairs["confidence"][:]).astype(float)  # Single precision.
    away = warp(pairs, file["graph"]) - pairs["target"][:]
    distance = np.einsum("mi,mi->m", pairs["warped_normal"][:].astype(float), away)
    count = pairs["confidence"][:].sum(dtype=float)
    return energy((root * distance) ** 2, count, term)


def projective_depth(file, term):
    pairs = file["correspondences"]
    root = np.sqrt(pairs["confidence"][:]).astype(float)  # Single precision.
    normal = pairs["target_normal"][:].astype(float)
    x = warp(pairs, file["graph"])
    plane = np.einsum("mi,mi->m", normal, pairs["target"][:].astype(float))
    away = x[:, 2] * (1 - plane / np.einsum("mi,mi->m", normal, x))
    count = pairs["confidence"][:].sum(dtype=float)
    return energy((root * away) ** 2, count, term)


def arap(file, term):
    i, j = file["edges/nodes"][:].T
    graph = file["graph"]
    g = graph["position"][:]
    center = g + graph["translation"][:]
    turned = np.einsum("eij,ej->ei", graph["rotation"][:][i], g[i] - g[j])
    residual = center[i] - center[j] - turned
    return energy(np.sum(residual**2, axis=1), max(1, len(i)), term)


def main(path):
    with h5py.File(path, "r") as file:
        text = file.attrs["energy"]
        text = text.decode() if isinstance(text, bytes) else text
        print(f"frame {file.attrs['frame']}, surface {file.attrs['surface']}: "
              f"{len(file['graph/position'])} nodes, "
              f"{len(file['correspondences/point'])} pairs")
        own = file["terms/start_cost"][:]
        evaluate = {"point_to_plane": point_to_plane,
                    "projective_depth": projective_depth, "arap": arap}
        for k, (name, keys) in enumerate(re.findall(r"(\w+)\(([^)]*)\)", text)):
            line = f"{name}: {own[k]:.12g}"
            if name in evaluate:
                term = dict(pair.split("=") for pair in keys.split(","))
                line += f", here {evaluate[name](file, term):.12g}"
            print(line)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
