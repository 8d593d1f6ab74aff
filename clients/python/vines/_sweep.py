"""Iteration over the points of a sweep as they arrive."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from types import TracebackType
from typing import TYPE_CHECKING, Any

from ._answer import Answer, frame_of
from ._problem import Incomplete

if TYPE_CHECKING:
    import pandas

Lines = Generator[dict[str, Any], None, None]


class Sweep(Iterator[Answer]):
    """Iterator of the points of a sweep, or of basins, in the order of arrival; a service sends them from coarse to
    fine over the axes. ``point.index`` is the position in the sweep. Raises `Incomplete` at the end
    if points are missing.

    ``close()``, the end of a ``with`` block, or deleting the iterator stops the computation.
    """

    def __init__(self, lines: Lines, indices: list[int] | None) -> None:
        """Reads the first line. Raises `Problem` for an invalid request."""
        self._lines = lines
        self.done = 0
        """Number of points received."""
        self.progress: Answer | None = None
        """Latest progress report: ``done``, ``of``, ``per_second``, ``seconds_left``."""
        self.warnings: list[str] = []
        """Sentences; complete only at the end."""
        self.result: Answer | None = None
        """Last line, at the end; of basins with ``attractors`` and ``basins``."""
        first = next(lines, None)
        if first is None or first.get("type") != "start":
            lines.close()
            raise Incomplete(0, "the sweep ended before its first line")
        self.start = Answer(first)
        """First line: ``axes`` with their ``values``, ``parameters`` of the first point."""
        self.warnings.extend(self.start.warnings)
        self._left = dict.fromkeys(range(first["points"]) if indices is None else indices)
        self.total = len(self._left)
        """Number of points requested."""

    @property
    def missing(self) -> list[int]:
        """Indices of the points not received, for the field ``indices``."""
        return list(self._left)

    def __next__(self) -> Answer:
        for line in self._lines:
            match line.get("type"):
                case "point":
                    self._left.pop(line["index"], None)
                    self.done += 1
                    return Answer(line)
                case "progress":
                    self.progress = Answer(line)
                case "warning":
                    self.warnings.append(line["message"])
                case "error":
                    self._end(int(line.get("status", 0)), str(line.get("detail", "")))
                case "done":
                    self.result = Answer(line)
                    self._end()
        # The sweep was closed or has been read to its end.
        raise StopIteration

    def _end(self, status: int = 0, detail: str = "") -> None:
        self.close()
        if not self._left and not status:
            return
        received = f"received {self.done} of {self.total} points"
        raise Incomplete(status, f"{detail}; {received}" if detail else received)

    def close(self) -> None:
        """Stops the computation; no more points arrive."""
        self._lines.close()

    def frame(self) -> pandas.DataFrame | dict[str, Any]:
        """Waits for all remaining points and returns them as a pandas DataFrame sorted by index,
        one row per point, with the four exponents as columns ``lambda1`` to ``lambda4``. Objects
        and other lists are kept unchanged. Without pandas a dict of columns, one of them
        ``index``."""
        rows = sorted((_row(point) for point in self), key=lambda row: int(row["index"]))
        names = dict.fromkeys(name for row in rows for name in row)
        frame = frame_of({name: [row.get(name) for row in rows] for name in names})
        return frame if isinstance(frame, dict) or not rows else frame.set_index("index")

    def __enter__(self) -> Sweep:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def _row(point: Answer) -> dict[str, Any]:
    row: dict[str, Any] = {}
    for name in point:
        value = point[name]
        if name == "type":
            continue
        if name in ("lambda", "status", "standard_error") and hasattr(value, "__len__"):
            row |= {f"{name}{k + 1}": v for k, v in enumerate(value)}
        else:
            row[name] = value
    return row
