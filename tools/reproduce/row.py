#!/usr/bin/env python3
"""Prints a row of a markdown table about an evaluated run.

row.py --heading [COLUMN...]        the heading
row.py RUN NAME [TEXT...]           its row, the texts in the columns
"""

import sys

import numpy as np

import splitfusion_io as sf

COLUMNS = ("sequence", "frames", "ATE mm", "RPE mm", "RPE deg")
COLUMNS += ("depth mm", "uncovered %", "lost frames", "s/frame")


def number(value, scale=1.0, digits=1):
    """A number of a cell; a dash where it is unknown."""
    return "-" if value is None else f"{scale * value:.{digits}f}"


def agreement(evaluation):
    """Median distance (m) of the models from the live depth, and the share of
    its pixels without model, over all surfaces by their pixels."""
    items = [i for i in evaluation["depth_agreement"] if i["pixels"] > 0]
    if not items:
        return None, None
    pixels = np.array([i["pixels"] for i in items], float)
    medians = np.array([i["distances"]["median"] or 0.0 for i in items])
    uncovered = sum(i["uncovered"] for i in items)
    return float(medians @ pixels / pixels.sum()), uncovered / pixels.sum()


def row(folder, name, texts):
    """The cells of a run."""
    run = sf.Run(folder)
    if run.evaluation is None:
        raise sf.RunError(f"{folder}: no evaluation.json: run sf_evaluate")
    headline = run.evaluation["headline"]
    depth, uncovered = agreement(run.evaluation)
    return [
        name,
        str(run.summary["frames"]),
        number(headline["ate_m"], 1000),
        number(headline["rpe_m"], 1000),
        number(headline["rpe_deg"], 1, 2),
        number(depth, 1000),
        number(uncovered, 100),
        str(run.summary["lost_frames"]),
        number(run.summary["seconds_per_frame"]["median"], 1, 2),
        *texts,
    ]


def main(arguments):
    """Prints a row; 2 and one line on bad input."""
    if arguments[:1] == ["--heading"]:
        cells = [*COLUMNS, *arguments[1:]]
        print("| " + " | ".join(cells) + " |")
        print("|" + "---|" * len(cells))
        return 0
    if len(arguments) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        cells = row(arguments[0], arguments[1], arguments[2:])
    except sf.RunError as error:
        print(f"row.py: {error}", file=sys.stderr)
        return 2
    print("| " + " | ".join(cells) + " |")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
