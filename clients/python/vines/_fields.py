"""The fields of the requests. Made by fields.py from the OpenAPI document."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, TypedDict

NUMBER_LISTS = frozenset({
    "C", "J", "M", "M_condition", "R", "T", "V", "V_velocity", "asked", "asked_s",
    "contacts", "cycles_with", "distance", "final", "im", "impact_speed", "impacts",
    "impulse", "impulse_N_s", "lambda", "lambda1", "lambda2", "lambda3", "lambda4",
    "modulus", "momentum_error", "phase", "pulse_spoils_s", "re", "relative_speed",
    "relative_speed_ratio", "rounding_floor", "side", "standard_error", "tau", "tau_end",
    "tau_start", "time_difference", "time_difference_s", "time_end_s", "time_s",
    "time_start_s", "values", "window", "window_s", "x", "x_acceleration",
    "x_acceleration_before", "x_ddot", "x_ddot_before", "x_dot", "x_dot_after",
    "x_dot_before", "x_velocity", "x_velocity_after", "x_velocity_before", "y", "y_dot",
    "y_dot_after", "y_dot_before", "y_velocity", "y_velocity_after", "y_velocity_before",
    "z",
})

Perturbation = TypedDict(
    "Perturbation",
    {
        "x": float,
        "x_dot": float,
        "y": float,
        "y_dot": float,
        "seed": int,
        "size": float,
    },
    total=False,
)
Perturbation.__doc__ = """An object of these keys.

x: is added to x0 (m); -1000 to 1000; default: 0
x_dot: is added to x_dot0 (m per unit of tau); -1000 to 1000; default: 0
y: is added to y0 (m); -2000 to 2000; default: 0
y_dot: is added to y_dot0 (m per unit of tau); -1000 to 1000; default: 0
seed: of a random direction in (x', x, y', y), the same on every machine; with size; 0 to
    9.0072e+15; default: 1
size: Euclidean length of that difference; default: none; 1e-18 to 1000
"""

SweepBase = TypedDict(
    "SweepBase",
    {
        "preset": str,
        "b": float,
        "R": float,
        "R_plus": float,
        "R_minus": float,
        "damping": Literal["equation_of_motion", "closed_form"],
        "epsilon": float,
        "lambda": float,
        "G": float,
        "Omega": float,
        "m1": float,
        "f0": float,
        "k1": float,
        "damping_ratio": float,
        "c1": float,
        "mass_ratio": float,
        "m2": float,
        "F": float,
        "f": float,
        "x0": float,
        "x_dot0": float,
        "x_velocity0": float,
        "y0": float,
        "y_dot0": float,
        "y_velocity0": float,
        "max_impacts": int,
    },
    total=False,
)
SweepBase.__doc__ = """An object of these keys.

preset: start from a figure or table of the paper (GET /v1/presets); each other field
    replaces its own value alone; default: none
b: half-width of the cavity in which the free mass moves (m, b); 1e-09 to 1000; default:
    0.022
R: restitution coefficient of both walls; not together with R_plus or R_minus
    (dimensionless, R); 0 to 1; default: 0.6
R_plus: restitution coefficient of the wall met where x - y = +b (dimensionless, R+);
    default: R; 0 to 1
R_minus: restitution coefficient of the wall met where x - y = -b (dimensionless, R-);
    default: R; 0 to 1
damping: equation_of_motion: zeta = epsilon lambda/2, eqs. (1), (6), (17), what c1 means;
    closed_form: zeta = epsilon lambda, eqs. (8)-(11), (19), (20), what the paper's numbers
    were computed with; default: "equation_of_motion"
epsilon: mass ratio m2/m1 (dimensionless, epsilon); default: from the SI fields if any is
    given; 1e-09 to 10; default: 0.008405568689256633
lambda: damping c1/(m2 omega0) (dimensionless, lambda); default: from the SI fields if any
    is given; 0 to 1e+09; default: 1.427383130909598
G: amplitude of the base over epsilon (m, G); default: from the SI fields if any is given; 0
    to 1000; default: 0.02
Omega: forcing frequency over omega0 (dimensionless, Omega); default: from the SI fields if
    any is given; 0.001 to 100; default: 1.0
m1: mass of the linear oscillator; SI and reduced fields cannot be mixed (kg, m1); default:
    none: a system in SI is given as a whole, or a preset for the rest; 1e-09 to 1e+09
f0: its natural frequency sqrt(k1/m1)/(2 pi), in place of k1 (Hz, f0); default: from k1;
    1e-09 to 1e+09
k1: its stiffness (N/m, k1); default: none: a system in SI is given as a whole, or a preset
    for the rest; 1e-09 to 1e+15
damping_ratio: its damping ratio, in place of c1 (dimensionless, c1/(2 m1 omega0)); default:
    from c1; 0 to 10
c1: its damping (N s/m, c1); default: none: a system in SI is given as a whole, or a preset
    for the rest; 0 to 1e+12
mass_ratio: mass of the absorber over m1, in place of m2 (dimensionless, m2/m1); default:
    from m2; 1e-09 to 10
m2: mass of the absorber (kg, m2); default: none: a system in SI is given as a whole, or a
    preset for the rest; 1e-12 to 1e+09
F: amplitude of the base, which moves by F sin(2 pi f t) (m, F); default: none: a system in
    SI is given as a whole, or a preset for the rest; 0 to 1000
f: forcing frequency (Hz, f); default: none: a system in SI is given as a whole, or a preset
    for the rest; 1e-09 to 1e+09
x0: displacement of the linear oscillator at tau = 0 (m, x(0)); -1000 to 1000; default: 0
x_dot0: its velocity (m per unit of tau, x'(0)); -1000 to 1000; default: 0
x_velocity0: the same in m/s, for a system in SI (m/s, dx/dt(0)); default: from x_dot0;
    -1e+09 to 1e+09
y0: displacement of the free mass; |x0 - y0| <= b (m, y(0)); default: 0.95 b; -2000 to 2000
y_dot0: its velocity (m per unit of tau, y'(0)); -1000 to 1000; default: 0
y_velocity0: the same in m/s, for a system in SI (m/s, dy/dt(0)); default: from y_dot0;
    -1e+09 to 1e+09
max_impacts: end the run after so many impacts; 1 to 2e+06; default: 100000
"""

Axis = TypedDict(
    "Axis",
    {
        "parameter": str,
        "from": float,
        "to": float,
        "count": int,
        "scale": Literal["linear", "log"],
        "values": Iterable[float],
    },
    total=False,
)
Axis.__doc__ = """An object of these keys.

parameter: any number of system, reduced, SI or start; default: required
from: first value; default: required without values; -1e+300 to 1e+300
to: last value; default: required without values; -1e+300 to 1e+300
count: number of values; 1 to 1e+06; default: 2
scale: spacing; default: "linear"
values: the values themselves, in place of from, to, count, scale; default: from, to, count
"""

Start = TypedDict(
    "Start",
    {
        "x0": float,
        "x_dot0": float,
        "x_velocity0": float,
        "y0": float,
        "y_dot0": float,
        "y_velocity0": float,
    },
    total=False,
)
Start.__doc__ = """An object of these keys.

x0: displacement of the linear oscillator at tau = 0 (m, x(0)); -1000 to 1000; default: 0
x_dot0: its velocity (m per unit of tau, x'(0)); -1000 to 1000; default: 0
x_velocity0: the same in m/s, for a system in SI (m/s, dx/dt(0)); default: from x_dot0;
    -1e+09 to 1e+09
y0: displacement of the free mass; |x0 - y0| <= b (m, y(0)); default: 0.95 b; -2000 to 2000
y_dot0: its velocity (m per unit of tau, y'(0)); -1000 to 1000; default: 0
y_velocity0: the same in m/s, for a system in SI (m/s, dy/dt(0)); default: from y_dot0;
    -1e+09 to 1e+09
"""

class SimulateFields(TypedDict, total=False):
    """Fields of a simulation.

    preset: start from a figure or table of the paper (GET /v1/presets); each other field
        replaces its own value alone; default: none
    b: half-width of the cavity in which the free mass moves (m, b); 1e-09 to 1000; default:
        0.022
    R: restitution coefficient of both walls; not together with R_plus or R_minus
        (dimensionless, R); 0 to 1; default: 0.6
    R_plus: restitution coefficient of the wall met where x - y = +b (dimensionless, R+);
        default: R; 0 to 1
    R_minus: restitution coefficient of the wall met where x - y = -b (dimensionless, R-);
        default: R; 0 to 1
    damping: equation_of_motion: zeta = epsilon lambda/2, eqs. (1), (6), (17), what c1 means;
        closed_form: zeta = epsilon lambda, eqs. (8)-(11), (19), (20), what the paper's numbers
        were computed with; default: "equation_of_motion"
    epsilon: mass ratio m2/m1 (dimensionless, epsilon); default: from the SI fields if any is
        given; 1e-09 to 10; default: 0.008405568689256633
    lambda_: damping c1/(m2 omega0) (dimensionless, lambda); default: from the SI fields if any
        is given; 0 to 1e+09; default: 1.427383130909598
    G: amplitude of the base over epsilon (m, G); default: from the SI fields if any is given; 0
        to 1000; default: 0.02
    Omega: forcing frequency over omega0 (dimensionless, Omega); default: from the SI fields if
        any is given; 0.001 to 100; default: 1.0
    m1: mass of the linear oscillator; SI and reduced fields cannot be mixed (kg, m1); default:
        none: a system in SI is given as a whole, or a preset for the rest; 1e-09 to 1e+09
    f0: its natural frequency sqrt(k1/m1)/(2 pi), in place of k1 (Hz, f0); default: from k1;
        1e-09 to 1e+09
    k1: its stiffness (N/m, k1); default: none: a system in SI is given as a whole, or a preset
        for the rest; 1e-09 to 1e+15
    damping_ratio: its damping ratio, in place of c1 (dimensionless, c1/(2 m1 omega0)); default:
        from c1; 0 to 10
    c1: its damping (N s/m, c1); default: none: a system in SI is given as a whole, or a preset
        for the rest; 0 to 1e+12
    mass_ratio: mass of the absorber over m1, in place of m2 (dimensionless, m2/m1); default:
        from m2; 1e-09 to 10
    m2: mass of the absorber (kg, m2); default: none: a system in SI is given as a whole, or a
        preset for the rest; 1e-12 to 1e+09
    F: amplitude of the base, which moves by F sin(2 pi f t) (m, F); default: none: a system in
        SI is given as a whole, or a preset for the rest; 0 to 1000
    f: forcing frequency (Hz, f); default: none: a system in SI is given as a whole, or a preset
        for the rest; 1e-09 to 1e+09
    x0: displacement of the linear oscillator at tau = 0 (m, x(0)); -1000 to 1000; default: 0
    x_dot0: its velocity (m per unit of tau, x'(0)); -1000 to 1000; default: 0
    x_velocity0: the same in m/s, for a system in SI (m/s, dx/dt(0)); default: from x_dot0;
        -1e+09 to 1e+09
    y0: displacement of the free mass; |x0 - y0| <= b (m, y(0)); default: 0.95 b; -2000 to 2000
    y_dot0: its velocity (m per unit of tau, y'(0)); -1000 to 1000; default: 0
    y_velocity0: the same in m/s, for a system in SI (m/s, dy/dt(0)); default: from y_dot0;
        -1e+09 to 1e+09
    tau_end: how long to run; not together with cycles (dimensionless, tau); 1e-06 to 1e+07;
        default: 1709
    cycles: how many forcing cycles of 2 pi/Omega to run (dimensionless); default: from tau_end;
        1e-06 to 1e+06
    window: the exponents are taken from the first impact at or after tau_s to the last at or
        before tau_e; regime, energy, section, eigenvalues and manifold are those of the window,
        too (dimensionless, [tau_s, tau_e]); default: the whole run
    windows: more windows, for which the exponents are given without histories (dimensionless,
        [[tau_s, tau_e], ...]); default: []
    perturbation: a second run that starts a little off, and how its distance from the first one
        grows: either the difference {x, x_dot, y, y_dot} of the start, or a random one {seed,
        size}; default: none
    include: parts of the answer; default: ["series", "impacts", "exponents"]
    exponents: estimators of the Lyapunov exponents: qr (Benettin), eigenvalues (33),
        raw_product ((33) unscaled in double precision, as in the paper); default: ["qr",
        "eigenvalues", "raw_product"]
    samples_per_cycle: samples of the series per forcing cycle (dimensionless); 1 to 10000;
        default: 32
    section_phase: phase of the stroboscopic section after each whole cycle (rad); 0 to 6.28319;
        default: 0
    max_points: longest series and histories; a longer series gets a larger step, longer
        histories are thinned; 256 to 1e+06; default: 20000
    max_impacts: end the run after so many impacts; 1 to 2e+06; default: 100000
    fields: what is kept of the answer: names and paths with points, as in impacts.tau; version,
        status, warnings and provenance always are. What is not kept is not computed, unless
        include says so; default: everything
    """

    preset: str
    b: float
    R: float
    R_plus: float
    R_minus: float
    damping: Literal["equation_of_motion", "closed_form"]
    epsilon: float
    lambda_: float
    G: float
    Omega: float
    m1: float
    f0: float
    k1: float
    damping_ratio: float
    c1: float
    mass_ratio: float
    m2: float
    F: float
    f: float
    x0: float
    x_dot0: float
    x_velocity0: float
    y0: float
    y_dot0: float
    y_velocity0: float
    tau_end: float
    cycles: float
    window: Iterable[float]
    windows: Iterable[Iterable[float]]
    perturbation: Perturbation
    include: Iterable[Literal["series", "impacts", "exponents", "eigenvalues", "matrices", "section", "energy", "regime", "manifold"]]
    exponents: Iterable[Literal["qr", "eigenvalues", "raw_product"]]
    samples_per_cycle: float
    section_phase: float
    max_points: int
    max_impacts: int
    fields: Iterable[str]

class SweepFields(TypedDict, total=False):
    """Fields of a sweep.

    base: fields of /v1/simulate that all points share: system, reduced or SI, start, preset,
        max_impacts; default: {}
    axes: one to three: {parameter, from, to, count, scale} or {parameter, values}; the index of
        a point counts along the first axis fastest; default: required
    starts: initial states {x0, x_dot0, y0, y_dot0}, each run at every point, to show coexisting
        attractors; or "default set": at rest in the middle, at a wall, moving, and the last
        states of both neighbours on the first axis, of which a line tells the worst and the
        best by x_max; default: []
    cycles: forcing cycles that are measured at each point (dimensionless); 1 to 1e+06; default:
        1000
    transient_cycles: forcing cycles run before them (dimensionless); 0 to 1e+06; default: 200
    carry_state: none: each point starts afresh; up, down: from the last state of its neighbour
        on the first axis, in ascending or descending order of the axis' entries; default:
        "none"
    section: points for a bifurcation diagram: at impact or at whole forcing cycles; default:
        "none"
    section_points: the last so many points of the section are given at each point
        (dimensionless); 1 to 100000; default: 100
    section_phase: phase of the stroboscopic section after each whole cycle (rad); 0 to 6.28319;
        default: 0
    reduce: "max over f": of the points along that axis only the largest x_max and where it is,
        as x_peak; or "min over f"; default: none: a line for each point
    indices: only these points: those that a broken stream did not bring; default: all
    """

    base: SweepBase
    axes: Iterable[Axis]
    starts: Iterable[Start] | Literal["default set"]
    cycles: int
    transient_cycles: int
    carry_state: Literal["none", "up", "down"]
    section: Literal["none", "impact", "stroboscopic"]
    section_points: int
    section_phase: float
    reduce: str
    indices: Iterable[int]

class IdentifyFields(TypedDict, total=False):
    """Fields of an identification.

    preset: start from a figure or table of the paper (GET /v1/presets); each other field
        replaces its own value alone; default: none
    b: half-width of the cavity in which the free mass moves (m, b); 1e-09 to 1000; default:
        0.022
    R: restitution coefficient of both walls; not together with R_plus or R_minus
        (dimensionless, R); default: estimated, each wall's from its impacts; 0 to 1
    R_plus: restitution coefficient of the wall met where x - y = +b (dimensionless, R+);
        default: R; 0 to 1
    R_minus: restitution coefficient of the wall met where x - y = -b (dimensionless, R-);
        default: R; 0 to 1
    damping: equation_of_motion: zeta = epsilon lambda/2, eqs. (1), (6), (17), what c1 means;
        closed_form: zeta = epsilon lambda, eqs. (8)-(11), (19), (20), what the paper's numbers
        were computed with; default: "equation_of_motion"
    epsilon: mass ratio m2/m1 (dimensionless, epsilon); default: from the SI fields if any is
        given; 1e-09 to 10; default: 0.008405568689256633
    lambda_: damping c1/(m2 omega0) (dimensionless, lambda); default: from the SI fields if any
        is given; 0 to 1e+09; default: 1.427383130909598
    G: amplitude of the base over epsilon; of a record it is fitted (m, G); default: from the SI
        fields if any is given; 0 to 1000; default: 0.02
    Omega: forcing frequency over omega0 (dimensionless, Omega); default: from the SI fields if
        any is given; 0.001 to 100; default: 1.0
    m1: mass of the linear oscillator; SI and reduced fields cannot be mixed (kg, m1); default:
        required for a record, or a preset: they give omega0, by which time is scaled; 1e-09 to
        1e+09
    f0: its natural frequency sqrt(k1/m1)/(2 pi), in place of k1 (Hz, f0); default: from k1;
        1e-09 to 1e+09
    k1: its stiffness (N/m, k1); default: required for a record, or a preset: they give omega0,
        by which time is scaled; 1e-09 to 1e+15
    damping_ratio: its damping ratio, in place of c1 (dimensionless, c1/(2 m1 omega0)); default:
        from c1; 0 to 10
    c1: its damping (N s/m, c1); default: none: a system in SI is given as a whole, or a preset
        for the rest; 0 to 1e+12
    mass_ratio: mass of the absorber over m1, in place of m2 (dimensionless, m2/m1); default:
        from m2; 1e-09 to 10
    m2: mass of the absorber (kg, m2); default: none: a system in SI is given as a whole, or a
        preset for the rest; 1e-12 to 1e+09
    F: amplitude of the base, which moves by F sin(2 pi f t); of a record it is fitted (m, F);
        default: none: a system in SI is given as a whole, or a preset for the rest; 0 to 1000
    f: forcing frequency (Hz, f); default: none: a system in SI is given as a whole, or a preset
        for the rest; 1e-09 to 1e+09
    exponents: estimators of the Lyapunov exponents: qr (Benettin), eigenvalues (33),
        raw_product ((33) unscaled in double precision, as in the paper); default: ["qr",
        "eigenvalues", "raw_product"]
    max_points: longest series and histories; a longer series gets a larger step, longer
        histories are thinned; 256 to 1e+06; default: 20000
    include: parts of the answer beside the usual ones, of a record: motion, the fitted motion
        at its samples; direct_exponents, those of the paper's direct estimate with their
        histories; default: []
    fixed: what of a record is not fitted but taken as given: f, F, phase, omega0, zeta, b and R
        by the other fields, a sensor without fault; default: []
    phase: of the base, which moves by F sin(2 pi f t + phase), t as in the record: where it is
        fixed (rad); default: fitted; where it is fixed that of a channel of the forcing; -7 to
        7
    time_column: name of the column of time; default: time_s, or one that begins with time or t
    displacement_column: name of the column of displacement; default: displacement_m, or one
        that begins with displacement or x
    acceleration_column: name of the column of acceleration; default: acceleration_m_s2, or one
        that begins with acceleration or a
    base_acceleration_column: name of the column of the base's acceleration, which tells the
        forcing; default: base_acceleration_m_s2, or one that begins with base_acceleration;
        none is needed
    force_column: name of the column of a force on m1 that drives it, in place of the base;
        default: force_N, or one that begins with force; none is needed
    time_unit: unit of time, where neither the column's name nor a row of units says one;
        default: "s"
    displacement_unit: unit of displacement, where neither the column's name nor a row of units
        says one; default: "m"
    acceleration_unit: unit of acceleration, where neither the column's name nor a row of units
        says one; default: "m/s2"
    base_acceleration_unit: unit of the base's acceleration, where neither the column's name nor
        a row of units says one; default: "m/s2"
    force_unit: unit of the force, where neither the column's name nor a row of units says one;
        default: "N"
    threshold: height from which on a spike of the acceleration may be an impact (standard
        deviations of the noise); 3 to 1000; default: 6
    impact_times_s: moments of the impacts, from an edited list: then they are not searched for
        (s); default: found from the record
    fields: what is kept of the answer: names and paths with points, as in impacts.tau; version,
        status, warnings and provenance always are. What is not kept is not computed, unless
        include says so; default: everything
    """

    preset: str
    b: float
    R: float
    R_plus: float
    R_minus: float
    damping: Literal["equation_of_motion", "closed_form"]
    epsilon: float
    lambda_: float
    G: float
    Omega: float
    m1: float
    f0: float
    k1: float
    damping_ratio: float
    c1: float
    mass_ratio: float
    m2: float
    F: float
    f: float
    exponents: Iterable[Literal["qr", "eigenvalues", "raw_product"]]
    max_points: int
    include: Iterable[Literal["motion", "direct_exponents"]]
    fixed: Iterable[Literal["f", "F", "phase", "displacement_offset", "displacement_drift", "displacement_gain", "displacement_delay_s", "acceleration_offset", "acceleration_drift", "omega0", "zeta", "b", "R_plus", "R_minus"]]
    phase: float
    time_column: str
    displacement_column: str
    acceleration_column: str
    base_acceleration_column: str
    force_column: str
    time_unit: Literal["s", "ms"]
    displacement_unit: Literal["m", "mm", "um"]
    acceleration_unit: Literal["m/s2", "g"]
    base_acceleration_unit: Literal["m/s2", "g"]
    force_unit: Literal["N", "kN"]
    threshold: float
    impact_times_s: Iterable[float]
    fields: Iterable[str]
