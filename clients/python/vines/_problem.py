"""Why a request has no answer, or not all of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class FieldError:
    """A field at fault."""

    field: str
    """Its name; of a field within others its path, as in ``axes/0/from``."""
    value: Any
    """As it was given."""
    range: list[Any] | None
    """[minimum, maximum], or the choices, or None."""
    detail: str
    """A sentence."""


class Problem(Exception):
    """A request that the service or the program could not answer."""

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
        """As of HTTP, whichever way was asked; 0 where neither said one."""
        self.detail = detail
        """A sentence."""
        self.title = title
        self.errors = errors
        """Each field at fault."""
        self.lacking = lacking
        """Of 503: what the service has no more of."""
        self.request_id = request_id
        """By which the service's log names the request."""
        self.retry_after = retry_after
        """Of 503: seconds after which to ask again."""

    def __str__(self) -> str:
        # Where one field is at fault the document's detail is that field's.
        faults = [e.detail for e in self.errors if e.detail != self.detail]
        told = "; ".join([self.detail, *faults])
        return f"{self.status}: {told}" if self.status else told


class Incomplete(Problem):
    """A sweep whose points did not all come. Those that came are good; ``missing`` of the sweep
    are the ``indices`` to ask for."""


class PartialAnswer(UserWarning):
    """A simulation that did not come to its end: its ``status`` says why, and how far it came."""


def problem_of(
    document: object, *, status: int = 0, text: str = "", retry_after: float | None = None
) -> Problem:
    """The problem of a problem document (RFC 9457); of `status` and `text` where it is none."""
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
    # RFC 6901 escapes these two in the names that a pointer consists of.
    field = pointer.removeprefix("/").replace("~1", "/").replace("~0", "~")
    return FieldError(field, error.get("value"), error.get("range"), str(error.get("detail", "")))
