"""The folder of an experiment (`sf_batch`), and of solvers (`sf_solve`)."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from .errors import PathLike, RunError, refuse
from .files import Table, read_csv, read_json
from .run import Run

#: Columns of results.csv that say which run it is; what is neither these nor a
#: figure varies.
_NAMES = ("task", "sequence", "repeat", "status")


class Batch:
    """What `sf_batch run --output=DIR` wrote (docs/experiments.md)."""

    def __init__(self, folder: PathLike) -> None:
        """RunError if the folder has no results.csv."""
        self.folder = Path(folder)
        if not (self.folder / "results.csv").is_file():
            raise RunError(
                f"{folder}: has no results.csv: expected the folder of sf_batch"
            )

    @cached_property
    def results(self) -> Table:
        """`results.csv`: one row a run."""
        return read_csv(self.folder / "results.csv")

    def table(self, name: str) -> Table:
        """`summary`, `differences` or `effects`: means over repeats, and with a
        baseline what changed."""
        if name not in ("summary", "differences", "effects"):
            refuse("table", name, "summary, differences or effects")
        return read_csv(self.folder / f"{name}.csv")

    @property
    def varied(self) -> list[str]:
        """The settings that vary: columns between `status` and `frames`."""
        names = self.results.names
        end = names.index("frames") if "frames" in names else len(names)
        return [name for name in names[:end] if name not in _NAMES]

    def run(self, task: str) -> Run:
        """The run of a task, of the column `task`."""
        if task not in self.results["task"]:
            refuse(f"{self.folder}: task", task, "one of the column 'task'")
        return Run(self.folder / "tasks" / task / "run")

    def record(self, task: str) -> dict[str, Any]:
        """`task.json`: settings, exit code, times."""
        return read_json(self.folder / "tasks" / task / "task.json")

    def means(
        self, key: str, figure: str
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Values of a setting, mean of a figure over all complete runs with it,
        and its standard deviation (NaN of a single one)."""
        complete = self.results.rows(self.results["status"] == "complete")
        values = np.unique(complete[key])
        groups = [complete.rows(complete[key] == v)[figure] for v in values]
        groups = [group[~np.isnan(group)] for group in groups]
        mean = [g.mean() if len(g) else np.nan for g in groups]
        spread = [g.std(ddof=1) if len(g) > 1 else np.nan for g in groups]
        return values, np.array(mean), np.array(spread)


def read_solvers(folder: PathLike) -> Table:
    """`solvers.csv` of `sf_solve --output=DIR`: one row a solve."""
    return read_csv(Path(folder) / "solvers.csv")
