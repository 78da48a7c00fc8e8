"""Holds what sf_export writes for Blender against the warped meshes of the run.

  blender --background --python tests/blender_check.py -- RUN [--glb=FILE]
          [--pc2=FILE] [--frames=N] [--picture=FILE.png --frame=N]

RUN has warped/FRAME.ply. Imports the glTF file, evaluates its meshes in up to
--frames of these frames and prints how far vertices are from warped/, in
millimetres; the same of a point cache, with its OBJ beside it. Both are in the
world, of every frame. A picture is what the imported camera sees. Ends with 1
where a vertex is farther than 0.1 mm, or none was compared.
"""
import argparse
import json
import pathlib
import re
import sys

import bpy
import numpy as np

# Debian 12's Blender imports glTF by a name that its NumPy no longer has.
if 'bool' not in vars(np):
    np.bool = bool

FPS = 30
FARTHEST = 1e-4  # Metres.
COLUMNS = {'float': 'f4', 'uchar': 'u1', 'int': 'i4'}


def read_vertices(path):
    """Vertices of a binary PLY as the run writes it."""
    data = path.read_bytes()
    end = data.index(b'end_header\n') + len(b'end_header\n')
    header = data[:end].decode().split('element face')[0]
    count = int(re.search(r'element vertex (\d+)', header)[1])
    row = np.dtype([(name, '<' + COLUMNS[kind]) for kind, name in
                    re.findall(r'property (\w+) (\w+)\n', header)])
    rows = np.frombuffer(data, row, count, end)
    return np.stack([rows['x'], rows['y'], rows['z']], 1).astype(float)


class Glb:
    """What a glTF file says about the vertices of its meshes."""

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        size = int.from_bytes(data[12:16], 'little')
        self.json = json.loads(data[20:20 + size])
        self.bytes = data[28 + size:]

    def nodes(self):
        """Nodes of meshes, by name."""
        return {node['name']: node for node in self.json['nodes']
                if 'mesh' in node}

    def array(self, accessor, kind):
        accessor = self.json['accessors'][accessor]
        view = self.json['bufferViews'][accessor['bufferView']]
        return np.frombuffer(self.bytes, kind, accessor['count'],
                             view['byteOffset'])

    def sources(self, name):
        """Indices in mesh.ply of the vertices that triangles use: Blender
        leaves the others out."""
        mesh = self.json['meshes'][self.nodes()[name]['mesh']]
        primitive = mesh['primitives'][0]
        sources = self.array(primitive['attributes']['_VERTEX'], '<f4')
        used = np.unique(self.array(primitive['indices'], '<u4'))
        return sources[used].astype(int)


class Run:
    """Poses and warped meshes of a run."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        rows = [[float(word) for word in line.split()] for line in
                (self.folder / 'trajectory.txt').read_text().splitlines()
                if not line.startswith('#')]
        lines = [json.loads(line) for line in
                 (self.folder / 'frames.jsonl').read_text().splitlines()]
        self.start = rows[0][0]
        self.poses = dict(zip([line['frame'] for line in lines], rows))
        self.inactive = {(surface['id'], line['frame']) for line in lines
                         for surface in line['surfaces']
                         if surface['state'] == 'inactive'}

    def time(self, frame):
        return self.poses[frame][0] - self.start

    def warped_frames(self, name):
        """Of a surface, while it is there."""
        warped = self.folder / 'surfaces' / name / 'warped'
        frames = {int(path.stem) for path in warped.glob('*.ply')}
        return sorted(f for f in frames
                      if (int(name[:3]), f) not in self.inactive)

    def world_vertices(self, name, frame):
        _, tx, ty, tz, x, y, z, w = self.poses[frame]
        turn = np.array([
            [w * w + x * x - y * y - z * z, 2 * (x * y - z * w),
             2 * (x * z + y * w)],
            [2 * (x * y + z * w), w * w - x * x + y * y - z * z,
             2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w),
             w * w - x * x - y * y + z * z]])
        path = self.folder / 'surfaces' / name / f'warped/{frame:06d}.ply'
        return read_vertices(path) @ turn.T + [tx, ty, tz]


def go_to(time):
    """To a time in seconds; animations are imported at FPS."""
    frame = time * FPS
    bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))


def evaluated(thing):
    """Vertices as Blender shows them, in the world of the run."""
    shown = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = shown.to_mesh()
    flat = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get('co', flat)
    matrix = np.array(shown.matrix_world)
    shown.to_mesh_clear()
    points = flat.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    # Blender's z is up and its y away; the run's y is down, its z away.
    return np.stack([points[:, 0], -points[:, 2], points[:, 1]], 1)


def surface_name(run, name):
    """Folder of the surface that a mesh is, or is a part of."""
    names = [path.name for path in (run.folder / 'surfaces').iterdir()]
    return max((n for n in names if name.startswith(n)), key=len)


def spread(frames, count):
    return frames[::max(1, -(-len(frames) // count))]


def check_glb(run, path, count):
    bpy.ops.import_scene.gltf(filepath=path)
    glb = Glb(path)
    shown_in = {}  # Names of meshes, by frame.
    for name, node in glb.nodes().items():
        extras = node['extras']
        frames = [f for f in run.warped_frames(surface_name(run, name))
                  if extras['first_frame'] <= f <= extras['last_frame']]
        for frame in frames:
            shown_in.setdefault(frame, []).append(name)
    farthest = {}
    for frame in spread(sorted(shown_in), count):
        go_to(run.time(frame))
        for name in shown_in[frame]:
            true = run.world_vertices(surface_name(run, name), frame)
            error = np.linalg.norm(evaluated(bpy.data.objects[name]) -
                                   true[glb.sources(name)], axis=1)
            farthest.setdefault(name, {})[frame] = error.max()
    return farthest


def places_of(shown, true):
    """Indices in `true` of the vertices of a mesh that has some of them, in
    their order. Parts that were refuted come first: from the end."""
    places, at = [], len(true)
    for point in shown[::-1]:
        at -= 1
        while at >= 0 and np.abs(true[at] - point).max() > FARTHEST:
            at -= 1
        if at < 0:
            raise ValueError(f'{point}: expected a vertex of warped/')
        places.append(at)
    return places[::-1]


def check_pc2(run, cache, count):
    """A cache of the whole surface NNN_LABEL, STEM_NNN_LABEL.pc2."""
    bpy.ops.wm.obj_import(filepath=str(cache.with_suffix('.obj')))
    thing = bpy.context.selected_objects[0]
    surface = re.search(r'\d{3}_.*', cache.stem)[0]
    head = np.frombuffer(cache.read_bytes()[:32], '<f4,<f4,<i4', 1, 20)[0]
    start, samples = int(head[0]), int(head[2])
    modifier = thing.modifiers.new('cache', 'MESH_CACHE')
    modifier.cache_format = 'PC2'
    modifier.filepath = str(cache)
    modifier.frame_start = start
    farthest, places = {}, None
    frames = [f for f in run.warped_frames(surface)
              if start <= f < start + samples]
    for frame in spread(frames, count):
        bpy.context.scene.frame_set(frame)
        shown = evaluated(thing)
        true = run.world_vertices(surface, frame)
        if places is None:
            places = places_of(shown, true)
        farthest[frame] = np.linalg.norm(shown - true[places], axis=1).max()
    bpy.data.objects.remove(thing)
    return {cache.name: farthest}


def render(run, path, frame):
    scene = bpy.context.scene
    scene.camera = [o for o in bpy.data.objects if o.type == 'CAMERA'][0]
    scene.render.engine = 'CYCLES'
    scene.cycles.samples = 4
    scene.cycles.use_denoising = False
    scene.view_settings.view_transform = 'Standard'
    scene.render.resolution_x, scene.render.resolution_y = 640, 480
    scene.render.filepath = path
    go_to(run.time(frame))
    bpy.ops.render.render(write_still=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('run')
    for name in ('glb', 'pc2', 'picture'):
        parser.add_argument('--' + name)
    parser.add_argument('--frames', type=int, default=10)
    parser.add_argument('--frame', type=int, default=0)
    options = parser.parse_args(sys.argv[sys.argv.index('--') + 1:])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = FPS
    run = Run(options.run)
    farthest = {}
    if options.pc2:
        farthest.update(
            check_pc2(run, pathlib.Path(options.pc2), options.frames))
    if options.glb:
        farthest.update(check_glb(run, options.glb, options.frames))
    for name, errors in farthest.items():
        print(f'{name}: at most {1000 * max(errors.values()):.4f} mm in frames '
              f'{sorted(errors)}')
    if options.picture:
        render(run, options.picture, options.frame)
    compared = [e for errors in farthest.values() for e in errors.values()]
    return 0 if compared and max(compared) <= FARTHEST else 1


if __name__ == '__main__':
    try:
        code = main()
    except BaseException as error:  # Blender would end with 0.
        print(f'blender_check: {error!r}', file=sys.stderr)
        code = 1
    sys.exit(code)
