"""The way to answers by the program `vines`, without a service."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from typing import IO, Any

from ._client import Client
from ._problem import Incomplete, Problem, problem_of
from ._sweep import Lines

# Exit codes of the program.
_COMPLETE = 0
_USABLE = 3

# Seconds between two looks at a sweep's file, and in which the program ends when it is told to.
_LOOK = 0.02
_STOP = 5.0


class Program(Client):
    """The program, which computes on this machine, without the limits of a service.

    ``path`` is that of the program, or its name on the PATH; ``threads`` those of a sweep, 0: one
    for each core. Requests raise FileNotFoundError where there is none.
    """

    def __init__(self, path: str | os.PathLike[str] = "vines", threads: int = 0) -> None:
        self._path = os.fspath(path)
        self._threads = threads

    def __repr__(self) -> str:
        return f"Program({self._path!r})"

    def _simulate(self, body: bytes) -> Any:
        return self._answer(["simulate"], body)

    def _identify(self, body: bytes) -> Any:
        return self._answer(["identify"], body)

    def _identify_file(self, record: bytes, query: str) -> Any:
        return self._answer(["identify", "-q", query], record)

    def _answer(self, arguments: list[str], given: bytes) -> Any:
        ended = subprocess.run([self._found(), *arguments], input=given, capture_output=True)
        if ended.returncode in (_COMPLETE, _USABLE) and ended.stdout:
            return json.loads(ended.stdout)
        raise _problem(ended.returncode, ended.stderr)

    def _sweep(self, body: bytes) -> Lines:
        # On its stdout a sweep stands at the end, in order; in a file each point as it comes.
        with tempfile.TemporaryDirectory(prefix="vines-") as name:
            folder = pathlib.Path(name)
            (folder / "request.json").write_bytes(body)
            output = folder / "sweep.ndjson"
            command = [self._found(), "sweep", str(folder / "request.json"), "-o", str(output)]
            if self._threads:
                command += ["--threads", str(self._threads)]
            with (folder / "said").open("w+b") as said:
                running = subprocess.Popen(
                    command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=said
                )
                try:
                    yield from _lines(output, running)
                    yield from _end(running.returncode, said)
                finally:
                    _stop(running)

    def _found(self) -> str:
        found = shutil.which(self._path)
        if found is None:
            raise FileNotFoundError(
                f"there is no program {self._path}: put it on the PATH, name it in VINES_PROGRAM, "
                "or name a service in VINES_URL"
            )
        return found


def _lines(output: pathlib.Path, running: subprocess.Popen[bytes]) -> Iterator[dict[str, Any]]:
    """The lines of the file while it grows, each once, up to the last one."""
    seen: set[int] = set()
    started = False
    growing: IO[bytes] | None = None
    rest = b""
    try:
        while True:
            ended = running.poll() is not None
            if ended:
                # A complete file takes the place of the growing one, which has all but its end.
                if growing:
                    growing.close()
                growing, rest = (output.open("rb") if output.exists() else None), b""
            elif growing is None and output.exists():
                growing = output.open("rb")
            text = rest + (growing.read() if growing else b"")
            whole, _, rest = text.rpartition(b"\n")
            for line in map(json.loads, whole.splitlines()):
                if line["type"] == "start":
                    if not started:
                        yield line
                    started = True
                elif line["type"] == "point":
                    if line["index"] not in seen:
                        seen.add(line["index"])
                        yield line
                # The end is for the exit code to tell.
            if ended:
                return
            time.sleep(_LOOK)
    finally:
        if growing:
            growing.close()


def _end(code: int, said: IO[bytes]) -> Iterator[dict[str, Any]]:
    """What the program said when it ended, as a service's stream has it."""
    said.seek(0)
    text = said.read()
    if code == _COMPLETE:
        for line in text.decode(errors="replace").splitlines():
            yield {"type": "warning", "message": line.removeprefix("vines: ")}
        yield {"type": "done"}
    elif code == _USABLE:
        yield {"type": "error", "status": 0, "detail": _sentence(text)}
    else:
        problem = _problem(code, text)
        # A request at fault is none that broke off.
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
