#!/usr/bin/env python3
"""3D errors of a run against the annotations of DeepDeform.

deepdeform_error.py RUN FOLDER [RUN FOLDER ...]

FOLDER: seqNNN of the data set. For every annotated pair of frames (SOURCE,
TARGET) points of SOURCE are given to the run as positions in its camera frame,
tied to the surface that the run shows at their pixels, and carried to TARGET;
the error is the distance from where they are annotated, in the camera frame of
TARGET (deformation error, or end-point error of the scene flow). Two kinds:

  flow      every pixel of scene_flow/OBJECT_SOURCE_TARGET.sflow with depth
  matches   sparse matches by hand, train_matches.json or val_matches.json,
            chosen as the benchmark's own evaluation does: within the mask, and
            no pixel without depth within two pixels, at both ends

A point that cannot be tied (10 cm from all that is there) or carried stays
where it was in the world, none is left out. The last lines are means over
sequences; that of the matches has the weights of the benchmark: a sequence is
the mean over its segments, which begin with frame 0 and end with every 100th
and the last frame, at most 300 mm each.
"""

import json
import struct
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import splitfusion_io as sf

#: Of the benchmark: frames between the ends of segments, and their greatest
#: error, millimetres.
SEGMENT, WORST = 100, 300.0

#: Farther from any surface a point is not tied to it, metres.
REACH = 0.1

#: Deformation errors that are published, on the data set's test pairs.
PUBLISHED = (
    ("DynamicFusion", 61.8),
    ("DeepDeform (Bozic et al. 2020)", 31.5),
    ("NNRT (Bozic et al. 2020)", 28.7),
)


@dataclass
class Pair:
    """Points of an annotated pair of frames."""

    kind: str  #: flow or matches
    name: str  #: OBJECT_SOURCE_TARGET
    source: int  #: Number of the image.
    target: int  #: Number of the image.
    pixels: np.ndarray  #: P x 2 int, u and v in SOURCE.
    points: np.ndarray  #: P x 3, camera frame of SOURCE, metres.
    truth: np.ndarray  #: P x 3, camera frame of TARGET, metres.


def read_flow(path):
    """Scene flow: height x width x 3 float32, metres; -inf: none."""
    data = path.read_bytes()
    width, height, channels = struct.unpack("<3I", data[:12])
    if channels != 3 or len(data) != 12 + 4 * width * height * channels:
        raise sf.RunError(f"{path}: {len(data)} bytes: expected a scene flow")
    flow = np.frombuffer(data, "<f4", offset=12)
    return np.moveaxis(flow.reshape(channels, height, width), 0, 2)


class Depth:
    """Depth images of a sequence, by number, metres."""

    def __init__(self, folder, camera):
        self.folder, self.camera = folder, camera

    def image(self, number):
        path = self.folder / "depth" / f"{number:06}.png"
        return sf.read_png(path) / self.camera.depth_scale

    def frames(self):
        """Number of the last image."""
        return max(int(p.stem) for p in self.folder.glob("depth/*.png"))

    def sure_points(self, number, pixels):
        """Points at pixels (P x 2 int, u and v), and whether each is within the
        mask of its frame, if there is one, and off the borders of depth."""
        image = self.image(number)
        masks = sorted(self.folder.glob(f"mask/{number:06}*.png"))
        if masks:
            image = image * np.any([sf.read_png(m) > 0 for m in masks], axis=0)
        height, width = image.shape
        inside = (pixels >= 2).all(axis=1)
        inside &= (pixels[:, 0] < width - 2) & (pixels[:, 1] < height - 2)
        u, v = np.where(inside[:, None], pixels, 2).T
        for dv in range(-2, 3):
            for du in range(-2, 3):
                inside &= image[v + dv, u + du] > 0
        return self.camera.unproject(pixels, image[v, u]), inside


def flow_pairs(folder, depth):
    """Pairs with dense scene flow."""
    for path in sorted(folder.glob("scene_flow/*.sflow")):
        _, source, target = path.stem.rsplit("_", 2)
        flow = read_flow(path)
        z = depth.image(int(source))
        v, u = np.nonzero(np.isfinite(flow).all(axis=2) & (z > 0))
        pixels = np.stack([u, v], axis=1)
        points = depth.camera.unproject(pixels, z[v, u])
        truth = points + flow[v, u]
        yield Pair(
            "flow", path.stem, int(source), int(target), pixels, points, truth
        )


def match_pairs(folder, depth):
    """Pairs with sparse matches."""
    for name in ("train_matches.json", "val_matches.json"):
        for place in (folder.parent, folder.parent.parent):
            if not (place / name).is_file():
                continue
            for item in json.loads((place / name).read_text()):
                if item["seq_id"] not in (folder.name, folder.name[3:]):
                    continue
                numbers = int(item["source_id"]), int(item["target_id"])
                pixels = [
                    np.array([[m[f"{e}_x"], m[f"{e}_y"]] for m in matches])
                    .reshape(-1, 2)
                    .round()
                    .astype(int)
                    for matches in [item["matches"]]
                    for e in ("source", "target")
                ]
                points, known = depth.sure_points(numbers[0], pixels[0])
                truth, good = depth.sure_points(numbers[1], pixels[1])
                known &= good
                yield Pair(
                    "matches",
                    f"{item['object_id']}_{numbers[0]:06}_{numbers[1]:06}",
                    *numbers,
                    pixels[0][known],
                    points[known],
                    truth[known],
                )


def frame_of(run, number):
    """Frame index of an image number; None: the run lacks it."""
    for frame in run.frames:
        if frame["stem"] == f"{number:06}":
            return frame["frame"]
    return None


def still(run, points, source, target):
    """Points that do not move in the world, in the camera frame of target."""
    pose = np.linalg.inv(run.world_from_camera(target))
    return run.to_world(points, source) @ pose[:3, :3].T + pose[:3, 3]


def carry(run, pair, source, target):
    """Where the run puts the points of a pair in the camera frame of target,
    and which it could tie to a surface."""
    places = still(run, pair.points, source, target)
    tied = np.zeros(len(pair.points), bool)
    shown = run.mask(source)[pair.pixels[:, 1], pair.pixels[:, 0]]
    for number, surface in run.surfaces.items():
        inside = np.flatnonzero(shown == number)
        known = {source, target} <= set(surface.frames.tolist())
        if len(inside) == 0 or not known:
            continue
        attachment = surface.attach(pair.points[inside], source)
        near = attachment.distances <= REACH
        places[inside[near]] = surface.follow(attachment, target)[near]
        tied[inside[near]] = True
    return places, tied


def weighted(pairs, last):
    """Mean of the errors of a sequence (millimetres), with the weights of the
    benchmark; None: no point. `pairs`: last frame and errors of each."""
    ends = [*range(SEGMENT, last, SEGMENT), last]
    means = []
    for end in ends:
        errors = [e for frame, e in pairs if frame <= end and len(e) > 0]
        if errors:
            means.append(min(np.concatenate(errors).mean(), WORST))
    return float(np.mean(means)) if means else None


def evaluate(folder, data):
    """Prints the rows of a sequence; its mean error by kind, millimetres."""
    run = sf.Run(folder)
    depth = Depth(data, run.camera)
    pairs = [*flow_pairs(data, depth), *match_pairs(data, depth)]
    if not pairs:
        raise sf.RunError(
            f"{data}: no annotation: expected scene_flow/*.sflow or "
            "train_matches.json"
        )
    found = {"flow": [], "matches": []}
    for pair in pairs:
        source, target = (frame_of(run, n) for n in (pair.source, pair.target))
        head = f"| {data.name} | {pair.name} | {pair.kind} "
        if source is None or target is None or len(pair.points) == 0:
            print(head + "| 0 | - | - | - | - | - |")
            continue
        places, tied = carry(run, pair, source, target)
        error = 1000 * np.linalg.norm(places - pair.truth, axis=1)
        rest = still(run, pair.points, source, target) - pair.truth
        rest = 1000 * np.linalg.norm(rest, axis=1)
        found[pair.kind].append((max(pair.source, pair.target), error))
        print(
            head + f"| {len(error)} | {100 * tied.mean():.1f} "
            f"| {error.mean():.1f} | {np.median(error):.1f} "
            f"| {100 * np.mean(error < 50):.1f} | {rest.mean():.1f} |"
        )
    flow = [error.mean() for _, error in found["flow"]]
    return {
        "flow": float(np.mean(flow)) if flow else None,
        "matches": weighted(found["matches"], depth.frames()),
    }


def main(arguments):
    """Prints a table; 2 and one line on bad input."""
    if not arguments or len(arguments) % 2:
        print(__doc__, file=sys.stderr)
        return 2
    print(
        "| sequence | pair | by | points | tied % | error mm | median mm "
        "| within 50 mm % | if nothing moved mm |"
    )
    print("|---|---|---|---|---|---|---|---|---|")
    means = [
        evaluate(folder, Path(data))
        for folder, data in zip(arguments[::2], arguments[1::2])
    ]
    print()
    for kind, text in (
        ("flow", "mean end-point error of the scene flow"),
        ("matches", "mean deformation error of the matches"),
    ):
        known = [mean[kind] for mean in means if mean[kind] is not None]
        if known:
            count = f"{len(known)} sequence" + "s" * (len(known) > 1)
            print(f"{text}, {count}: {np.mean(known):.1f} mm")
    figures = ", ".join(f"{name} {value}" for name, value in PUBLISHED)
    print(
        f"Published deformation errors, mm: {figures}. They are of the matches "
        "of the data set's test sequences, which are not public."
    )
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (sf.RunError, OSError, KeyError, ValueError) as problem:
        print(f"deepdeform_error.py: {problem}", file=sys.stderr)
        sys.exit(2)
