"""The scripts of tools/reproduce on stand-ins: folders in the layouts of the
data sets that are made of a synthetic sequence. SPLITFUSION_BIN is the folder
of the programs."""

import json
import os
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib
from pathlib import Path

import numpy as np

import splitfusion_io as sf

BIN = os.environ.get("SPLITFUSION_BIN", "")
SCRIPTS = Path(__file__).resolve().parents[2] / "tools" / "reproduce"
#: Less to compute.
COARSE = "--background_voxel=0.02"


def write_png(path, image):
    """A PNG file of a 16-bit image."""
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in image)
    size = struct.pack(">IIBBBBB", *image.shape[::-1], 16, 0, 0, 0, 0)
    data = b"\x89PNG\r\n\x1a\n"
    for kind, body in (
        (b"IHDR", size),
        (b"IDAT", zlib.compress(rows)),
        (b"IEND", b""),
    ):
        data += struct.pack(">I", len(body)) + kind + body
        data += struct.pack(">I", zlib.crc32(kind + body))
    path.write_bytes(data)


@unittest.skipUnless(BIN, "SPLITFUSION_BIN is not set")
class Reproduce(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.sequence = cls.folder / "rgbd_test"
        program = [str(Path(BIN) / "sf_synth"), "--width=160", "--height=120"]
        more = ["--frames=3", "--track_points=5", "--scene=room"]
        subprocess.run(
            [*program, *more, f"--output={cls.sequence}"],
            check=True,
            capture_output=True,
        )
        cls.camera = sf.read_calibration(cls.sequence / "calibration.txt")
        cls.stamps = sorted(p.stem for p in cls.sequence.glob("depth/*.png"))

    def call(self, script, *arguments):
        """Status, lines of stdout that are rows, and stderr."""
        result = subprocess.run(
            [str(SCRIPTS / script), *map(str, arguments)],
            capture_output=True,
            text=True,
            check=False,
        )
        rows = [
            [cell.strip() for cell in line.strip("|").split("|")]
            for line in result.stdout.splitlines()
            if line.startswith("|")
        ]
        return result.returncode, rows, result.stderr

    def row(self, *call):
        """The one row of the table that a script prints, by its heading."""
        status, rows, errors = self.call(*call)
        self.assertEqual(status, 0, errors)
        self.assertEqual(len(rows), 3)
        return dict(zip(rows[0], rows[2]))

    def depth_mm(self, stamp):
        image = sf.read_png(self.sequence / "depth" / f"{stamp}.png")
        return image.astype(float) * 1000 / self.camera.depth_scale

    def matrix(self):
        c = self.camera
        return f"{c.fx} 0 {c.cx} 0\n0 {c.fy} {c.cy} 0\n0 0 1 0\n0 0 0 1\n"

    def test_layout_of_tum_and_bonn(self):
        row = self.row(
            "tum.sh", self.sequence, f"--output={self.folder}/tum", COARSE
        )
        self.assertEqual(row["frames"], "3")
        self.assertLess(float(row["ATE mm"]), 20)
        self.assertEqual(row["paper's ATE mm"], "-")
        bonn = self.folder / "rgbd_bonn_test"
        shutil.copytree(self.sequence, bonn)
        c = self.camera
        (bonn / "camera.txt").write_text(
            f"width {c.width}\nheight {c.height}\nfx {c.fx}\nfy {c.fy}\n"
            f"cx {c.cx}\ncy {c.cy}\ndepth_scale {c.depth_scale}\n"
        )
        other = self.row(
            "bonn.sh", bonn, f"--output={self.folder}/bonn", COARSE
        )
        self.assertEqual(other["ATE mm"], row["ATE mm"])

    def test_layout_of_volumedeform(self):
        folder = self.folder / "boxing"
        (folder / "data").mkdir(parents=True)
        (folder / "depthIntrinsics.txt").write_text(self.matrix())
        for i, stamp in enumerate(self.stamps):
            name = folder / "data" / f"frame-{i:06}"
            color = self.sequence / "rgb" / f"{stamp}.png"
            shutil.copy(color, f"{name}.color.png")
            write_png(Path(f"{name}.depth.png"), self.depth_mm(stamp))
        output = f"--output={self.folder}/volumedeform"
        row = self.row("volumedeform.sh", folder, output, COARSE)
        self.assertEqual((row["frames"], row["ATE mm"]), ("3", "-"))
        self.assertLess(float(row["depth mm"]), 25)

    def deepdeform(self):
        """A stand-in whose annotations are the motion of the camera."""
        folder = self.folder / "train" / "seq007"
        for name in ("color", "depth", "scene_flow"):
            (folder / name).mkdir(parents=True)
        (folder / "intrinsics.txt").write_text(self.matrix())
        depths = []
        for i, stamp in enumerate(self.stamps):
            # Not JPEG by its content, which is what readers go by.
            color = self.sequence / "rgb" / f"{stamp}.png"
            shutil.copy(color, folder / "color" / f"{i:06}.jpg")
            depths.append(np.round(self.depth_mm(stamp)) / 1000)
            write_png(folder / "depth" / f"{i:06}.png", 1000 * depths[-1])
        truth = sf.read_trajectory(self.sequence / "gt" / "groundtruth.txt")
        pose = truth.world_from_camera
        motion = np.linalg.inv(pose[2]) @ pose[0]
        v, u = np.mgrid[:120, :160]
        pixels = np.stack([u.ravel(), v.ravel()], axis=1)
        points = self.camera.unproject(pixels, depths[0].ravel())
        moved = points @ motion[:3, :3].T + motion[:3, 3]
        flow = (moved - points).reshape(120, 160, 3).astype("<f4")
        flow[depths[0] == 0] = -np.inf
        (folder / "scene_flow" / "room_000000_000002.sflow").write_bytes(
            struct.pack("<3I", 160, 120, 3) + np.moveaxis(flow, 2, 0).tobytes()
        )
        some = np.flatnonzero(points[:, 2] > 0)[::97]
        ends = self.camera.project(moved)
        matches = [
            dict(zip(("source_x", "source_y", "target_x", "target_y"), values))
            for values in np.hstack([pixels[some], ends[some]]).tolist()
        ]
        item = {"seq_id": "007", "object_id": "room", "matches": matches}
        item.update(source_id="000000", target_id="000002")
        other = {**item, "seq_id": "008"}
        place = self.folder / "train_matches.json"
        place.write_text(json.dumps([other, item]))
        return folder, int((depths[0] > 0).sum())

    def test_layout_and_metric_of_deepdeform(self):
        folder, points = self.deepdeform()
        output = f"--output={self.folder}/deepdeform"
        status, rows, errors = self.call(
            "deepdeform.sh", folder, output, COARSE
        )
        self.assertEqual(status, 0, errors)
        self.assertEqual(len(rows), 4)
        flow, matches = (dict(zip(rows[0], row)) for row in rows[2:])
        self.assertEqual((flow["by"], matches["by"]), ("flow", "matches"))
        self.assertEqual(int(flow["points"]), points)
        self.assertGreater(float(flow["tied %"]), 60)
        # The error of the camera, which evaluation.json knows as well.
        self.assertLess(float(flow["error mm"]), 40)
        self.assertLess(abs(float(matches["median mm"])), 40)

    def test_bad_folders_are_named(self):
        output = f"--output={self.folder}/none"
        for script in ("tum.sh", "bonn.sh", "volumedeform.sh", "deepdeform.sh"):
            for arguments in ([self.folder / "gone", output], [output], ["/"]):
                status, _, errors = self.call(script, *arguments)
                self.assertEqual(status, 2, errors)
                self.assertEqual(errors.count("\n"), 1)
                self.assertIn("expected", errors)


if __name__ == "__main__":
    unittest.main()
