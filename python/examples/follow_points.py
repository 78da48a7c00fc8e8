# %% [markdown]
# # Follow points of a person through the frames
# `python3 follow_points.py RUN [SURFACE]`: points that are picked in one frame
# are tied to the model there and carried to all others, also while they are
# hidden, as the run thinks they move.

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import splitfusion_io as sf

FOLDER = sys.argv[1] if len(sys.argv) > 1 else "runs/quickstart/run"
run = sf.Run(FOLDER)
SURFACE = int(sys.argv[2]) if len(sys.argv) > 2 else max(run.surfaces)
surface = run.surface(SURFACE)

# %% [markdown]
# ## Pick points
# Here from pixels of its mask, where the model of that frame is seen: highest,
# lowest, and 10 in between. Points of your own are as good: N x 3, metres, in
# the camera frame of the picked frame.

# %%
start = int(surface.frames[len(surface.frames) // 2])
mesh = surface.mesh_at(start)
facing = np.einsum("vi,vi->v", mesh.normals, mesh.vertices) < 0
u, v = run.camera.project(mesh.vertices).T
facing &= (u >= 0) & (u < run.camera.width) & (v >= 0) & (v < run.camera.height)
shown = np.unique(mesh.triangles)
shown = shown[facing[shown]]
order = shown[np.argsort(mesh.vertices[shown, 1])]
picked = order[np.linspace(0, len(order) - 1, 12).astype(int)]
points = mesh.vertices[picked]
tied = surface.attach(points, start)
print(f"{len(points)} points of surface {surface.label} in frame {start}")

# %% [markdown]
# ## Carry them through all frames
# `places` is frames x points x 3, in the world of the run.

# %%
places = np.array(
    [run.to_world(surface.follow(tied, f), f) for f in surface.frames.tolist()]
)
moved = np.linalg.norm(places - places[0], axis=2)
print(
    "path of each point, m:",
    np.round(np.linalg.norm(np.diff(places, axis=0), axis=2).sum(axis=0), 2),
)

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5))
pixels = run.camera.project(points)
left.imshow(run.mask(start) == SURFACE, cmap="gray", alpha=0.4)
for k, (u, v) in enumerate(pixels):
    left.plot(u, v, "o", color=plt.cm.viridis(k / 11))
    right.plot(surface.frames, moved[:, k], color=plt.cm.viridis(k / 11))
left.set_title(f"points in frame {start}")
right.set_xlabel("frame")
right.set_ylabel("from the first place, world [m]")
right.grid(True, alpha=0.3)
plt.show()
np.savetxt(
    "followed_points.csv",
    np.column_stack(
        [
            np.repeat(surface.frames, len(points)),
            np.tile(np.arange(len(points)), len(surface.frames)),
            places.reshape(-1, 3),
        ]
    ),
    delimiter=",",
    header="frame,point,x,y,z",
    comments="",
    fmt="%.6g",
)
