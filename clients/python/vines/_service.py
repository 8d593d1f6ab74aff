"""Client of an HTTP service."""

from __future__ import annotations

import http.client
import json
import urllib.error
import urllib.parse
import urllib.request
from typing import Any

from ._client import Client
from ._problem import Incomplete, Problem, problem_of
from ._sweep import Lines


class Service(Client):
    """Sends requests to a running service.

    ``url`` is its address, such as ``http://127.0.0.1:8080``; ``key`` is the API key, for a service
    with ``--api-key-file``; ``timeout`` is the longest time in s without data. Requests raise
    ConnectionError or TimeoutError if the service cannot be reached.
    """

    def __init__(self, url: str, key: str | None = None, timeout: float = 600) -> None:
        scheme = urllib.parse.urlsplit(url).scheme
        if scheme not in ("http", "https"):
            raise ValueError(f"{url} is not an http:// or https:// address")
        self._url = url.rstrip("/")
        self._key = key
        self._timeout = timeout
        self._opener = urllib.request.build_opener(_NoRedirect)

    def __repr__(self) -> str:
        return f"Service({self._url!r})"  # without the key, which must not get into logs

    def _answer(self, verb: str, body: bytes) -> bytes:
        return self._read(f"/v1/{verb}", body)

    def _identify_file(self, record: bytes, query: str) -> bytes:
        return self._read(f"/v1/identify?{query}", record, "text/csv")

    def _lines(self, verb: str, body: bytes) -> Lines:
        with self._post(f"/v1/{verb}", body) as response:
            try:
                for line in response:
                    yield json.loads(line)
            except (OSError, http.client.HTTPException, ValueError) as broken:
                raise Incomplete(0, f"the stream was interrupted: {broken!r}") from broken
        yield {"type": "error", "status": 0, "detail": "the stream ended early"}

    def _read(self, target: str, body: bytes, kind: str = "application/json") -> bytes:
        with self._post(target, body, kind) as response:
            try:
                return response.read()
            except http.client.HTTPException as broken:
                raise ConnectionError(f"{self._url}: the answer was interrupted") from broken

    def _post(
        self, target: str, body: bytes, kind: str = "application/json"
    ) -> http.client.HTTPResponse:
        headers = {"Content-Type": kind, "Accept": "application/json"}
        if self._key is not None:
            headers["Authorization"] = f"Bearer {self._key}"
        request = urllib.request.Request(self._url + target, body, headers, method="POST")
        try:
            response: http.client.HTTPResponse = self._opener.open(request, timeout=self._timeout)
            return response
        except urllib.error.HTTPError as refused:
            with refused:
                raise _problem(refused) from None
        except urllib.error.URLError as lost:
            if isinstance(lost.reason, TimeoutError):
                raise TimeoutError(f"{self._url} did not answer in {self._timeout} s") from lost
            raise ConnectionError(f"{self._url} cannot be reached: {lost.reason}") from lost
        except http.client.HTTPException as broken:
            raise ConnectionError(f"{self._url} is not an HTTP service: {broken!r}") from broken


class _NoRedirect(urllib.request.HTTPRedirectHandler):
    """Refuses redirects. The service sends none, and the key would be sent to the new address."""

    def redirect_request(self, *_: Any) -> None:
        return None


def _problem(refused: urllib.error.HTTPError) -> Problem:
    text = refused.read().decode(errors="replace")
    try:
        document = json.loads(text)
    except ValueError:
        document = None
    seconds = refused.headers.get("Retry-After", "")
    return problem_of(
        document,
        status=refused.code,
        text=text if text and not text.lstrip().startswith("<") else str(refused.reason),
        retry_after=float(seconds) if seconds.isdigit() else None,
    )
