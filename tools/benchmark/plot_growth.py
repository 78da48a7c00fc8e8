"""Draws the growth curves that sf_growth has measured.

    plot_growth.py CSV_FOLDER IMAGE_FOLDER

Writes performance_*.png and prints the figures that docs/performance.md talks
about. Exit code 2 if a file is missing or not one of sf_growth's.
"""

import csv
import math
import os
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402
from matplotlib.ticker import (  # noqa: E402
    FuncFormatter, LogLocator, NullLocator)

COLORS = ["#0b6e99", "#d1495b", "#6a994e", "#7d5ba6", "#e09f3e", "#444444"]
MARKERS = "osD^vP"
MIB = 1024.0 * 1024.0


class InputError(Exception):
    """A file that cannot be drawn."""


def read_rows(folder, name):
    """All rows of a curve, as dictionaries of text."""
    path = os.path.join(folder, name + ".csv")
    try:
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from error
    if not rows or None in rows[0].values() or "series" not in rows[0]:
        raise InputError(f"{path}: expected columns x, series, seconds")
    return rows


def series_of(rows, y="seconds"):
    """Points (x, y) of every series, in the order of the file."""
    x = next(iter(rows[0]))
    series = {}
    for row in rows:
        point = (float(row[x]), float(row[y]))
        series.setdefault(row["series"], []).append(point)
    return series


def exponent(points):
    """Slope of the least-squares line through the logarithms."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mean_x = sum(x for x, _ in logs) / len(logs)
    mean_y = sum(y for _, y in logs) / len(logs)
    above = sum((x - mean_x) * (y - mean_y) for x, y in logs)
    return above / sum((x - mean_x) ** 2 for x, _ in logs)


def number(value):
    """A tick as one reads it: 0.5, 20, 4,000."""
    return f"{value:,.0f}" if value >= 1 else f"{value:g}"


def new_figure(panels, height=3.5, **options):
    """A figure of panels side by side."""
    figure, axes = pyplot.subplots(1, panels, figsize=(8.4, height),
                                   squeeze=False, **options)
    for axis in axes[0]:
        axis.spines["top"].set_visible(False)
        axis.spines["right"].set_visible(False)
    return figure, axes[0]


def use_logarithms(axis, ticks):
    """Both axes logarithmic, x with these ticks."""
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xticks(ticks)
    axis.xaxis.set_minor_locator(NullLocator())
    low, high = axis.get_ylim()
    steps = (1.0,) if high > 200 * low else (1.0, 2.0, 5.0)
    axis.yaxis.set_major_locator(LogLocator(subs=steps))
    axis.yaxis.set_minor_locator(NullLocator())
    for direction in (axis.xaxis, axis.yaxis):
        direction.set_major_formatter(FuncFormatter(lambda v, _: number(v)))
    axis.grid(True, which="major", color="#dddddd", linewidth=0.6)


def draw_lines(axis, lines):
    """One line a series, with its label."""
    for index, (label, points) in enumerate(lines):
        axis.plot(*zip(*points), color=COLORS[index % len(COLORS)],
                  marker=MARKERS[index % len(MARKERS)], markersize=4,
                  linewidth=1.4, label=label)
    axis.legend(frameon=False, fontsize=8)


def save(figure, folder, name):
    """Writes a picture through a temporary name."""
    path = os.path.join(folder, f"performance_{name}.png")
    figure.tight_layout()
    figure.savefig(path + ".tmp", dpi=110, format="png",
                   metadata={"Software": None})
    os.replace(path + ".tmp", path)
    print(path)


def scaled(points, x=1.0, y=1.0):
    """Points in other units."""
    return [(px * x, py * y) for px, py in points]


def draw_solvers(folder, images):
    """One Gauss-Newton iteration against nodes and correspondences."""
    figure, axes = new_figure(2, sharey=True)
    for axis, name, label in ((axes[0], "nodes", "graph nodes, 75 points each"),
                              (axes[1], "correspondences",
                               "correspondences, 400 nodes")):
        lines = []
        for solver, points in series_of(read_rows(folder, name)).items():
            print(f"{name}: {solver} grows with exponent "
                  f"{exponent(points):.2f}")
            lines.append((solver, scaled(points, y=1e3)))
        draw_lines(axis, lines)
        use_logarithms(axis, [x for x, _ in lines[0][1]])
        axis.tick_params(axis="x", labelsize=7)
        axis.set_xlabel(label)
    axes[0].set_ylabel("one Gauss-Newton iteration, ms")
    axes[1].get_legend().remove()
    save(figure, images, "solvers")


def draw_voxels(folder, images):
    """Time and memory of one frame against the voxel size."""
    rows = read_rows(folder, "voxels")
    figure, axes = new_figure(2)
    seconds = series_of(rows)
    for name, points in seconds.items():
        print(f"voxels: {name} grows with exponent {exponent(points):.2f}")
    draw_lines(axes[0], [(name, scaled(points, 1e3, 1e3))
                         for name, points in seconds.items()])
    axes[0].set_ylabel("one frame, ms")
    memory = series_of(rows, "bytes")
    for name in ("fuse rigid", "fuse warped"):
        print(f"voxels: memory for {name} grows with exponent "
              f"{exponent(memory[name]):.2f}")
    draw_lines(axes[1], [("room", scaled(memory["fuse rigid"], 1e3, 1 / MIB)),
                         ("person", scaled(memory["fuse warped"], 1e3,
                                           1 / MIB))])
    axes[1].set_ylabel("volume, MiB")
    for axis in axes:
        use_logarithms(axis, [1e3 * x for x, _ in memory["fuse rigid"]])
        axis.set_xlabel("voxel size, mm")
        axis.invert_xaxis()
    save(figure, images, "voxels")


def draw_stack(axis, parts, small):
    """Parts of a frame on top of one another; what is always small is one."""
    heights = {name: [1e3 * y for _, y in points]
               for name, points in parts.items()}
    most = max(sum(column) for column in zip(*heights.values()))
    rest = [0.0] * len(next(iter(heights.values())))
    shown = {}
    for name, values in heights.items():
        if max(values) < small * most:
            rest = [a + b for a, b in zip(rest, values)]
        else:
            shown[name] = values
    shown["other"] = rest
    bottom = [0.0] * len(rest)
    for index, (name, values) in enumerate(shown.items()):
        axis.bar([x for x, _ in next(iter(parts.values()))], values, 0.6,
                 bottom, color=COLORS[index], label=name)
        bottom = [a + b for a, b in zip(bottom, values)]
    handles, labels = axis.get_legend_handles_labels()
    axis.legend(handles[::-1], labels[::-1], frameon=False, fontsize=8,
                loc="upper left")


def draw_people(folder, images):
    """A frame of the whole method against people in the room."""
    series = series_of(read_rows(folder, "people"))
    total = series.pop("total")
    alone = series.pop("total_one_thread")
    figure, axes = new_figure(2, sharey=True)
    draw_lines(axes[0], [("one thread", scaled(alone, y=1e3)),
                         ("all cores", scaled(total, y=1e3))])
    axes[0].set_ylabel("a frame, ms")
    draw_stack(axes[1], series, 0.04)
    axes[1].set_title("its parts, one thread", fontsize=9)
    for axis in axes:
        axis.set_xlabel("people in the room")
        axis.set_xticks([x for x, _ in total])
        axis.set_ylim(bottom=0)
        axis.set_axisbelow(True)
        axis.grid(True, axis="y", color="#dddddd", linewidth=0.6)
    for name, points in (("all cores", total), ("one thread", alone)):
        added = (points[-1][1] - points[0][1]) / (points[-1][0] - points[0][0])
        print(f"people: {name}: {1e3 * points[0][1]:.0f} ms, "
              f"{1e3 * added:.0f} ms more a person")
    save(figure, images, "people")


MODELS = {"split": "split: rigid room,\na graph a person",
          "one_graph_preset": "one graph, options\nof the background",
          "one_graph_as_fine": "one graph, options\nof the people"}
# Title, series, column, scale of every panel.
PANELS = (("solve, gn_pcg, ms", "solve gn_pcg", "seconds", 1e3),
          ("solve, gn_cholesky, ms", "solve gn_cholesky", "seconds", 1e3),
          ("fuse, ms", "fuse", "seconds", 1e3),
          ("graphs, equations, MiB", "solve gn_pcg", "bytes", 1 / MIB),
          ("volumes, MiB", "fuse", "bytes", 1 / MIB))


def draw_bars(axis, values):
    """One bar a model, with its value."""
    axis.barh(range(len(values)), values, 0.6, color=COLORS[:len(values)])
    for place, value in enumerate(values):
        text = f"{value:,.0f}" if value >= 10 else f"{value:.1f}"
        axis.text(value, place, " " + text, va="center", fontsize=8)
    axis.set_xlim(0, 1.35 * max(values))
    axis.set_xticks([])
    axis.spines["bottom"].set_visible(False)


def draw_one_graph(folder, images):
    """One graph over everything beside split surfaces."""
    rows = {(row["model"], row["series"]): row
            for row in read_rows(folder, "one_graph")}
    figure, axes = new_figure(len(PANELS), height=2.1, sharey=True)
    for axis, (title, series, column, scale) in zip(axes, PANELS):
        draw_bars(axis, [scale * float(rows[model, series][column])
                         for model in MODELS])
        axis.set_title(title, fontsize=8)
    nodes = [int(float(rows[model, "fuse"]["nodes"])) for model in MODELS]
    axes[0].set_yticks(range(len(MODELS)))
    axes[0].set_yticklabels(
        [f"{text}\n({count:,} nodes)"
         for text, count in zip(MODELS.values(), nodes)], fontsize=8)
    axes[0].invert_yaxis()
    for (model, series), row in rows.items():
        print(f"one_graph: {model}: {float(row['nodes']):.0f} nodes, {series} "
              f"{1e3 * float(row['seconds']):.0f} ms, "
              f"{float(row['bytes']) / MIB:.1f} MiB")
    save(figure, images, "one_graph")


def main(arguments):
    """Draws everything."""
    if len(arguments) != 2:
        raise InputError("expected CSV_FOLDER IMAGE_FOLDER")
    folder, images = arguments
    os.makedirs(images, exist_ok=True)
    pyplot.rcParams["font.size"] = 9
    for draw in (draw_solvers, draw_voxels, draw_people, draw_one_graph):
        draw(folder, images)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except InputError as error:
        sys.exit(print(f"plot_growth.py: {error}", file=sys.stderr) or 2)
