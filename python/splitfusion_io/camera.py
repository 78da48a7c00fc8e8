"""Intrinsics of the depth camera, and where a colour camera stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .errors import PathLike, refuse
from .files import read_numbers
from .trajectory import rigid, rotation_of


@dataclass
class Camera:
    """A pinhole camera; pixel (0, 0) is the centre of the first one."""

    fx: float  #: Pixels.
    fy: float  #: Pixels.
    cx: float  #: Pixels.
    cy: float  #: Pixels.
    width: int  #: Pixels; 0 where a file does not tell.
    height: int  #: Pixels; 0 where a file does not tell.
    depth_scale: float  #: Units of the depth image in a metre; 0: not told.

    def project(self, points: np.ndarray) -> np.ndarray:
        """Points (N x 3, camera frame, metres) to pixels (N x 2: u right, v
        down); NaN behind the camera."""
        z = np.where(points[:, 2] > 0, points[:, 2], np.nan)
        u = self.fx * points[:, 0] / z + self.cx
        return np.stack([u, self.fy * points[:, 1] / z + self.cy], axis=1)

    def unproject(self, pixels: np.ndarray, depth: np.ndarray) -> np.ndarray:
        """Pixels (N x 2) with depth (N, metres along the optical axis) to
        points (N x 3, camera frame, metres)."""
        x = (pixels[:, 0] - self.cx) / self.fx * depth
        y = (pixels[:, 1] - self.cy) / self.fy * depth
        return np.stack([x, y, np.asarray(depth, float)], axis=1)


@dataclass
class ColorCamera:
    """A colour camera beside the depth camera."""

    camera: Camera  #: fx, fy, cx and cy alone.
    color_from_depth: np.ndarray  #: 4 x 4, metres.


def _one_line(path: PathLike, count: int, meaning: str) -> list[float]:
    rows = read_numbers(path, count, meaning)
    if len(rows) != 1:
        refuse(path, f"{len(rows)} lines", f"one line: {meaning}")
    return [float(value) for value in rows[0]]


def read_calibration(path: PathLike) -> Camera:
    """Reads `calibration.txt`."""
    meaning = "fx fy cx cy width height depth_scale"
    v = _one_line(path, 7, meaning)
    if v[0] <= 0 or v[1] <= 0 or v[4] < 1 or v[5] < 1 or v[6] <= 0:
        refuse(path, " ".join(f"{x:g}" for x in v), meaning + ", above 0")
    return Camera(v[0], v[1], v[2], v[3], int(v[4]), int(v[5]), v[6])


def read_color_camera(path: PathLike) -> ColorCamera:
    """Reads `color_camera.txt`."""
    v = _one_line(path, 11, "fx fy cx cy tx ty tz qx qy qz qw")
    camera = Camera(v[0], v[1], v[2], v[3], 0, 0, 0.0)
    quaternion, translation = np.array(v[7:]), np.array(v[4:7])
    if not np.linalg.norm(quaternion) > 1e-6:
        refuse(path, "a quaternion of zeros", "a rotation")
    return ColorCamera(
        camera, rigid(rotation_of(quaternion[None])[0], translation)
    )
