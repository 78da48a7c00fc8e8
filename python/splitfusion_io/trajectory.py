"""Camera poses over time: TUM text, alignment, errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .errors import PathLike, refuse
from .files import read_numbers

#: Poses are the same moment if their time stamps are no farther apart, seconds.
MAX_TIME_DIFFERENCE = 0.02


def rotation_of(quaternions: np.ndarray) -> np.ndarray:
    """Rotations of quaternions: N x 4 (x, y, z, w, any length but 0) to
    N x 3 x 3."""
    q = quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)
    x, y, z, w = q.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def rigid(rotation: np.ndarray, translation: np.ndarray) -> np.ndarray:
    """The 4 x 4 matrix of a rotation (3 x 3) and a translation (3, metres)."""
    matrix = np.eye(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = translation
    return matrix


@dataclass
class Trajectory:
    """Poses of a camera."""

    timestamps: np.ndarray  #: N float64, seconds.
    #: N x 4 x 4 float64, world from camera: maps points of the camera frame
    #: (x right, y down, z forward, metres) into the world.
    world_from_camera: np.ndarray

    def __len__(self) -> int:
        return len(self.timestamps)

    @property
    def positions(self) -> np.ndarray:
        """Places of the camera in the world, N x 3, metres."""
        return self.world_from_camera[:, :3, 3]


def read_trajectory(path: PathLike) -> Trajectory:
    """Reads TUM text: lines `timestamp tx ty tz qx qy qz qw`, ascending."""
    meaning = "timestamp tx ty tz qx qy qz qw"
    rows = read_numbers(path, 8, meaning)
    if (np.diff(rows[:, 0]) <= 0).any():
        at = int(np.argmax(np.diff(rows[:, 0]) <= 0)) + 1
        refuse(f"{path}: timestamp", rows[at, 0], "ascending time stamps")
    if (np.linalg.norm(rows[:, 4:], axis=1) < 1e-6).any():
        refuse(path, "a quaternion of zeros", meaning)
    poses = np.tile(np.eye(4), (len(rows), 1, 1))
    poses[:, :3, :3] = rotation_of(rows[:, 4:])
    poses[:, :3, 3] = rows[:, 1:4]
    return Trajectory(rows[:, 0], poses)


def match(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Indices of the time stamps (seconds) of a and b that belong together: the
    nearest ones, at most MAX_TIME_DIFFERENCE apart, each used once."""
    away = np.abs(a[:, None] - b[None, :])
    found: list[tuple[int, int]] = []
    used_a: set[int] = set()
    used_b: set[int] = set()
    i_near, j_near = np.nonzero(away <= MAX_TIME_DIFFERENCE)
    for k in np.argsort(away[i_near, j_near], kind="stable"):
        i, j = int(i_near[k]), int(j_near[k])
        if i not in used_a and j not in used_b:
            found.append((i, j))
            used_a.add(i)
            used_b.add(j)
    pairs = np.array(sorted(found), dtype=int).reshape(-1, 2)
    return pairs[:, 0], pairs[:, 1]


def align(source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """The rigid motion (4 x 4, no scale) that brings the points `source` to
    `target` (both N x 3, metres) in the sense of least squares."""
    a, b = source.mean(axis=0), target.mean(axis=0)
    u, _, vt = np.linalg.svd((target - b).T @ (source - a))
    sign = np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))])
    rotation = u @ sign @ vt
    return rigid(rotation, b - rotation @ a)


@dataclass
class TrajectoryErrors:
    """Errors of a trajectory against a true one."""

    indices: np.ndarray  #: M, poses of the estimate that were compared.
    errors: np.ndarray  #: M, metres: distances after the alignment.
    truth_from_estimate: np.ndarray  #: 4 x 4, the alignment of the worlds.

    @property
    def ate(self) -> float:
        """Root mean square of the errors, metres: the ATE of `sf_evaluate`."""
        return float(np.sqrt(np.mean(self.errors**2)))


def trajectory_errors(
    estimate: Trajectory, truth: Trajectory
) -> TrajectoryErrors:
    """Absolute trajectory errors, as docs/evaluation.md defines them."""
    i, j = match(estimate.timestamps, truth.timestamps)
    if len(i) < 3:
        refuse(
            "poses of the same time stamps",
            len(i),
            f"3 or more, at most {MAX_TIME_DIFFERENCE} s apart",
        )
    source, target = estimate.positions[i], truth.positions[j]
    motion = align(source, target)
    moved = source @ motion[:3, :3].T + motion[:3, 3]
    return TrajectoryErrors(i, np.linalg.norm(moved - target, axis=1), motion)
