"""Answers: keys as attributes and items, lists of numbers as arrays."""

from __future__ import annotations

import json
import math
import os
import pathlib
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from ._fields import NUMBER_LISTS

try:
    import numpy
except ImportError:
    numpy = None  # type: ignore[assignment]

if TYPE_CHECKING:
    import pandas


class Answer:
    """An answer, or an object in it.

    ``answer.status.reason`` is ``answer["status"]["reason"]`` and ``answer["status.reason"]``. A
    key that is a Python keyword has a trailing underscore as an attribute: ``point.lambda_``.

    Lists of numbers are NumPy arrays if NumPy is installed, else lists; null in them is NaN,
    elsewhere None. Four exponents over time are an n x 4 array, matrices n x 4 x 4.

    Lengths are in m, ``tau`` is time over 1/omega0 (dimensionless), velocities are in m per unit of
    tau, accelerations in m per unit of tau squared. With a system in SI most of them
    also have an SI counterpart in s, m/s, m/s^2, N s or J. docs/api.md lists each key with its unit.
    """

    __slots__ = ("_members", "_text")

    def __init__(self, members: Mapping[str, Any], text: bytes | None = None) -> None:
        """`text`: the bytes that were received, for a whole answer."""
        self._members = {name: _value(name, value) for name, value in members.items()}
        self._text = text

    def __getitem__(self, path: str) -> Any:
        """Value of a key, or of a path of keys separated by dots. Raises KeyError."""
        if path in self._members:
            return self._members[path]
        value: Any = self
        for name in path.split("."):
            if not isinstance(value, Answer) or name not in value._members:
                raise KeyError(path)
            value = value._members[name]
        return value

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name in Answer.__slots__:  # copy and pickle look these up
            raise AttributeError(name)
        for own in (name, name.removesuffix("_")):
            if own in self._members:
                return self._members[own]
        raise AttributeError(f"the answer has no {name}; it has {', '.join(self._members)}")

    def __contains__(self, path: object) -> bool:
        try:
            self[path]  # type: ignore[index]
        except (KeyError, AttributeError):
            return False
        return True

    def __iter__(self) -> Iterator[str]:
        return iter(self._members)

    def __len__(self) -> int:
        return len(self._members)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._members]

    def __repr__(self) -> str:
        return f"Answer({', '.join(self._members)})"

    def __getstate__(self) -> tuple[dict[str, Any], bytes | None]:
        return self._members, self._text

    def __setstate__(self, state: tuple[dict[str, Any], bytes | None]) -> None:
        self._members, self._text = state

    def keys(self) -> list[str]:
        """The keys; with them ``dict(answer)`` works."""
        return list(self._members)

    def plain(self) -> dict[str, Any]:
        """The answer as dicts and lists for ``json.dump``; NaN is None again."""
        return {name: plain(value) for name, value in self._members.items()}

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the answer to a file as JSON, in the bytes that were received, so that
        ``vines verify`` and ``vines plot`` accept it. Raises ValueError for a part of an answer, and
        for a name that ends with the extension of another format; OSError if the file cannot be
        written."""
        if self._text is None:
            raise ValueError("a part of an answer cannot be saved; save the whole answer")
        file = pathlib.Path(path)
        if file.suffix in (".csv", ".cbor", ".npz"):
            raise ValueError(f"{path}: answers are saved as JSON, in a file such as run.json")
        file.write_bytes(self._text)

    def frame(self, path: str = "") -> pandas.DataFrame | dict[str, Any]:
        """DataFrame with the lists of the object at `path` as columns; without pandas a dict of them.

        As in the service's CSV, a list of four numbers per row gives four columns, ``J1`` to
        ``J4``, and a matrix 16, row by row, ``T11`` to ``T44``. Raises ValueError if the object has
        no lists or lists of different lengths.
        """
        owner = self[path] if path else self
        if not isinstance(owner, Answer):
            raise ValueError(f"{path} is not an object with lists")
        lists = {name: v for name, v in owner._members.items() if _is_list(v)}
        lengths = {len(v) for v in lists.values()}
        if len(lengths) != 1:
            found = ", ".join(f"{name}: {len(v)}" for name, v in lists.items())
            raise ValueError(f"{path or 'the answer'} is not one table of lists ({found})")
        return frame_of({k: c for name, v in lists.items() for k, c in _columns(name, v)})


def frame_of(columns: dict[str, Any]) -> pandas.DataFrame | dict[str, Any]:
    """A pandas DataFrame; without pandas the columns: arrays, or lists without NumPy."""
    try:
        import pandas
    except ImportError:
        return {name: _array(column) for name, column in columns.items()}
    return pandas.DataFrame(columns)


def _array(column: Any) -> Any:
    """A list of numbers as `_numbers`; any other column is kept unchanged."""
    is_number = isinstance(column, list) and all(
        v is None or (isinstance(v, (int, float)) and not isinstance(v, bool)) for v in column
    )
    return _numbers(column) if is_number else column


def plain(value: Any) -> Any:
    """`value` as JSON values: answers, mappings and data frames as dicts, arrays and series as
    lists, NaN as None. Raises ValueError for an infinite number."""
    if isinstance(value, Answer):
        return value.plain()
    if isinstance(value, Mapping) or (hasattr(value, "keys") and hasattr(value, "columns")):
        return {str(name): plain(value[name]) for name in value.keys()}
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, float):
        if math.isinf(value):
            raise ValueError("an infinite number cannot be sent")
        return None if math.isnan(value) else value
    if isinstance(value, (str, int, bool)) or value is None:
        return value
    return [plain(v) for v in value]


def answer_of(text: bytes) -> Answer:
    """A whole answer. Raises ValueError unless it is JSON."""
    return Answer(json.loads(text), text)


def body_of(fields: Mapping[str, Any]) -> bytes:
    """Body of a request, as JSON."""
    return json.dumps(plain(fields), allow_nan=False).encode()


def _value(name: str, value: Any) -> Any:
    if isinstance(value, Mapping):
        return Answer(value)
    if not isinstance(value, list):
        return value
    if name in NUMBER_LISTS:
        return _numbers(value)
    if value and all(isinstance(v, bool) for v in value):
        return value if numpy is None else numpy.array(value)
    return [Answer(v) if isinstance(v, Mapping) else v for v in value]


def _numbers(value: list[Any]) -> Any:
    if numpy is None:
        return _with_nan(value)
    try:
        return numpy.array(value if _is_whole(value) else _with_nan(value))
    except ValueError:  # rows of different lengths, or a row that is null
        return [_numbers(v) if isinstance(v, list) else math.nan if v is None else v for v in value]


def _is_whole(value: list[Any]) -> bool:
    """True for a list of integers only, such as the sides of impacts."""
    return bool(value) and all(type(v) is int for v in value)


def _with_nan(value: list[Any]) -> list[Any]:
    return [
        math.nan if v is None else _with_nan(v) if isinstance(v, list) else float(v) for v in value
    ]


def _is_list(value: Any) -> bool:
    return isinstance(value, list) or (numpy is not None and isinstance(value, numpy.ndarray))


def _columns(name: str, rows: Any) -> Iterator[tuple[str, Any]]:
    """A list as one column, or as several if its entries are lists."""
    first = rows[0] if len(rows) else None
    if first is None or not _is_list(first):
        yield name, rows
        return
    for k in range(len(first)):
        yield from _columns(f"{name}{k + 1}", [row[k] for row in rows])
