"""Runs of every preset that are made here: SPLITFUSION_BIN is the folder of
the programs. What is read agrees with what the programs say themselves."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import splitfusion_io as sf

BIN = os.environ.get("SPLITFUSION_BIN", "")
#: Files that are named, not read.
NAMED_ONLY = {"volume", "checkpoint", "page"}


def call(program, *arguments):
    """A program of the toolkit; its exit status, and what it said."""
    command = [str(Path(BIN) / program), *map(str, arguments)]
    result = subprocess.run(
        command, capture_output=True, text=True, check=False
    )
    return result.returncode, result.stdout + result.stderr


def presets(folder):
    """All presets, as sf_run lists them where there is none of the name."""
    _, text = call(
        "sf_run",
        f"--sequence={folder}",
        f"--output={folder}/none",
        "--preset=?",
    )
    return text.split("expected ")[1].strip().split(", ")


def missing(module):
    """Whether a module of Python cannot be imported."""
    try:
        __import__(module)
    except ImportError:
        return True
    return False


@unittest.skipUnless(BIN, "SPLITFUSION_BIN is not set")
class Runs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.sequence = cls.folder / "sequence"
        cls.make(
            "sf_synth",
            "--width=160",
            "--height=120",
            "--frames=4",
            f"--output={cls.sequence}",
            "--mesh_every=2",
            "--track_points=20",
        )
        cls.presets = presets(cls.sequence)
        for preset in cls.presets:
            more = [f"--preset={preset}", "--pictures_every=0"]
            if preset == "splitfusion":
                more = [
                    "--covariance=2",
                    "--freeze=2",
                    "--full_report",
                    "--checkpoint_every=2",
                    "--keep_checkpoints",
                    "--pictures_every=3",
                ]
            cls.make(
                "sf_run",
                f"--sequence={cls.sequence}",
                "--warped_every=1",
                "--background_voxel=0.02",
                f"--output={cls.folder / preset}",
                *more,
            )
        cls.run_folder = cls.folder / "splitfusion"
        cls.make(
            "sf_evaluate",
            f"--run={cls.run_folder}",
            "--samples=2000",
            f"--ground_truth={cls.sequence}",
        )

    @classmethod
    def make(cls, *command):
        status, text = call(*command)
        if status != 0:
            raise AssertionError(f"{command}: {text}")

    def test_warps_are_those_of_the_run(self):
        compared = {}
        for preset in self.presets:
            run = sf.Run(self.folder / preset)
            compared[preset] = 0
            for surface in run.surfaces.values():
                for frame in surface.warped_frames:
                    with self.subTest(preset=preset, frame=frame):
                        expected = surface.warped(frame)
                        found = surface.mesh_at(frame)
                        away = np.abs(found.vertices - expected.vertices)
                        self.assertLess(away.max(), 1e-5)
                        turned = np.abs(found.normals - expected.normals)
                        self.assertLess(turned.max(), 1e-4)
                        np.testing.assert_array_equal(
                            found.triangles, expected.triangles
                        )
                        compared[preset] += 1
        # A rigid background alone has no warped meshes.
        for preset in ("splitfusion", "online", "cofusion", "dynamicfusion"):
            self.assertGreaterEqual(compared[preset], 4, preset)

    def test_every_file_has_a_kind_and_is_read(self):
        for preset in self.presets:
            run = sf.Run(self.folder / preset)
            for file in run.files():
                with self.subTest(preset=preset, path=file.path):
                    self.assertNotEqual(file.kind, "")
                    if file.kind in NAMED_ONLY:
                        self.assertRaises(sf.RunError, run.read, file.path)
                    elif not (file.path.endswith(".h5") and missing("h5py")):
                        self.assertIsNotNone(run.read(file.path))

    def test_what_is_read_agrees(self):
        run = sf.Run(self.run_folder)
        summary = run.summary
        self.assertEqual(len(run.frames), summary["frames"])
        self.assertEqual(len(run.trajectory), summary["frames"])
        truth = sf.read_trajectory(self.sequence / "gt" / "groundtruth.txt")
        found = sf.trajectory_errors(run.trajectory, truth)
        self.assertAlmostEqual(
            found.ate, run.evaluation["ate"]["rmse"], places=9
        )
        for item in summary["surfaces"]:
            surface = run.surface(item["id"])
            self.assertEqual(len(surface.graph), item["nodes"])
            self.assertEqual(len(surface.mesh.vertices), item["vertices"])
        frames, nodes = run.series(1, "nodes")
        self.assertEqual(list(frames), [f["frame"] for f in run.frames])
        self.assertGreater(nodes[-1], 1)
        self.assertEqual(run.mask(0).shape, (120, 160))
        self.assertIn(1, run.mask(0))
        self.assertEqual(run.picture(0, "input").shape, (120, 160, 3))
        self.assertGreater(run.uncertainty(2, 1).extra["sigma"].min(), 0)
        self.assertEqual(
            len(run.iterations),
            sum(
                r["solver"]["iterations"]
                for f in run.frames
                for s in f["surfaces"]
                for r in s["rounds"]
            ),
        )

    def test_points_ride_on_the_surface(self):
        run = sf.Run(self.run_folder)
        surface = run.surface(1)
        mesh = surface.mesh_at(1)
        vertices = mesh.triangles[::40, 0]
        points = mesh.vertices[vertices] + 0.002 * mesh.normals[vertices]
        tied = surface.attach(points, 1)
        self.assertLess(tied.distances.max(), 0.0021)
        np.testing.assert_allclose(surface.follow(tied, 1), points, atol=1e-6)
        away = surface.follow(tied, 3) - surface.vertices_at(3)[tied.vertices]
        np.testing.assert_allclose(
            np.linalg.norm(away, axis=1), tied.distances, atol=1e-6
        )

    def test_bad_arguments_are_named(self):
        run = sf.Run(self.run_folder)
        for part, ask in (
            ("surface: 9: expected one of 0, 1", lambda: run.surface(9)),
            ("frame: 99: expected", lambda: run.surface(1).field(99)),
            ("frame: 99: expected", lambda: run.world_from_camera(99)),
            ("no run.json", lambda: sf.Run(self.folder)),
            (
                "volume: expected a kind that is read",
                lambda: run.read("surfaces/000_background/tsdf.vdb"),
            ),
        ):
            with self.assertRaises(sf.RunError) as caught:
                ask()
            self.assertIn(part, str(caught.exception))

    def module(self, *arguments):
        root = Path(sf.__file__).resolve().parents[1]
        return subprocess.run(
            [sys.executable, "-m", "splitfusion_io", *map(str, arguments)],
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, "PYTHONPATH": str(root)},
        )

    def test_the_overview(self):
        result = self.module(self.run_folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("preset splitfusion, 160 x 120 pixels", result.stdout)
        self.assertIn("1 person          non_rigid       4", result.stdout)
        self.assertIn("2 volume", result.stdout)
        result = self.module(self.folder / "sequence")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr.count("\n"), 1)

    def test_a_newer_run_is_refused(self):
        newer = self.folder / "newer"
        newer.mkdir()
        marker = json.loads((self.run_folder / "run.json").read_text())
        marker["format_version"] = 2
        (newer / "run.json").write_text(json.dumps(marker))
        result = self.module(newer)
        self.assertEqual(result.returncode, 2)
        self.assertIn("'format_version': 2: expected at most 1", result.stderr)

    @unittest.skipIf(missing("matplotlib"), "matplotlib is not installed")
    def test_plots(self):
        plots = self.folder / "plots"
        truth = self.sequence / "gt" / "groundtruth.txt"
        result = self.module(
            self.run_folder, f"--plots={plots}", f"--truth={truth}"
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        names = {path.name for path in plots.iterdir()}
        self.assertLessEqual(
            {
                "trajectory.png",
                "errors.png",
                "costs_001.png",
                "counts_001.png",
                "convergence_001.png",
            },
            names,
        )
        for path in plots.iterdir():
            self.assertGreater(sf.read_png(path).std(), 1)

    @unittest.skipIf(missing("matplotlib"), "matplotlib is not installed")
    def test_examples(self):
        root = Path(sf.__file__).resolve().parents[1]
        for name in ("look_at_a_run.py", "follow_points.py"):
            result = subprocess.run(
                [sys.executable, root / "examples" / name, self.run_folder],
                capture_output=True,
                text=True,
                check=False,
                cwd=self.folder,
                env={
                    **os.environ,
                    "PYTHONPATH": str(root),
                    "MPLBACKEND": "Agg",
                },
            )
            self.assertEqual(result.returncode, 0, result.stderr)
        rows = sf.read_csv(self.folder / "followed_points.csv")
        self.assertEqual(len(rows), 12 * len(sf.Run(self.run_folder).frames))
        self.assertFalse(np.isnan(rows["x"]).any())

    def test_hidden_deviations(self):
        sequence = self.folder / "longer"
        run_folder = self.folder / "sampled"
        self.make(
            "sf_synth",
            "--width=160",
            "--height=120",
            "--frames=12",
            f"--output={sequence}",
            "--track_points=400",
        )
        self.make(
            "sf_run",
            f"--sequence={sequence}",
            f"--output={run_folder}",
            "--pictures_every=0",
            "--refine_samples=2",
        )
        table = sf.Run(run_folder).read("hidden_deviations.csv")
        self.assertEqual(
            table.names, ["surface", "frame", "node", "sigma"]
        )
        self.assertTrue((table["sigma"] > 0).all())
        root = Path(sf.__file__).resolve().parents[1]
        result = subprocess.run(
            [
                sys.executable,
                root / "examples" / "hidden_deviations.py",
                run_folder,
                sequence,
                "0,6",
            ],
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, "PYTHONPATH": str(root)},
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("rank correlation", result.stdout)


if __name__ == "__main__":
    unittest.main()
