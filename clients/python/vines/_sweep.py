"""The points of a sweep, as they come."""

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
    """An iterator of a sweep's points, in the order in which they come: from a service coarse to
    fine over the axes; ``point.index`` says the place. It raises `Incomplete` where not all of them came.

    Closing it, by ``close()``, by leaving a ``with`` block or by forgetting it, ends the computing.
    """

    def __init__(self, lines: Lines, indices: list[int] | None) -> None:
        """Reads the first line: raises what the request is at fault for."""
        self._lines = lines
        self.done = 0
        """Points that have come."""
        self.progress: Answer | None = None
        """The service's latest word: ``done``, ``of``, ``per_second``, ``seconds_left``."""
        self.warnings: list[str] = []
        """Sentences; all of them at the end."""
        first = next(lines, None)
        if first is None or first.get("type") != "start":
            lines.close()
            raise Incomplete(0, "the sweep ended before it began")
        self.start = Answer(first)
        """Its first line: ``axes`` with their ``values``, ``parameters`` of the first point."""
        self.warnings.extend(self.start.warnings)
        self._left = dict.fromkeys(range(first["points"]) if indices is None else indices)
        self.total = len(self._left)
        """Points asked for."""

    @property
    def missing(self) -> list[int]:
        """The indices of the points that have not come, for the field ``indices``."""
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
                    self._end()
        # Nothing is left of a sweep that was closed or has been read to its end.
        raise StopIteration

    def _end(self, status: int = 0, detail: str = "") -> None:
        self.close()
        if not self._left and not status:
            return
        came = f"{self.done} of {self.total} points came"
        raise Incomplete(status, f"{detail}; {came}" if detail else came)

    def close(self) -> None:
        """Ends the computing; no more points come."""
        self._lines.close()

    def frame(self) -> pandas.DataFrame:
        """The points that are still to come, all of them, as a pandas DataFrame by their index: a
        row each, four exponents as ``lambda1`` to ``lambda4``. Objects and lists of other lengths
        stay what they are. ImportError without pandas."""
        rows = [_row(point) for point in self]
        frame = frame_of(rows)
        return frame.set_index("index").sort_index() if rows else frame

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
