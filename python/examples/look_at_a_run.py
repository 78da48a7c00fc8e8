# %% [markdown]
# # Look at a run
# Give the folder of a run, and the true trajectory if there is one:
# `python3 look_at_a_run.py RUN [groundtruth.txt]`, or open the file as a
# notebook (VS Code, Jupytext) and set the two below.

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import splitfusion_io as sf
from splitfusion_io import plots

FOLDER = sys.argv[1] if len(sys.argv) > 1 else "runs/quickstart/run"
TRUTH = sys.argv[2] if len(sys.argv) > 2 else ""

run = sf.Run(FOLDER)
truth = sf.read_trajectory(TRUTH) if TRUTH else None
print(run.summary["verdict"])
for surface in run.surfaces.values():
    mesh, graph = surface.mesh, surface.graph
    print(
        f"{surface.id} {surface.label}: {len(mesh.vertices)} vertices, "
        f"{len(graph)} nodes, frames {surface.frames[0]}..{surface.frames[-1]}"
    )

# %% [markdown]
# ## Camera, and errors over time

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(13, 4.5))
plots.trajectory(run, truth, left)
plots.errors(run, truth, right)
plt.show()

# %% [markdown]
# ## What the solver did for each surface

# %%
for number in run.surfaces:
    figure, axes = plt.subplots(1, 3, figsize=(18, 4.5))
    plots.costs(run, number, axes[0])
    plots.counts(run, number, axes[1])
    frames = run.iterations.where(surface=number)["frame"]
    if len(frames):
        plots.convergence(run, number, int(frames[-1]), axes[2])
    plt.show()

# %% [markdown]
# ## A surface in a frame
# `warp` carries any points; `mesh_at` is the mesh as `warped/` has it.

# %%
surface = run.surface(max(run.surfaces))
frame = int(surface.frames[-1])
mesh = surface.mesh_at(frame)
pixels = run.camera.project(mesh.vertices[np.unique(mesh.triangles)])
print(f"surface {surface.id} in frame {frame}: {len(mesh.triangles)} triangles")

figure, axes = plt.subplots(figsize=(7, 5))
axes.imshow(run.mask(frame), cmap="tab10", vmax=9)
axes.plot(pixels[::20, 0], pixels[::20, 1], "w.", markersize=1)
axes.set_title("mask of every surface, and the model in it")
plt.show()
