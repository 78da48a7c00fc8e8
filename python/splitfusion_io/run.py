"""The folder of a run."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path, PurePosixPath
from typing import Any, Optional

import numpy as np

from .camera import Camera, ColorCamera, read_calibration, read_color_camera
from .errors import PathLike, RunError, refuse
from .files import (
    Table,
    read_csv,
    read_json,
    read_json_lines,
    read_text,
)
from .graph import read_graph, read_motions
from .hdf5 import read_hdf5
from .ply import Mesh, read_ply
from .png import read_png
from .surface import Surface
from .trajectory import Trajectory, read_trajectory

#: Kinds of files by pattern of their path below the run, and what reads them;
#: None: files that are named only. The first pattern that fits counts.
_KINDS: list[tuple[str, str, Any]] = [
    ("run.json", "marker", read_json),
    ("summary.json", "summary", read_json),
    ("evaluation.json", "evaluation", read_json),
    ("calibration.txt", "calibration", read_calibration),
    ("color_camera.txt", "colour camera", read_color_camera),
    ("trajectory.txt", "trajectory", read_trajectory),
    ("options.flags", "options", None),
    ("frames.jsonl", "frames", read_json_lines),
    ("refinement.jsonl", "refinement", read_json_lines),
    ("hidden_deviations.csv", "hidden deviations", read_csv),
    ("iterations.csv", "iterations", read_csv),
    ("surfaces/*/mesh.ply", "mesh", read_ply),
    ("surfaces/*/warped/*.ply", "warped mesh", read_ply),
    ("surfaces/*/graph.json", "graph", read_graph),
    ("surfaces/*/motions.bin", "motions", read_motions),
    ("surfaces/*/residuals.h5", "residuals", read_hdf5),
    ("surfaces/*/tsdf.vdb", "volume", None),
    ("uncertainty/*.ply", "uncertainty", read_ply),
    ("problems/*.h5", "frozen problem", read_hdf5),
    ("solver/*.txt", "solver report", read_text),
    ("masks/*.png", "mask", read_png),
    ("pictures/*.png", "picture", read_png),
    ("detections/overlaps/*.png", "detection", read_png),
    ("detections/*.png", "detection", read_png),
    ("detections/*.jsonl", "detections", read_json_lines),
    ("detections/*.json", "detections", read_json),
    ("checkpoints/*.bin", "checkpoint", None),
    ("checkpoint.bin", "checkpoint", None),
    ("report.html", "page", None),
]


@dataclass
class RunFile:
    """A file of a run."""

    path: str  #: Below the folder of the run.
    kind: str  #: As in docs/python.md; empty: none of a run.
    bytes: int  #: Size.


def _kind_of(path: str) -> tuple[str, Any]:
    for pattern, kind, reader in _KINDS:
        parts = pattern.count("/") + 1
        if path.count("/") + 1 == parts and PurePosixPath(path).match(pattern):
            return kind, reader
    return "", None


def read_options(path: PathLike) -> dict[str, str]:
    """Reads a flagfile: options without the dashes, name -> text."""
    options = {}
    for number, line in enumerate(read_text(path).splitlines(), start=1):
        if not line.strip() or line.startswith("#"):
            continue
        name, equals, value = line.partition("=")
        if not name.startswith("--"):
            refuse(f"{path}:{number}", line, "--OPTION=VALUE")
        options[name[2:]] = value if equals else "true"
    return options


class Run:
    """What `sf_run --output=RUN` wrote. Files are read when they are needed."""

    def __init__(self, folder: PathLike) -> None:
        """RunError if the folder is none of a run."""
        self.folder = Path(folder)
        known = any(
            (self.folder / name).is_file()
            for name in ("run.json", "trajectory.txt")
        )
        if not known:
            raise RunError(
                f"{folder}: has no run.json: expected the folder of a run"
            )
        if (self.folder / "run.json").is_file():
            read_json(self.folder / "run.json")  # Of a version that is known.

    def __repr__(self) -> str:
        return f"Run({str(self.folder)!r})"

    @cached_property
    def marker(self) -> dict[str, Any]:
        """`run.json`: status, identity, files; empty of runs without it."""
        path = self.folder / "run.json"
        return read_json(path) if path.is_file() else {}

    @cached_property
    def summary(self) -> dict[str, Any]:
        """`summary.json`."""
        return read_json(self.folder / "summary.json")

    @cached_property
    def evaluation(self) -> Optional[dict[str, Any]]:
        """`evaluation.json`; None: the run was not evaluated."""
        path = self.folder / "evaluation.json"
        return read_json(path) if path.is_file() else None

    @cached_property
    def camera(self) -> Camera:
        """Intrinsics of the depth images: `calibration.txt`."""
        return read_calibration(self.folder / "calibration.txt")

    @cached_property
    def color_camera(self) -> Optional[ColorCamera]:
        """`color_camera.txt`; None: colour is registered to depth."""
        path = self.folder / "color_camera.txt"
        return read_color_camera(path) if path.is_file() else None

    @cached_property
    def options(self) -> dict[str, str]:
        """`options.flags`: name -> text."""
        return read_options(self.folder / "options.flags")

    @cached_property
    def trajectory(self) -> Trajectory:
        """Poses of the camera, world from camera, one a frame."""
        return read_trajectory(self.folder / "trajectory.txt")

    @cached_property
    def frames(self) -> list[dict[str, Any]]:
        """`frames.jsonl`: one object a frame (docs/report_format.md)."""
        path = self.folder / "frames.jsonl"
        frames = read_json_lines(path)
        for number, frame in enumerate(frames, start=1):
            if type(frame.get("frame")) is not int:
                refuse(
                    f"{path}:{number}: field 'frame'",
                    frame.get("frame"),
                    "an index",
                )
        return frames

    @cached_property
    def frame_indices(self) -> np.ndarray:
        """Frame index of each line of `frames.jsonl` and pose."""
        return np.array([frame["frame"] for frame in self.frames], dtype=int)

    @cached_property
    def iterations(self) -> Table:
        """`iterations.csv`: one row a solver iteration."""
        return read_csv(self.folder / "iterations.csv")

    @cached_property
    def refinement(self) -> list[dict[str, Any]]:
        """`refinement.jsonl`; empty where nothing was refined."""
        path = self.folder / "refinement.jsonl"
        return read_json_lines(path) if path.is_file() else []

    @cached_property
    def surfaces(self) -> dict[int, Surface]:
        """Surfaces by id; 0 is the background."""
        whole = str(self.marker.get("outputs", {}).get("warped_whole", "false"))
        folders = sorted(
            p for p in self.folder.glob("surfaces/*") if p.is_dir()
        )
        found = [Surface(folder, whole == "true") for folder in folders]
        return {surface.id: surface for surface in found}

    def surface(self, surface_id: int) -> Surface:
        """The surface of an id. RunError if there is none."""
        if surface_id not in self.surfaces:
            known = ", ".join(map(str, self.surfaces)) or "none"
            refuse(f"{self.folder}: surface", surface_id, f"one of {known}")
        return self.surfaces[surface_id]

    def world_from_camera(self, frame: int) -> np.ndarray:
        """The pose of the camera in a frame, 4 x 4, metres."""
        row = np.flatnonzero(self.frame_indices == frame)
        if len(row) == 0 or row[0] >= len(self.trajectory):
            refuse(f"{self.folder}: frame", frame, "a frame of the run")
        return self.trajectory.world_from_camera[row[0]]

    def to_world(self, points: np.ndarray, frame: int) -> np.ndarray:
        """Points (P x 3, camera frame of `frame`) in the world, metres."""
        pose = self.world_from_camera(frame)
        return np.asarray(points, float) @ pose[:3, :3].T + pose[:3, 3]

    def mask(self, frame: int) -> np.ndarray:
        """Surface id of every pixel, height x width uint16; 0: background."""
        return read_png(self.folder / "masks" / f"{self._stem(frame)}.png")

    def picture(self, frame: int, kind: str) -> np.ndarray:
        """A picture, as kind `input` or `composite`: height x width x 3 uint8,
        red, green, blue."""
        return read_png(self.folder / "pictures" / f"{frame:06}_{kind}.png")

    def uncertainty(self, frame: int, surface_id: int) -> Mesh:
        """The mesh (camera frame), with standard deviations in `extra`, m."""
        name = f"{frame:06}_{surface_id:03}.ply"
        return read_ply(self.folder / "uncertainty" / name)

    def series(
        self, surface_id: int, key: str
    ) -> tuple[np.ndarray, np.ndarray]:
        """A number of a surface over time, as `residual_rms`, `nodes` or
        `seconds.solve`: frame indices, and values (NaN where it is none)."""
        found = []
        for frame in self.frames:
            for surface in frame.get("surfaces", []):
                if surface.get("id") == surface_id:
                    found.append((frame["frame"], _number(surface, key)))
        rows = np.array(found).reshape(-1, 2)
        return rows[:, 0].astype(int), rows[:, 1]

    def last_rounds(self, surface_id: int) -> list[tuple[int, dict[str, Any]]]:
        """Frame index and last entry of `rounds` of each frame that has one."""
        found = []
        for frame in self.frames:
            for surface in frame.get("surfaces", []):
                if surface.get("id") == surface_id and surface.get("rounds"):
                    found.append((frame["frame"], surface["rounds"][-1]))
        return found

    def files(self) -> list[RunFile]:
        """All files below the run, by path. Kinds are those of docs/python.md;
        other files have none."""
        found = []
        for path in sorted(self.folder.rglob("*")):
            if path.is_file():
                name = path.relative_to(self.folder).as_posix()
                found.append(
                    RunFile(name, _kind_of(name)[0], path.stat().st_size)
                )
        return found

    def read(self, path: str) -> Any:
        """What a file of `files()` holds, by its kind: an object of this
        package, an array, a dict, a list or text. RunError for files that are
        named only."""
        kind, reader = _kind_of(path)
        if kind == "options":
            return read_options(self.folder / path)
        if reader is None:
            refuse(
                self.folder / path,
                kind or "no file of a run",
                "a kind that is read, see docs/python.md",
            )
        return reader(self.folder / path)

    def _stem(self, frame: int) -> str:
        for item in self.frames:
            if item["frame"] == frame:
                return str(item.get("stem", ""))
        return refuse(f"{self.folder}: frame", frame, "a frame of the run")


def _number(data: dict[str, Any], key: str) -> float:
    """The number under a key with dots; NaN where there is none."""
    value: Any = data
    for part in key.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    good = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if good else float("nan")
