"""Reads what the SplitFusion toolkit writes; docs/python.md of the toolkit.

>>> run = Run("RUN")
>>> run.trajectory.positions                # N x 3, metres
>>> person = run.surface(1)
>>> person.warp(person.mesh.vertices, 30)   # camera frame of frame 30
"""

from .batch import Batch, read_solvers
from .camera import Camera, ColorCamera, read_calibration, read_color_camera
from .errors import RunError
from .files import FORMAT_VERSION, Table, read_csv, read_json, read_json_lines
from .graph import Graph, Motions, Part, read_graph, read_motions
from .hdf5 import Hdf5File, read_hdf5
from .ply import Mesh, read_ply
from .png import read_png
from .run import Run, RunFile, read_options
from .surface import Attachment, Surface
from .trajectory import (
    Trajectory,
    TrajectoryErrors,
    read_trajectory,
    trajectory_errors,
)
from .warp import Skinning, WarpField, nearest, skin

__version__ = "0.1.0"

__all__ = [
    "Attachment",
    "Batch",
    "Camera",
    "ColorCamera",
    "FORMAT_VERSION",
    "Graph",
    "Hdf5File",
    "Mesh",
    "Motions",
    "Part",
    "Run",
    "RunError",
    "RunFile",
    "Skinning",
    "Surface",
    "Table",
    "Trajectory",
    "TrajectoryErrors",
    "WarpField",
    "nearest",
    "read_calibration",
    "read_color_camera",
    "read_csv",
    "read_graph",
    "read_hdf5",
    "read_json",
    "read_json_lines",
    "read_motions",
    "read_options",
    "read_ply",
    "read_png",
    "read_solvers",
    "read_trajectory",
    "skin",
    "trajectory_errors",
]
