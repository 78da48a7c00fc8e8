"""python3 -m splitfusion_io RUN: an overview of a run."""

from __future__ import annotations

import argparse
import signal
import sys
from collections import Counter
from typing import Any, Optional

import numpy as np

from .errors import RunError
from .run import Run
from .trajectory import read_trajectory


def _surface_line(item: dict[str, Any]) -> str:
    lost, occluded = item.get("lost_frames", 0), item.get("occluded_frames", 0)
    return (
        f"  {item.get('id', '?'):>3} {item.get('label', '?'):<16}"
        f"{item.get('kind', '?'):<10}{item.get('frames', '?'):>7}"
        f"{item.get('nodes', '?'):>7}{item.get('vertices', '?'):>10}"
        f"{lost:>6}{occluded:>10}"
    )


def overview(run: Run) -> str:
    """Some lines about a run."""
    summary = run.summary
    lines = [f"{run.folder}: {summary.get('verdict', '')}"]
    places = run.trajectory.positions
    length = np.linalg.norm(np.diff(places, axis=0), axis=1).sum()
    seconds = summary.get("seconds_per_frame", {}).get("median", float("nan"))
    camera = run.camera
    lines.append(
        f"  {summary.get('status', '')}, preset {summary.get('preset', '')}, "
        f"{camera.width} x {camera.height} pixels, {seconds:.2f} s a frame "
        f"(median), camera path {length:.2f} m"
    )
    lines.append(
        "   id label           kind       frames  nodes  vertices  "
        "lost  occluded"
    )
    lines += [_surface_line(item) for item in summary.get("surfaces", [])]
    headline = (run.evaluation or {}).get("headline", {})
    known = [f"{k} {v:.4g}" for k, v in headline.items() if v is not None]
    if known:
        lines.append("  evaluation: " + ", ".join(known))
    kinds = Counter(file.kind for file in run.files() if file.kind)
    lines.append(
        "  files: " + ", ".join(f"{n} {k}" for k, n in sorted(kinds.items()))
    )
    return "\n".join(lines)


def main(arguments: Optional[list[str]] = None) -> int:
    """Prints the overview; 2 on bad input, with one line on stderr."""
    parser = argparse.ArgumentParser(prog="splitfusion_io", description=__doc__)
    parser.add_argument("run", help="folder that sf_run wrote")
    parser.add_argument(
        "--plots", metavar="DIR", help="write all plots into DIR"
    )
    parser.add_argument(
        "--truth", metavar="FILE", help="true trajectory, TUM text"
    )
    options = parser.parse_args(arguments)
    try:
        run = Run(options.run)
        print(overview(run))
        if options.plots:
            import matplotlib

            matplotlib.use("Agg")  # Needs no display.
            from . import plots

            truth = read_trajectory(options.truth) if options.truth else None
            written = plots.save_all(run, options.plots, truth)
            print(f"  {len(written)} plots in {options.plots}")
    except RunError as error:
        print(f"splitfusion_io: {error}", file=sys.stderr)
        return 2
    except ImportError as error:
        print(f"splitfusion_io: {error.name} is not installed", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    if hasattr(signal, "SIGPIPE"):  # As `| head` ends it.
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    sys.exit(main())
