# %% [markdown]
# # Do the deviations of hidden motions hold?
# `python3 hidden_deviations.py RUN SEQUENCE FRAME,FRAME...`: RUN was made with
# `--refine_samples=N` (`sf_run` or `sf_refine`) of a rendered SEQUENCE with
# `gt/tracks.bin`. True points that are visible in one of the frames are tied to
# the model there and carried to all frames in which their node was hidden; the
# errors are compared with its deviations.

# %%
import sys

import numpy as np

import splitfusion_io as sf

run = sf.Run(sys.argv[1])
SEQUENCE = sys.argv[2]
REFERENCES = [int(frame) for frame in sys.argv[3].split(",")]

# %% [markdown]
# ## The truth
# `points`: frames x points x 3, camera frame, metres; `visible` likewise.

# %%
with open(f"{SEQUENCE}/gt/tracks.bin", "rb") as file:
    data = file.read()
FRAMES, POINTS = np.frombuffer(data, "<u4", 2, 8).astype(int)
begin = 16 + 16 * POINTS
points = np.frombuffer(data, "<f4", FRAMES * POINTS * 3, begin)
points = points.reshape(FRAMES, POINTS, 3).astype(float)
visible = np.frombuffer(data, "u1", FRAMES * POINTS, begin + points.size * 4)
visible = visible.reshape(FRAMES, POINTS) > 0
truth = sf.read_trajectory(f"{SEQUENCE}/gt/groundtruth.txt")
for pose, places in zip(truth.world_from_camera, points):
    places[:] = (places - pose[:3, 3]) @ pose[:3, :3]

# %% [markdown]
# ## Errors of what was hidden
# A point is of the surface that it is tied to within 2 cm, and of the node that
# carries most of it there.

# %%
table = run.read("hidden_deviations.csv")
errors, sigmas = [], []
for surface in run.surfaces.values():
    rows = table.where(surface=surface.id)
    if len(rows) == 0:
        continue
    deviations = np.full((FRAMES, len(surface.graph)), np.nan)
    deviations[rows["frame"].astype(int), rows["node"].astype(int)] = rows[
        "sigma"
    ]
    for reference in REFERENCES:
        if reference not in surface.frames:
            continue
        some = np.flatnonzero(visible[reference])
        tied = surface.attach(points[reference, some], reference)
        carried = surface.skinning[tied.vertices]
        most = np.argmax(carried.weights, axis=1)
        node = carried.nodes[np.arange(len(some)), most]
        for frame in surface.frames.tolist():
            sigma = deviations[frame, node]
            hidden = ~np.isnan(sigma) & (tied.distances < 0.02)
            away = surface.follow(tied, frame) - points[frame, some]
            errors.append(away[hidden])
            sigmas.append(sigma[hidden])

# %% [markdown]
# ## Figures
# With `scale`, 0.954 of all errors lie within two deviations, as normal ones do.

# %%
error, sigma = np.concatenate(errors), np.concatenate(sigmas)
if len(sigma) == 0:
    sys.exit(f"{sys.argv[1]}: none of these points was hidden")
ratios = np.sort(np.abs(error / sigma[:, None]).ravel())
print(f"motions {len(sigma)}")
print(f"scale {ratios[int(0.954 * len(ratios))] / 2:.1f}")
length = 1000 * np.linalg.norm(error, axis=1)
for low, high in ((0, 0.25), (0.25, 0.5), (0.5, 0.75), (0.75, 1)):
    least, most = np.quantile(sigma, [low, high])
    part = (sigma >= least) & (sigma <= most)
    print(
        f"deviations of {1000 * least:.1f} to {1000 * most:.1f} mm: "
        f"errors {length[part].mean():.1f} mm in the mean, "
        f"{np.median(length[part]):.1f} in the median"
    )
ranks = [np.argsort(np.argsort(values)) for values in (length, sigma)]
print(f"rank correlation {np.corrcoef(ranks)[0, 1]:.2f}")
