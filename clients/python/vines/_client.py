"""The requests, independent of how they are sent."""

from __future__ import annotations

import os
import pathlib
import sys
import urllib.parse
import warnings
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from contextlib import closing
from typing import TYPE_CHECKING, Any, Unpack

from ._answer import Answer, answer_of, body_of, plain
from ._continuation import Continuation
from ._fields import (
    BasinsFields,
    ContinueFields,
    DesignFields,
    IdentifyFields,
    ManifoldFields,
    SimulateFields,
    SweepFields,
)
from ._problem import Incomplete, PartialAnswer
from ._sweep import Lines, Sweep

if TYPE_CHECKING:
    import pandas

Columns = Mapping[str, Iterable[float]]


class Client(ABC):
    """Base class of `Service` and `Program`."""

    def simulate(self, **fields: Unpack[SimulateFields]) -> Answer:
        """Simulates one run. `SimulateFields` lists the fields with unit, range and default.

        If the run ends early, ``answer.status.reason`` is ``max_impacts``, ``deadline`` or
        ``interrupted`` instead of ``tau_end``, and the warning `PartialAnswer` is issued. Raises
        `Problem`.
        """
        answer = answer_of(self._answer("simulate", body_of(_named(fields))))
        if answer.status.reason != "tau_end":
            message = f"{answer.status.reason}: {answer.status.message}"
            warnings.warn(message, PartialAnswer, stacklevel=_caller())
        return answer

    def manifold(self, **fields: Unpack[ManifoldFields]) -> Answer:
        """Returns the slow invariant manifold and a recommended b. `ManifoldFields` lists the
        fields. Raises `Problem`."""
        return answer_of(self._answer("manifold", body_of(_named(fields))))

    def sweep(self, **fields: Unpack[SweepFields]) -> Sweep:
        """Simulates runs over one to three parameters; returns an iterator of points. `SweepFields`
        lists the fields. Raises `Problem` at once for an invalid request, and `Incomplete` after
        the last received point if others are missing."""
        return self._points("sweep", fields)

    def basins(self, **fields: Unpack[BasinsFields]) -> Sweep:
        """Finds the motions to which starts in a box lead; returns an iterator of points, one for
        each start, with its ``attractor``. At its end ``result`` has the motions and their basins.
        `BasinsFields` lists the fields. Errors as those of a sweep."""
        return self._points("basins", fields)

    def _points(self, verb: str, fields: Mapping[str, Any]) -> Sweep:
        given = _named(fields)
        indices = given.get("indices")
        if indices is not None:
            given["indices"] = indices = [int(i) for i in indices]
        return Sweep(self._lines(verb, body_of(given)), indices)

    def continue_(self, **fields: Unpack[ContinueFields]) -> Continuation:
        """Follows periodic orbits along a parameter; returns an iterator of branches, points and
        special points. `ContinueFields` lists the fields. Raises `Problem` at once for an invalid
        request, and `Incomplete` after the last received line if the computation ends early."""
        return Continuation(self._lines("continue", body_of(_named(fields))))

    def design(
        self, each: Callable[[Answer], object] | None = None, /, **fields: Unpack[DesignFields]
    ) -> Answer:
        """Searches the best absorber over a band; returns the last line, whose ``best`` is the
        result. ``each`` is called with each ``point``, an absorber tried, and each ``sample`` of
        the tolerances as it arrives; an error in it stops the computation. `DesignFields` lists the
        fields. Raises `Problem` at once for an invalid request, and `Incomplete` if the computation
        ends early."""
        with closing(self._lines("design", body_of(_named(fields)))) as lines:
            for line in lines:
                match line.get("type"):
                    case "point" | "sample" if each is not None:
                        each(Answer(line))
                    case "error":
                        raise Incomplete(int(line.get("status", 0)), str(line.get("detail", "")))
                    case "done" if line.get("complete"):
                        return Answer(line)
        raise Incomplete(0, "the design ended before its result")

    def identify(
        self,
        record: str | os.PathLike[str] | Columns | pandas.DataFrame | None = None,
        *,
        impacts: Columns | Answer | pandas.DataFrame | None = None,
        **fields: Unpack[IdentifyFields],
    ) -> Answer:
        """Identifies impacts, restitution and exponents from a measurement. `IdentifyFields` lists
        the fields.

        ``record`` is the path of a text file with columns, or a mapping from names such as
        ``time_s``, ``displacement_m``, ``acceleration_m_s2`` to columns; the unit in a name is
        respected. ``impacts``, as in a simulation's answer, replace a record. Raises `Problem`, and
        OSError for a file that cannot be read.
        """
        given = _named(fields)
        if isinstance(record, (str, os.PathLike)):
            if impacts is not None:
                raise TypeError("identify accepts either a record or impacts")
            text = self._identify_file(pathlib.Path(record).read_bytes(), _query(given))
            return answer_of(text)
        if record is not None:
            given["record"] = record
        if impacts is not None:
            given["impacts"] = impacts
        return answer_of(self._answer("identify", body_of(given)))

    @abstractmethod
    def _answer(self, verb: str, body: bytes) -> bytes: ...

    @abstractmethod
    def _identify_file(self, record: bytes, query: str) -> bytes: ...

    @abstractmethod
    def _lines(self, verb: str, body: bytes) -> Lines: ...


def _named(fields: Mapping[str, Any]) -> dict[str, Any]:
    """Fields by the service's names: a Python keyword has a trailing underscore."""
    if "format" in fields:
        raise TypeError("answers are objects: format cannot be chosen")
    return {name.removesuffix("_"): value for name, value in fields.items()}


def _query(fields: Mapping[str, Any]) -> str:
    """Fields as a URL query; the elements of lists are separated by commas."""
    return urllib.parse.urlencode(
        {name: _text(plain(value)) for name, value in fields.items()}, safe=","
    )


def _text(value: Any) -> str:
    if isinstance(value, dict):
        raise TypeError("with a file, no field can be an object")
    return ",".join(map(_text, value)) if isinstance(value, list) else str(value)


def _caller() -> int:
    """Stack level of the first caller outside this package, for warnings."""
    depth = 1
    while sys._getframe(depth).f_globals.get("__package__") == __package__:
        depth += 1
    return depth
