"""Readers on files that are made here: values by hand, and bad input."""

import json
import struct
import tempfile
import unittest
import zlib
from pathlib import Path

import numpy as np

import splitfusion_io as sf


class Files(unittest.TestCase):
    """A folder for files."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name, data):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(data, str):
            data = data.encode()
        path.write_bytes(data)
        return path

    def refused(self, part, read, *arguments):
        """Expects one line that has `part`."""
        with self.assertRaises(sf.RunError) as caught:
            read(*arguments)
        message = str(caught.exception)
        self.assertNotIn("\n", message)
        self.assertIn(part, message)


class Text(Files):
    def test_versions(self):
        older = self.write("a.json", '{"x": 1}')
        now = self.write("b.json", '{"format_version": 1}')
        newer = self.write("c.json", '{"format_version": 2}')
        none = self.write("d.json", '{"format_version": "x"}')
        self.assertEqual(sf.read_json(older), {"x": 1})
        self.assertEqual(sf.read_json(now)["format_version"], 1)
        self.refused(
            "c.json: field 'format_version': 2: expected at most 1",
            sf.read_json,
            newer,
        )
        self.refused(
            "'format_version': x: expected a whole", sf.read_json, none
        )

    def test_broken_json(self):
        for text in ("", "[1]", '{"x": NaN}', '{"x"', "[" * 100000):
            path = self.write("a.json", text)
            self.refused("a.json: ", sf.read_json, path)
        self.refused(
            "none.json: cannot be opened",
            sf.read_json,
            self.folder / "none.json",
        )

    def test_lines_of_json(self):
        path = self.write("a.jsonl", '{"frame": 0}\n{"frame": 1}\n{"fra')
        self.assertEqual(len(sf.read_json_lines(path)), 2)
        path = self.write("a.jsonl", '{"frame": 0}\n7\n')
        self.refused("a.jsonl:2: 7: expected", sf.read_json_lines, path)

    def test_tables(self):
        path = self.write("a.csv", 'n,"x y",v\n"a,b",1,\nc,2.5,3\nd,')
        table = sf.read_csv(path)
        self.assertEqual(table.names, ["n", "x y", "v"])
        self.assertEqual(list(table["n"]), ["a,b", "c"])
        self.assertEqual(table["x y"].sum(), 3.5)
        self.assertTrue(np.isnan(table["v"][0]))
        self.assertEqual(list(table.where(v=3.0)["n"]), ["c"])
        self.refused("column: w: expected one of n", table.__getitem__, "w")
        path = self.write("a.csv", "a,b\n1\n")
        self.refused("a.csv:2: 1 entries: expected 2", sf.read_csv, path)

    def test_cameras(self):
        path = self.write("c.txt", "# fx ...\n500 510 320 240 640 480 5000\n")
        camera = sf.read_calibration(path)
        self.assertEqual((camera.width, camera.depth_scale), (640, 5000))
        points = np.array([[0.1, -0.2, 2.0]])
        pixels = camera.project(points)
        np.testing.assert_allclose(pixels, [[345, 189]])
        np.testing.assert_allclose(
            camera.unproject(pixels, points[:, 2]), points
        )
        path = self.write("c.txt", "500 510 320 240 640 480\n")
        self.refused("c.txt:1: 500 510", sf.read_calibration, path)
        path = self.write("c.txt", "525 525 320 240 -0.02 0 0 0 0 0 1\n")
        color = sf.read_color_camera(path)
        self.assertEqual(color.color_from_depth[0, 3], -0.02)

    def test_trajectories(self):
        # A quarter turn about z: x of the camera is y of the world.
        text = "# t\n1 0 0 0 0 0 0.70710678 0.70710678\n2 1 2 3 0 0 0 1\n"
        found = sf.read_trajectory(self.write("t.txt", text))
        x = found.world_from_camera[0, :3, :3] @ [1, 0, 0]
        np.testing.assert_allclose(x, [0, 1, 0], atol=1e-7)
        np.testing.assert_allclose(found.positions[1], [1, 2, 3])
        self.refused(
            "t.txt: timestamp: 1.0",
            sf.read_trajectory,
            self.write("t.txt", "2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
        )

    def test_errors_of_a_moved_trajectory_are_its_noise_alone(self):
        times = np.arange(4.0)
        poses = np.tile(np.eye(4), (4, 1, 1))
        poses[:, :3, 3] = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
        truth = sf.Trajectory(times, poses.copy())
        turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
        # One up and one down by 2 cm at the corners: no motion mends that.
        poses[:, 2, 3] += [0.02, -0.02, 0.02, -0.02]
        poses[:, :3, 3] = poses[:, :3, 3] @ turn.T + [5, 6, 7]
        found = sf.trajectory_errors(sf.Trajectory(times + 0.01, poses), truth)
        self.assertAlmostEqual(found.ate, 0.02)
        self.refused(
            "3 or more",
            sf.trajectory_errors,
            sf.Trajectory(times + 9, poses),
            truth,
        )


def ply(vertex_lines, vertices, faces):
    head = "ply\nformat binary_little_endian 1.0\n"
    head += f"element vertex {len(vertices)}\n{vertex_lines}"
    head += f"element face {len(faces)}\n"
    head += "property list uchar int vertex_indices\nend_header\n"
    body = b"".join(struct.pack("<" + "f" * len(v), *v) for v in vertices)
    body += b"".join(struct.pack("<Biii", 3, *f) for f in faces)
    return head.encode() + body


XYZ = "property float x\nproperty float y\nproperty float z\n"


class Binary(Files):
    def test_meshes(self):
        data = ply(
            XYZ + "property float sigma\n",
            [(0, 0, 1, 0.5), (1, 0, 1, 0.25), (0, 1, 1, 2)],
            [(0, 1, 2)],
        )
        mesh = sf.read_ply(self.write("a.ply", data))
        np.testing.assert_array_equal(mesh.triangles, [[0, 1, 2]])
        np.testing.assert_array_equal(mesh.vertices[1], [1, 0, 1])
        np.testing.assert_array_equal(mesh.extra["sigma"], [0.5, 0.25, 2])
        self.assertIsNone(mesh.normals)
        self.refused(
            "bytes: expected at least",
            sf.read_ply,
            self.write("a.ply", data[:-1]),
        )
        bad = ply(XYZ, [(0, 0, 1)], [(0, 0, 1)])
        self.refused(
            "vertex 1: expected indices of 1",
            sf.read_ply,
            self.write("a.ply", bad),
        )
        self.refused("header", sf.read_ply, self.write("a.ply", b"nothing"))

    def png(self, filters, rows, bits, color, step):
        """A PNG file whose row i has filter filters[i]."""
        raw, above = b"", bytes(len(rows[0]))
        for kind, row in zip(filters, rows):
            raw += bytes([kind])
            for i, value in enumerate(row):
                a = row[i - step] if i >= step else 0
                b, c = above[i], above[i - step] if i >= step else 0
                p = a + b - c
                near = min((abs(p - x), n, x) for n, x in enumerate((a, b, c)))[
                    2
                ]
                raw += bytes(
                    [(value - (0, a, b, (a + b) // 2, near)[kind]) & 255]
                )
            above = row
        chunks = [
            (
                b"IHDR",
                struct.pack(">IIBBBBB", 2, len(rows), bits, color, 0, 0, 0),
            ),
            (b"IDAT", zlib.compress(raw)),
            (b"IEND", b""),
        ]
        data = b"\x89PNG\r\n\x1a\n"
        for kind, body in chunks:
            data += struct.pack(">I", len(body)) + kind + body
            data += struct.pack(">I", zlib.crc32(kind + body))
        return data

    def test_images_with_every_filter(self):
        rows = np.random.default_rng(1).integers(0, 256, (5, 6), np.uint8)
        data = self.png(range(5), [bytes(r) for r in rows], 8, 2, 3)
        image = sf.read_png(self.write("a.png", data))
        np.testing.assert_array_equal(image, rows.reshape(5, 2, 3))
        data = self.png(range(5), [bytes(r[:4]) for r in rows], 16, 0, 2)
        image = sf.read_png(self.write("a.png", data))
        wide = rows.astype(np.uint16)
        np.testing.assert_array_equal(
            image[:, 0], wide[:, 0] * 256 + wide[:, 1]
        )
        self.refused("whole PNG", sf.read_png, self.write("a.png", data[:-9]))

    def motions(self, version):
        """Two frames of one node; the second is moved by 1 m along y."""
        data = b"SFMOTN%02d" % version + struct.pack("<II", 2, 1)
        for frame, y in ((3, 0.0), (5, 1.0)):
            data += struct.pack("<ii", frame, frame == 3)
            data += struct.pack("<3I", 1, 0, 1) if version >= 4 else b""
            data += struct.pack("<12f", 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, y, 0)
            data += b"\1" if version >= 3 else b""
        if version < 2:
            return data
        try:
            import xxhash
        except ImportError:
            return data + bytes(8)  # Then it is not looked at.
        return data + struct.pack("<Q", xxhash.xxh3_64_intdigest(data))

    def test_motions_of_all_versions(self):
        for version in (1, 2, 3, 4):
            path = self.write("motions.bin", self.motions(version))
            motions = sf.read_motions(path)
            self.assertEqual(list(motions.frames), [3, 5])
            self.assertEqual(list(motions.tracked), [True, False])
            self.assertEqual(motions.translations[1, 0, 1], 1)
            self.assertEqual(motions.seen is None, version < 3)
            self.assertEqual((motions.index(5), motions.index(4)), (1, None))
        newer = self.write("m.bin", b"SFMOTN05" + bytes(20))
        self.refused("m.bin: version: 5: expected 1..4", sf.read_motions, newer)
        short = self.write("m.bin", self.motions(1)[:-1])
        self.refused("bytes: expected", sf.read_motions, short)
        turned = bytearray(self.motions(1))
        turned[24:28] = struct.pack("<f", 2.0)
        self.refused("is damaged", sf.read_motions, self.write("m.bin", turned))

    def test_motions_of_nodes_in_use(self):
        """Two nodes; the first frame has that of the second one alone."""
        data = b"SFMOTN04" + struct.pack("<II", 2, 2)
        moved = struct.pack("<12f", 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 3, 0)
        data += struct.pack("<ii3I", 3, 1, 1, 1, 2) + moved + b"\1"
        data += struct.pack("<ii3I", 5, 1, 1, 0, 2) + 2 * moved + b"\1\0"
        try:
            import xxhash

            data += struct.pack("<Q", xxhash.xxh3_64_intdigest(data))
        except ImportError:
            data += bytes(8)
        motions = sf.read_motions(self.write("motions.bin", data))
        np.testing.assert_array_equal(motions.nodes[0], [1])
        np.testing.assert_array_equal(motions.seen[0], [True])
        np.testing.assert_array_equal(
            motions.translations[:, :, 1], [[0, 3], [3, 3]]
        )
        np.testing.assert_array_equal(motions.at(0)[0][0], np.eye(3))

    def test_bad_graphs_name_the_field(self):
        good = {
            "node_spacing": 0.1,
            "neighbors_per_point": 4,
            "positions": [[0, 0, 1], [0, 0, 2]],
            "edges": [[1], [0]],
        }
        graph = sf.read_graph(self.write("graph.json", json.dumps(good)))
        self.assertEqual(len(graph), 2)
        for key, value in (
            ("node_spacing", -1),
            ("neighbors_per_point", 0),
            ("positions", [[0, 0]]),
            ("positions", []),
            ("edges", [[2], [0]]),
            ("edges", [[1]]),
            ("first_seen", [0]),
            ("parts", [[1, 0, None]]),
        ):
            path = self.write("graph.json", json.dumps({**good, key: value}))
            self.refused(f"field '{key}'", sf.read_graph, path)
        newer = json.dumps({**good, "format_version": 2})
        self.refused("at most 1", sf.read_graph, self.write("g.json", newer))


class Warps(unittest.TestCase):
    def test_weights_by_hand(self):
        # Three nodes on a line; of two neighbours the third sets d_max.
        graph = sf.Graph(
            1.0,
            2,
            np.array([[0.0, 0, 0], [1, 0, 0], [4, 0, 0]]),
            [[1], [0, 2], [1]],
        )
        found = sf.skin(graph, np.array([[0.25, 0, 0]]))
        near, far = (1 - 0.25 / 3.75) ** 2, (1 - 0.75 / 3.75) ** 2
        np.testing.assert_array_equal(found.nodes, [[0, 1]])
        np.testing.assert_allclose(
            found.weights,
            [[near / (near + far), far / (near + far)]],
            rtol=1e-6,
        )

    def test_a_rigid_motion_moves_all_points_alike(self):
        graph = sf.Graph(0.0, 4, np.array([[0.5, 0, 0]]), [[]])
        turn = np.array([[[0, -1, 0], [1, 0, 0], [0, 0, 1]]], np.float32)
        field = sf.WarpField(graph, turn, np.array([[0, 0, 2]], np.float32))
        points = np.array([[1.5, 0, 0], [0.5, 1, 0]])
        skinning = sf.skin(graph, points)
        np.testing.assert_allclose(
            field.points(skinning, points),
            [[0.5, 1, 2], [-0.5, 0, 2]],
            atol=1e-7,
        )
        np.testing.assert_allclose(
            field.normals(skinning, np.eye(3)[:2]),
            [[0, 1, 0], [-1, 0, 0]],
            atol=1e-7,
        )

    def test_the_nearest_of_many(self):
        random = np.random.default_rng(2)
        targets = random.random((300, 3), np.float32)
        queries = random.random((2000, 3), np.float32) * 3 - 1
        away = ((queries[:, None] - targets[None]) ** 2).sum(axis=2)
        np.testing.assert_array_equal(
            sf.nearest(queries, targets), away.argmin(axis=1)
        )

    def test_parts_are_in_use_in_their_frames(self):
        graph = sf.Graph(
            0.1,
            4,
            np.zeros((3, 3)),
            [[], [], []],
            parts=[sf.Part(0, 0, 5), sf.Part(2, 5, None)],
        )
        self.assertEqual(list(graph.in_use(4)), [True, True, False])
        self.assertEqual(list(graph.in_use(5)), [False, False, True])


if __name__ == "__main__":
    unittest.main()
