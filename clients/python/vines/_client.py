"""The three requests, whichever way they go."""

from __future__ import annotations

import os
import pathlib
import sys
import urllib.parse
import warnings
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Unpack

from ._answer import Answer, body_of, plain
from ._fields import IdentifyFields, SimulateFields, SweepFields
from ._problem import PartialAnswer
from ._sweep import Lines, Sweep

if TYPE_CHECKING:
    import pandas

Columns = Mapping[str, Iterable[float]]


class Client(ABC):
    """What answers requests: a `Service` or the `Program`."""

    def simulate(self, **fields: Unpack[SimulateFields]) -> Answer:
        """One run. `SimulateFields` has each field with its unit, range and default.

        Where it does not come to its end ``answer.status.reason`` is ``max_impacts``, ``deadline``
        or ``interrupted`` in place of ``tau_end``, and a warning `PartialAnswer` says so. Raises
        `Problem`.
        """
        answer = Answer(self._simulate(body_of(_named(fields))))
        if answer.status.reason != "tau_end":
            told = f"{answer.status.reason}: {answer.status.message}"
            warnings.warn(told, PartialAnswer, stacklevel=_caller())
        return answer

    def sweep(self, **fields: Unpack[SweepFields]) -> Sweep:
        """The same over one to three parameters: an iterator of points. `SweepFields` has each
        field. Raises `Problem` at once where the request is at fault, and `Incomplete` behind the
        last point that came where some did not."""
        given = _named(fields)
        indices = given.get("indices")
        if indices is not None:
            given["indices"] = indices = [int(i) for i in indices]
        return Sweep(self._sweep(body_of(given)), indices)

    def identify(
        self,
        record: str | os.PathLike[str] | Columns | pandas.DataFrame | None = None,
        *,
        impacts: Columns | Answer | pandas.DataFrame | None = None,
        **fields: Unpack[IdentifyFields],
    ) -> Answer:
        """Exponents from a measurement. `IdentifyFields` has each field.

        ``record`` is a file of columns as measuring programs write them, or columns by their names,
        ``time_s``, ``displacement_m``, ``acceleration_m_s2``; a unit in a name is obeyed.
        ``impacts`` are columns of impacts in place of a record, as a simulation gives them. Raises
        `Problem`, and OSError for a file that cannot be read.
        """
        given = _named(fields)
        if isinstance(record, (str, os.PathLike)):
            if impacts is not None:
                raise TypeError("identify takes a record or impacts, not both")
            return Answer(self._identify_file(pathlib.Path(record).read_bytes(), _query(given)))
        if record is not None:
            given["record"] = record
        if impacts is not None:
            given["impacts"] = impacts
        return Answer(self._identify(body_of(given)))

    @abstractmethod
    def _simulate(self, body: bytes) -> Any: ...

    @abstractmethod
    def _identify(self, body: bytes) -> Any: ...

    @abstractmethod
    def _identify_file(self, record: bytes, query: str) -> Any: ...

    @abstractmethod
    def _sweep(self, body: bytes) -> Lines: ...


def _named(fields: Mapping[str, Any]) -> dict[str, Any]:
    """By the service's names: a word of Python's own stands with an underscore behind it."""
    if "format" in fields:
        raise TypeError("answers come as objects: there is no format to choose")
    return {name.removesuffix("_"): value for name, value in fields.items()}


def _query(fields: Mapping[str, Any]) -> str:
    """Fields as in a URL: lists are separated by commas."""
    return urllib.parse.urlencode(
        {name: _text(plain(value)) for name, value in fields.items()}, safe=","
    )


def _text(value: Any) -> str:
    if isinstance(value, dict):
        raise TypeError("beside a file there is no field that is an object")
    return ",".join(map(_text, value)) if isinstance(value, list) else str(value)


def _caller() -> int:
    """How far up the caller of `simulate` is: the package's functions pass the request on."""
    depth = 1
    while sys._getframe(depth).f_globals.get("__package__") == __package__:
        depth += 1
    return depth
