"""The one error of this package, and how it is worded."""

from __future__ import annotations

from pathlib import Path
from typing import NoReturn, Union

PathLike = Union[str, Path]


class RunError(ValueError):
    """A file or an argument that is not as it has to be.

    One line: the file (and field), the value, and what was expected.
    """


def brief(value: object, limit: int = 60) -> str:
    """The value as text on one line, cut to `limit` characters."""
    text = " ".join(str(value).split())
    return text if len(text) <= limit else text[: limit - 3] + "..."


def refuse(place: object, value: object, expected: str) -> NoReturn:
    """Raises RunError("PLACE: VALUE: expected EXPECTED")."""
    raise RunError(f"{place}: {brief(value)}: expected {expected}")
