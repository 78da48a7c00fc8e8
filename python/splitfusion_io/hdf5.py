"""HDF5 files of a run, by the module `h5py`, which is asked for only here."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .errors import PathLike, RunError, brief, refuse
from .files import check_version

#: Newest version of the files of `problems/`, their attribute `version`.
PROBLEM_VERSION = 3


@dataclass
class Hdf5File:
    """All that a file holds."""

    #: Arrays by path, as `graph/position`; docs/solvers.md says what they are.
    arrays: dict[str, np.ndarray] = field(default_factory=dict)
    attributes: dict[str, Any] = field(default_factory=dict)


def _plain(value: Any) -> Any:
    """An attribute as a number or text of Python."""
    value = (
        value.item() if isinstance(value, (np.ndarray, np.generic)) else value
    )
    return (
        value.decode("utf-8", "replace") if isinstance(value, bytes) else value
    )


def read_hdf5(path: PathLike) -> Hdf5File:
    """Reads `residuals.h5` or a file of `problems/`."""
    try:
        import h5py
    except ImportError:
        raise RunError(
            f"{path}: h5py is not installed: expected Debian's python3-h5py, "
            "or pip install h5py"
        ) from None
    result = Hdf5File()

    def visit(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset):
            result.arrays[name] = item[()]

    try:
        with h5py.File(str(path), "r") as file:
            result.attributes = {k: _plain(v) for k, v in file.attrs.items()}
            check_version(path, result.attributes)
            version = result.attributes.get("version", 0)
            if version > PROBLEM_VERSION:
                refuse(
                    f"{path}: attribute 'version'",
                    version,
                    f"at most {PROBLEM_VERSION}: written by a newer version",
                )
            file.visititems(visit)
    except OSError as error:
        raise RunError(
            f"{path}: {brief(error)}: expected an HDF5 file"
        ) from None
    return result
