"""Errors and warnings of requests."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class FieldError:
    """An invalid field."""

    field: str
    """Its name, or its path if nested, such as ``axes/0/from``."""
    value: Any
    """The given value."""
    range: list[Any] | None
    """[minimum, maximum], or the choices, or None."""
    detail: str
    """Description of the error."""


class Problem(Exception):
    """A request that the service or the program refused or could not answer."""

    def __init__(
        self,
        status: int,
        detail: str,
        *,
        title: str = "",
        errors: tuple[FieldError, ...] = (),
        lacking: str | None = None,
        request_id: str | None = None,
        retry_after: float | None = None,
    ) -> None:
        super().__init__(status, detail)
        self.status = status
        """HTTP status, for the program too; 0 if there is none."""
        self.detail = detail
        """Description of the error."""
        self.title = title
        self.errors = errors
        """The invalid fields."""
        self.lacking = lacking
        """For 503: the exhausted resource."""
        self.request_id = request_id
        """Identifies the request in the service's log."""
        self.retry_after = retry_after
        """For 503: seconds to wait before the next attempt."""

    def __str__(self) -> str:
        # With one invalid field, the document's detail is the field's detail.
        faults = [e.detail for e in self.errors if e.detail != self.detail]
        text = "; ".join([self.detail, *faults])
        return f"{self.status}: {text}" if self.status else text


class Incomplete(Problem):
    """A computation that ended early. What was received is valid; of a sweep or of basins request
    the rest with ``indices=sweep.missing``."""


class PartialAnswer(UserWarning):
    """A simulation that ended early; its ``status`` gives the reason and the time reached."""


def problem_of(
    document: object, *, status: int = 0, text: str = "", retry_after: float | None = None
) -> Problem:
    """Problem from a problem document (RFC 9457), or from `status` and `text` if it is none."""
    if not isinstance(document, Mapping) or "detail" not in document:
        return Problem(status, text.strip() or "no reason was given", retry_after=retry_after)
    return Problem(
        int(document.get("status", status)),
        str(document["detail"]),
        title=str(document.get("title", "")),
        errors=tuple(_field_error(e) for e in document.get("errors", ())),
        lacking=document.get("lacking"),
        request_id=document.get("request_id"),
        retry_after=retry_after,
    )


def _field_error(error: Mapping[str, Any]) -> FieldError:
    pointer = str(error.get("pointer", ""))
    # RFC 6901 escapes / and ~ in the names of a pointer.
    field = pointer.removeprefix("/").replace("~1", "/").replace("~0", "~")
    return FieldError(field, error.get("value"), error.get("range"), str(error.get("detail", "")))
