"""The standard plots of a run, by matplotlib, which is asked for only here.

Every function draws into `axes`, or into those of a new figure, and returns
them; `axes.figure.savefig("FILE.png")` writes it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Optional

import numpy as np

from .batch import Batch
from .errors import PathLike, RunError, refuse
from .files import Table
from .run import Run
from .trajectory import Trajectory, trajectory_errors

if TYPE_CHECKING:
    from matplotlib.axes import Axes
else:
    Axes = Any


def _axes(axes: Optional[Axes], title: str, x: str, y: str) -> Axes:
    """Axes with their labels; new ones in a figure of their own."""
    if axes is None:
        try:
            from matplotlib import pyplot
        except ImportError:
            raise RunError(
                "matplotlib is not installed: expected Debian's "
                "python3-matplotlib, or pip install matplotlib"
            ) from None
        axes = pyplot.figure(figsize=(7, 4.2), layout="constrained").subplots()
    axes.set_title(title, fontsize="medium")
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(True, alpha=0.3)
    return axes


def _name(run: Run, surface_id: int) -> str:
    return f"{surface_id} {run.surface(surface_id).label}"


def _legend(axes: Axes) -> None:
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize="small")


def trajectory(
    run: Run, truth: Optional[Trajectory] = None, axes: Optional[Axes] = None
) -> Axes:
    """Places of the camera from above: x to the right, z forward, metres, in
    the world of the run, into which a true trajectory is aligned."""
    axes = _axes(axes, f"camera of {run.folder.name}", "x [m]", "z [m]")
    places = run.trajectory.positions
    axes.plot(places[:, 0], places[:, 2], label="estimate")
    axes.plot(
        places[:1, 0], places[:1, 2], "o", color="C0", label="first frame"
    )
    if truth is not None:
        motion = np.linalg.inv(
            trajectory_errors(run.trajectory, truth).truth_from_estimate
        )
        true = truth.positions @ motion[:3, :3].T + motion[:3, 3]
        axes.plot(true[:, 0], true[:, 2], "--", label="truth")
    axes.set_aspect("equal", "datalim")
    _legend(axes)
    return axes


def errors(
    run: Run, truth: Optional[Trajectory] = None, axes: Optional[Axes] = None
) -> Axes:
    """Errors over the frames, millimetres: the residual of every surface (point
    to plane, RMS of the last round), and with a true trajectory the absolute
    error of the camera."""
    axes = _axes(axes, f"errors of {run.folder.name}", "frame", "error [mm]")
    for surface_id in run.surfaces:
        frames, values = run.series(surface_id, "residual_rms")
        values[values == 0] = np.nan  # Nothing was solved.
        label = f"residual of {_name(run, surface_id)}"
        axes.plot(frames, 1000 * values, ".-", label=label)
    if truth is not None:
        found = trajectory_errors(run.trajectory, truth)
        frames = run.frame_indices[found.indices]
        label = f"camera (ATE {1000 * found.ate:.1f} mm)"
        axes.plot(frames, 1000 * found.errors, "k--", label=label)
    _legend(axes)
    return axes


def costs(run: Run, surface_id: int, axes: Optional[Axes] = None) -> Axes:
    """Cost of every term of a surface over the frames, after the last round."""
    title = f"cost by term, surface {_name(run, surface_id)}"
    axes = _axes(axes, title, "frame", "cost, weighted")
    rounds = run.last_rounds(surface_id)
    names: dict[str, None] = {}
    for _, item in rounds:
        names.update(dict.fromkeys(t["term"] for t in item["solver"]["terms"]))
    for name in names:
        found = [
            (frame, term["final"])
            for frame, item in rounds
            for term in item["solver"]["terms"]
            if term["term"] == name and term["final"] is not None
        ]
        axes.plot(*np.array(found, float).reshape(-1, 2).T, label=name)
    _legend(axes)
    return axes


def counts(run: Run, surface_id: int, axes: Optional[Axes] = None) -> Axes:
    """Nodes, residuals and pairs of a surface over the frames; logarithmic."""
    title = f"sizes, surface {_name(run, surface_id)}"
    axes = _axes(axes, title, "frame", "number")
    axes.plot(*run.series(surface_id, "nodes"), label="nodes")
    rounds = run.last_rounds(surface_id)
    frames = [frame for frame, _ in rounds]
    residuals = [item["solver"]["residuals"] for _, item in rounds]
    accepted = [item["association"]["accepted"] for _, item in rounds]
    axes.plot(frames, residuals, label="residuals")
    axes.plot(frames, accepted, label="pairs accepted")
    axes.set_yscale("symlog")
    _legend(axes)
    return axes


def convergence(
    run: Run, surface_id: int, frame: int, axes: Optional[Axes] = None
) -> Axes:
    """Cost over the iterations of a surface in a frame, a line for every round
    (each has its own correspondences), coloured by stage; steps that were not
    taken are crosses."""
    title = f"convergence, surface {_name(run, surface_id)}, frame {frame}"
    axes = _axes(axes, title, "iteration", "cost")
    rows = run.iterations.where(surface=surface_id, frame=frame)
    if len(rows) == 0:
        refuse(f"{run.iterations.path}: frame", frame, "one with iterations")
    begin = 0
    colors: dict[str, str] = {}
    for number in np.unique(rows["round"]):
        part = rows.where(round=number)
        steps = begin + np.arange(len(part))
        stage = f"{part['stage'][0]}, stride {part['stride'][0]:.0f}"
        label = None if stage in colors else stage
        color = colors.setdefault(stage, f"C{len(colors)}")
        axes.plot(steps, part["cost"], ".-", label=label, color=color)
        failed = part["accepted"] == 0
        axes.plot(steps[failed], part["cost"][failed], "x", color=color)
        begin += len(part)
    axes.set_yscale("log")
    _legend(axes)
    return axes


def solvers(
    table: Table, gap: str = "1e-4", axes: Optional[Axes] = None
) -> Axes:
    """Performance profile of `sf_solve`: share of the problems that each solver
    brings to a gap (`1e-2`, `1e-4`, `1e-6`) within so many times the seconds of
    the fastest."""
    title = f"to a gap of {gap}"
    axes = _axes(axes, title, "time / that of the fastest", "share of problems")
    seconds = table[f"seconds_to_{gap}"]
    keys = ("problem", "threads", "start", "repeat")
    cases = np.array(
        [" ".join(map(str, k)) for k in zip(*(table[n] for n in keys))]
    )
    ways = np.array(
        [f"{s}, {p}" for s, p in zip(table["solver"], table["preconditioner"])]
    )
    ratios: dict[str, list[float]] = {way: [] for way in np.unique(ways)}
    for case in np.unique(cases):
        inside = cases == case
        if np.isnan(seconds[inside]).all():
            best = np.nan
        else:
            best = np.nanmin(seconds[inside])
        for way, time in zip(ways[inside], seconds[inside]):
            ratios[way].append(time / best)
    for way, found in ratios.items():
        solved = np.sort([r for r in found if not np.isnan(r)])
        share = np.arange(1, len(solved) + 1) / len(found)
        axes.step(solved, share, where="post", marker=".", label=way)
    axes.set_xscale("log")
    axes.set_ylim(0, 1.05)
    _legend(axes)
    return axes


def batch(
    experiment: Batch, key: str, figure: str, axes: Optional[Axes] = None
) -> Axes:
    """A figure of `results.csv`, as `ate_m`, over a setting that varies: mean
    over sequences and repeats of each value, and the standard deviation."""
    title = f"{figure} over {key}"
    axes = _axes(axes, title, key, figure)
    values, mean, spread = experiment.means(key, figure)
    if values.dtype.kind != "f":
        axes.set_xticks(
            range(len(values)), [str(v) or "(default)" for v in values]
        )
        values = np.arange(len(values))
    known = ~np.isnan(mean)
    bars = np.nan_to_num(spread[known])
    axes.errorbar(values[known], mean[known], bars, fmt="o-", capsize=3)
    return axes


def save_all(
    run: Run, folder: PathLike, truth: Optional[Trajectory] = None
) -> list[Path]:
    """Writes all plots of a run as PNG files; returns their paths. Convergence
    is that of the last frame of each surface that has iterations."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    written = []

    def save(name: str, draw: Callable[[], Axes]) -> None:
        figure = draw().figure
        written.append(Path(folder) / f"{name}.png")
        figure.savefig(written[-1], dpi=120)
        from matplotlib import pyplot

        pyplot.close(figure)

    save("trajectory", lambda: trajectory(run, truth))
    save("errors", lambda: errors(run, truth))
    for number in run.surfaces:
        save(f"costs_{number:03}", lambda: costs(run, number))
        save(f"counts_{number:03}", lambda: counts(run, number))
        frames = run.iterations.where(surface=number)["frame"]
        if len(frames):
            last = int(frames[-1])
            save(
                f"convergence_{number:03}",
                lambda: convergence(run, number, last),
            )
    return written
