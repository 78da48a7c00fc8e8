"""Text files of a run: JSON, JSON lines, CSV, and the version of each."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np

from .errors import PathLike, RunError, refuse

#: Newest `format_version` of the files that this package reads. Files without
#: one are older and are read, too.
FORMAT_VERSION = 1


def read_bytes(path: PathLike) -> bytes:
    """All bytes of a file. RunError if it cannot be read."""
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise RunError(
            f"{path}: cannot be opened ({error.strerror}): expected a file"
        ) from None


def read_text(path: PathLike) -> str:
    """The text of a file in UTF-8."""
    try:
        return read_bytes(path).decode("utf-8")
    except UnicodeDecodeError:
        raise RunError(f"{path}: is no text: expected UTF-8") from None


def check_version(place: object, data: dict[str, Any]) -> None:
    """RunError if `data` says that it is newer than FORMAT_VERSION."""
    version = data.get("format_version", 0)
    if isinstance(version, bool) or not isinstance(version, int) or version < 0:
        refuse(f"{place}: field 'format_version'", version, "a whole number")
    if version > FORMAT_VERSION:
        refuse(
            f"{place}: field 'format_version'",
            version,
            f"at most {FORMAT_VERSION}: written by a newer version, read it "
            "with that one",
        )


def _refuse_constant(text: str) -> float:
    raise ValueError(text)


def _parse(place: object, text: str) -> Any:
    try:
        return json.loads(text, parse_constant=_refuse_constant)
    except (ValueError, RecursionError):
        return refuse(place, text or "nothing", "JSON")


def read_json(path: PathLike) -> dict[str, Any]:
    """A JSON file with one object, of a version that is known."""
    data = _parse(path, read_text(path))
    if not isinstance(data, dict):
        refuse(path, data, "a JSON object")
    check_version(path, data)
    return data


def read_json_lines(path: PathLike) -> list[dict[str, Any]]:
    """One object a line. A last line without its end, as a crash leaves it, is
    not read."""
    objects = []
    lines = read_text(path).split("\n")[:-1]
    for number, line in enumerate(lines, start=1):
        data = _parse(f"{path}:{number}", line)
        if not isinstance(data, dict):
            refuse(f"{path}:{number}", line, "a JSON object")
        objects.append(data)
    return objects


class Table:
    """A CSV file: columns by name, each an array with one entry a row.

    Columns in which every entry is a number or empty are float64, empty ones
    NaN; all others are arrays of str.
    """

    def __init__(self, path: PathLike, columns: dict[str, np.ndarray]) -> None:
        self.path = str(path)
        self.columns = columns

    @property
    def names(self) -> list[str]:
        """Names of the columns, in the order of the file."""
        return list(self.columns)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def __getitem__(self, name: str) -> np.ndarray:
        """A column. RunError if there is none of that name."""
        if name not in self.columns:
            refuse(
                f"{self.path}: column", name, "one of " + ", ".join(self.names)
            )
        return self.columns[name]

    def where(self, **values: object) -> "Table":
        """The rows in which every named column has the given value."""
        rows = np.ones(len(self), dtype=bool)
        for name, value in values.items():
            rows &= self[name] == value
        return self.rows(rows)

    def rows(self, rows: np.ndarray) -> "Table":
        """The rows that an array of bool, or of indices, chooses."""
        return Table(self.path, {n: c[rows] for n, c in self.columns.items()})


def _column(entries: list[str]) -> np.ndarray:
    try:
        return np.array([float(e) if e else np.nan for e in entries])
    except ValueError:
        return np.array(entries, dtype=str)


def read_csv(path: PathLike) -> Table:
    """A CSV file with a line of headings. A last line without its end is not
    read."""
    text = read_text(path)
    rows = list(csv.reader(text[: text.rfind("\n") + 1].splitlines()))
    if not rows or not rows[0]:
        refuse(path, "nothing", "a line of headings")
    names, entries = rows[0], rows[1:]
    for number, row in enumerate(entries, start=2):
        if len(row) != len(names):
            refuse(f"{path}:{number}", f"{len(row)} entries", f"{len(names)}")
    columns = {n: _column([r[i] for r in entries]) for i, n in enumerate(names)}
    return Table(path, columns)


def read_numbers(path: PathLike, count: int, meaning: str) -> np.ndarray:
    """Lines of `count` numbers each; `#` begins a comment.

    Returns rows x count, float64.
    """
    rows = []
    for number, line in enumerate(read_text(path).splitlines(), start=1):
        words = line.split("#")[0].split()
        if not words:
            continue
        try:
            row = [float(word) for word in words]
        except ValueError:
            row = []
        if len(row) != count or not np.isfinite(row).all():
            refuse(f"{path}:{number}", line, meaning)
        rows.append(row)
    return np.array(rows).reshape(-1, count)
