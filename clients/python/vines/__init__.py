"""Exact simulation of a linear oscillator coupled with a vibro-impact nonlinear energy sink.

    import vines

    run = vines.simulate(preset="fig11", include=["regime", "energy"])
    print(run.regime.type, run.energy.rms_ratio)

    for point in vines.sweep(axes=[{"parameter": "b", "from": 0.01, "to": 0.05, "count": 9}]):
        print(point.b, point.regime, point.x_rms)

    for line in vines.continue_(base={"b": 0.015}, parameter="b", from_=0.005, to=0.03):
        if line.type == "special":
            print(line.kind, line.b)

    found = vines.identify("record.csv", preset="fig20", b=0.015)
    print(found.restitution.plus.R, found.verdict)

The functions send requests to the service at the address in VINES_URL, with the key in VINES_KEY if
set. Without VINES_URL they run the program in VINES_PROGRAM, or `vines` on the PATH. `Service` and
`Program` have the same functions.

`help(vines.SimulateFields)`, `SweepFields`, `BasinsFields`, `ContinueFields`, `DesignFields` and
`IdentifyFields` list the fields
with unit, range and default; `help(vines.Answer)` describes answers.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Unpack

from ._answer import Answer
from ._client import Client, Columns
from ._continuation import Continuation
from ._fields import (
    Axis,
    BasinsFields,
    ContinueFields,
    DesignFields,
    Distribution,
    Forcing,
    IdentifyFields,
    ManifoldFields,
    Perturbation,
    RestitutionTable,
    SimulateFields,
    Start,
    StartBox,
    SweepBase,
    SweepFields,
    Tolerances,
)
from ._problem import FieldError, Incomplete, PartialAnswer, Problem
from ._program import Program
from ._service import Service
from ._sweep import Sweep

if TYPE_CHECKING:
    from collections.abc import Callable

    import pandas

__all__ = [
    "Answer",
    "Axis",
    "BasinsFields",
    "Client",
    "Continuation",
    "ContinueFields",
    "DesignFields",
    "Distribution",
    "FieldError",
    "Forcing",
    "IdentifyFields",
    "Incomplete",
    "ManifoldFields",
    "PartialAnswer",
    "Perturbation",
    "Problem",
    "Program",
    "RestitutionTable",
    "Service",
    "SimulateFields",
    "Start",
    "StartBox",
    "Sweep",
    "SweepBase",
    "SweepFields",
    "Tolerances",
    "basins",
    "client",
    "continue_",
    "design",
    "identify",
    "manifold",
    "simulate",
    "sweep",
]


def client() -> Client:
    """The client chosen by the environment: the service at VINES_URL with VINES_KEY, else the
    program VINES_PROGRAM, else `vines` on the PATH."""
    url = os.environ.get("VINES_URL")
    if url:
        return Service(url, os.environ.get("VINES_KEY") or None)
    return Program(os.environ.get("VINES_PROGRAM") or "vines")


def simulate(**fields: Unpack[SimulateFields]) -> Answer:
    """`Client.simulate` of the client chosen by the environment."""
    return client().simulate(**fields)


def manifold(**fields: Unpack[ManifoldFields]) -> Answer:
    """`Client.manifold` of the client chosen by the environment."""
    return client().manifold(**fields)


def sweep(**fields: Unpack[SweepFields]) -> Sweep:
    """`Client.sweep` of the client chosen by the environment."""
    return client().sweep(**fields)


def basins(**fields: Unpack[BasinsFields]) -> Sweep:
    """`Client.basins` of the client chosen by the environment."""
    return client().basins(**fields)


def continue_(**fields: Unpack[ContinueFields]) -> Continuation:
    """`Client.continue_` of the client chosen by the environment."""
    return client().continue_(**fields)


def design(
    each: Callable[[Answer], object] | None = None, /, **fields: Unpack[DesignFields]
) -> Answer:
    """`Client.design` of the client chosen by the environment."""
    return client().design(each, **fields)


def identify(
    record: str | os.PathLike[str] | Columns | pandas.DataFrame | None = None,
    *,
    impacts: Columns | Answer | pandas.DataFrame | None = None,
    **fields: Unpack[IdentifyFields],
) -> Answer:
    """`Client.identify` of the client chosen by the environment."""
    return client().identify(record, impacts=impacts, **fields)
