"""SciPy: solve_ivp with a terminal event at each wall, restarted after each contact.

Answers the lines of peers.mjs as the C++ peers do (job.hpp), with the same closed form of the
ball's flight (flight.hpp). Uses Python floats, since NumPy's scalars are slower. LSODA was tried and
is slower at this accuracy.
"""
import json
import math
import sys
import time

import numpy
import scipy
from scipy.integrate import solve_ivp


def terminal(event):
    """Marks the event so that it ends the integration where it rises through zero."""
    event.terminal = True
    event.direction = 1
    return event


def stalled(contacts):
    """True if 200 contacts took next to no time: a chatter that does not end. As in job.cpp."""
    return len(contacts) >= 200 and contacts[-1][0] - contacts[-200][0] < 1e-3


def follow(job, contacts):
    """Appends the contacts; returns how the motion ends."""
    epsilon, R, b, Omega = job["epsilon"], job["R"], job["b"], job["Omega"]
    damping = epsilon * job["lambda"]
    forcing = epsilon * job["G"] * math.hypot(1, damping * Omega)
    phi = math.atan(damping * Omega)
    tau, tau_end, side = job["tau"], job["tau_end"], job["side"]
    x, x_dot, y_dot = job["x"], job["x_dot"], job["y_dot"]
    relative = side * b if side else x - job["y"]
    longest = job["longest_step"] or math.inf

    def acceleration(t, x, x_dot):
        return forcing * math.sin(Omega * t + phi) - damping * x_dot - x

    def derivative(t, m):
        x, x_dot = m.tolist()
        return (x_dot, forcing * math.sin(Omega * t + phi) - damping * x_dot - x)

    while tau < tau_end:
        start, x_start, relative_start, u = tau, x, relative, y_dot
        upper = terminal(lambda t, m: relative_start + (m.item(0) - x_start) - u * (t - start) - b)
        lower = terminal(lambda t, m: -relative_start - (m.item(0) - x_start) + u * (t - start) - b)
        press = side * acceleration(tau, x, x_dot)
        first = abs(x_dot - y_dot) / press if press > 0 else math.inf
        flight = solve_ivp(
            derivative, (tau, tau_end), numpy.array((x, x_dot)), job["solver"],
            events=(upper, lower), rtol=job["tolerance"], atol=job["tolerance"] * b,
            max_step=longest,
            first_step=first if 0 < first < min(1, longest, tau_end - tau) else None)
        if flight.status < 0:
            return flight.message
        tau, (x, x_dot) = float(flight.t[-1]), flight.y[:, -1].tolist()
        relative = relative_start + (x - x_start) - u * (tau - start)
        if flight.status == 0:
            if abs(relative) > b * (1 + 1e-6):
                return "through the wall"
            break
        side = 1 if relative > 0 else -1
        mean = (x_dot + epsilon * y_dot) / (1 + epsilon)
        speed = -R * (x_dot - y_dot)
        x_dot = mean + epsilon * speed / (1 + epsilon)
        y_dot = x_dot - speed
        relative = side * b
        contacts.append((tau, side))
        if stalled(contacts):
            return "stalled"
    return "tau_end"


def guarded(job):
    contacts = []
    try:
        end = follow(job, contacts)
    except ValueError as error:  # raised by the root search
        end = str(error)
    return contacts, end


def timed(job, seconds):
    """Same as in job.cpp."""
    spent, count = 0.0, 0
    while spent < seconds:
        start = time.process_time()
        count += len(guarded(job)[0])
        spent += time.process_time() - start
    return {"nanoseconds": 1e9 * spent / count}


for line in sys.stdin:
    asked = json.loads(line)
    if "method" not in asked:
        answer = {"versions": f"SciPy {scipy.__version__}, NumPy {numpy.__version__}, "
                              f"Python {sys.version.split()[0]}"}
    else:
        asked["solver"] = asked["method"]
        if "seconds" in asked:
            answer = timed(asked, asked["seconds"])
        else:
            contacts, end = guarded(asked)
            answer = {"tau": [c[0] for c in contacts], "side": [c[1] for c in contacts], "end": end}
    print(json.dumps(answer), flush=True)
