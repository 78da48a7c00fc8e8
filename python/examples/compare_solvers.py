# %% [markdown]
# # Compare solvers, and the runs of an experiment
# `python3 compare_solvers.py SOLVE BATCH`: the folder of `sf_solve` and that of
# `sf_batch`; either may be `-`. Here they come from
#
#     sf_run --sequence=DIR --freeze=10 --output=RUN
#     sf_solve RUN/problems/*.h5 --output=SOLVE
#     sf_batch run --sequences=DIR --grid="terms.arap.weight=4,8,16" \
#         --repeat=3 --output=BATCH

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import splitfusion_io as sf
from splitfusion_io import plots

SOLVE = sys.argv[1] if len(sys.argv) > 1 else "runs/solve"
BATCH = sys.argv[2] if len(sys.argv) > 2 else "runs/batch"

# %% [markdown]
# ## Solvers on frozen problems

# %%
if SOLVE != "-":
    table = sf.read_solvers(SOLVE)
    for way in np.unique(table["solver"]):
        rows = table.where(solver=way)
        good = np.mean(rows["status"] == "converged")
        print(
            f"{way}: {len(rows)} solves, {100 * good:.0f} % converged, "
            f"{1000 * np.median(rows['seconds']):.1f} ms (median)"
        )
    figure, axes = plt.subplots(1, 3, figsize=(18, 4.5))
    for gap, ax in zip(("1e-2", "1e-4", "1e-6"), axes):
        plots.solvers(table, gap, ax)
    plt.show()

# %% [markdown]
# ## An experiment
# Means over sequences and repeats of each value; bars are standard deviations.

# %%
if BATCH != "-":
    batch = sf.Batch(BATCH)
    print("varies:", ", ".join(batch.varied) or "nothing")
    figures = ("ate_m", "tracks_mean_m", "f_score_seen", "seconds_per_frame")
    for key in batch.varied:
        figure, axes = plt.subplots(1, len(figures), figsize=(22, 4.5))
        for name, ax in zip(figures, axes):
            plots.batch(batch, key, name, ax)
        plt.show()

# %% [markdown]
# ## The runs themselves

# %%
if BATCH != "-":
    for task in batch.results.where(status="complete")["task"]:
        run = batch.run(task)
        settings = batch.record(task)["settings"]
        print(task, settings, run.summary["verdict"])
