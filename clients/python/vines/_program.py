"""Client that runs the program `vines`, without a service."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Iterator
from typing import IO, Any

from ._client import Client
from ._problem import Incomplete, Problem, problem_of
from ._sweep import Lines

# Exit codes of the program.
_COMPLETE = 0
_USABLE = 3

# The last line of a stream, which is passed on once the exit code and stderr are known.
_DONE = b'{"type":"done"'

# Time limit in s for the program to end after SIGTERM.
_STOP = 5.0


class Program(Client):
    """Computes on this machine, without the limits of a service.

    ``path`` is the program's path, or its name on the PATH; ``threads`` is the number of threads of
    a sweep, 0: one per core. Requests raise FileNotFoundError if the program is missing.
    """

    def __init__(self, path: str | os.PathLike[str] = "vines", threads: int = 0) -> None:
        self._path = os.fspath(path)
        self._threads = threads

    def __repr__(self) -> str:
        return f"Program({self._path!r})"

    def _answer(self, verb: str, body: bytes) -> bytes:
        return self._run([verb], body)

    def _identify_file(self, record: bytes, query: str) -> bytes:
        return self._run(["identify", "-q", query], record)

    def _run(self, arguments: list[str], given: bytes) -> bytes:
        ended = subprocess.run([self._found(), *arguments], input=given, capture_output=True)
        if ended.returncode in (_COMPLETE, _USABLE) and ended.stdout:
            return ended.stdout
        raise _problem(ended.returncode, ended.stderr)

    def _lines(self, verb: str, body: bytes) -> Lines:
        threads = [] if verb == "continue" else ["--threads", str(self._threads)]
        command = [self._found(), verb, *threads]
        with tempfile.TemporaryFile() as given, tempfile.TemporaryFile() as said:
            given.write(body)
            given.seek(0)
            running = subprocess.Popen(command, stdin=given, stdout=subprocess.PIPE, stderr=said)
            assert running.stdout is not None
            done = {"type": "done"}
            try:
                for line in running.stdout:
                    if not line.endswith(b"\n"):
                        continue
                    if line.startswith(_DONE):
                        done = json.loads(line)
                    else:
                        yield json.loads(line)
                yield from _end(running.wait(), said, done)
            finally:
                running.stdout.close()
                _stop(running)

    def _found(self) -> str:
        found = shutil.which(self._path)
        if found is None:
            raise FileNotFoundError(
                f"program {self._path} was not found: put it on the PATH, name it in "
                "VINES_PROGRAM, or name a service in VINES_URL"
            )
        return found


def _end(code: int, said: IO[bytes], done: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Lines at the end of a service's stream, made from the program's exit code and stderr."""
    said.seek(0)
    text = said.read()
    if code == _COMPLETE:
        for line in text.decode(errors="replace").splitlines():
            yield {"type": "warning", "message": line.removeprefix("vines: ")}
        yield done
    elif code == _USABLE:
        yield {"type": "error", "status": 0, "detail": _sentence(text)}
    else:
        problem = _problem(code, text)
        # With a status the request was refused; without one the sweep was interrupted.
        raise problem if problem.status else Incomplete(0, problem.detail)


def _stop(running: subprocess.Popen[bytes]) -> None:
    if running.poll() is not None:
        return
    running.terminate()
    try:
        running.wait(_STOP)
    except subprocess.TimeoutExpired:
        running.kill()
        running.wait()


def _problem(code: int, said: bytes) -> Problem:
    try:
        return problem_of(json.loads(said))
    except ValueError:
        return Problem(0, _sentence(said) or f"vines {_how(code)}")


def _how(code: int) -> str:
    return f"ended with {code}" if code >= 0 else f"was ended by {signal.Signals(-code).name}"


def _sentence(said: bytes) -> str:
    return said.decode(errors="replace").strip().removeprefix("vines: ")
