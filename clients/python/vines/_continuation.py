"""Iteration over the lines of a continuation as they arrive."""

from __future__ import annotations

from collections.abc import Iterator

from ._answer import Answer
from ._problem import Incomplete
from ._sweep import Lines


class Continuation(Iterator[Answer]):
    """Iterator of the lines with the ``type`` ``branch``, ``point`` and ``special``, in order.
    Raises `Incomplete` at the end if the computation ended early.

    ``close()``, or deleting the iterator, stops the computation.
    """

    def __init__(self, lines: Lines) -> None:
        """Reads the first line. Raises `Problem` for an invalid request."""
        self._lines = lines
        first = next(lines, None)
        if first is None or first.get("type") != "start":
            lines.close()
            raise Incomplete(0, "the continuation ended before its first line")
        self.start = Answer(first)
        """First line: ``parameter``, ``from``, ``to``, ``parameters`` of the base."""

    def __next__(self) -> Answer:
        for line in self._lines:
            match line.get("type"):
                case "branch" | "point" | "special":
                    return Answer(line)
                case "error":
                    self.close()
                    raise Incomplete(int(line.get("status", 0)), str(line.get("detail", "")))
                case "done":
                    self.close()
        raise StopIteration

    def close(self) -> None:
        """Stops the computation; no more lines arrive."""
        self._lines.close()
