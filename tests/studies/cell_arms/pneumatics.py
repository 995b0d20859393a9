"""Device and contact at each step of the engine: two chambers behind orifices, regulator, end stops, seals as a Maxwell slip, a ball on a straight edge.

Flow through an orifice as for an ideal gas, choked or subsonic, in either direction (ISO 6358 gives the ratio); chambers isothermal. Contact along the edge's outward bisector, pushing only.
"""
import math

import numba
import numpy as np

R, T, GAMMA, ATMOSPHERE = 287.05, 293.15, 1.4, 101325.0
CRITICAL = (2 / (GAMMA + 1)) ** (GAMMA / (GAMMA - 1))
CHOKED = math.sqrt(GAMMA * (2 / (GAMMA + 1)) ** ((GAMMA + 1) / (GAMMA - 1)))
SUBSTEPS = 2
SLIDING = 1e-3  # Speed along the edge at which the tool's friction is nearly full [m/s].
# Shares of the seals' elements, and the stroke over which each of them yields [m].
SHARES = np.array([0.3, 0.3, 0.2, 0.2])
YIELDS = np.array([8e-6, 2e-5, 4e-5, 7e-5])

# Places of numbers in the array that a step takes.
NAMES = ("area_1", "area_2", "rod_area", "stroke", "dead_volume", "supply", "exhaust", "discharge", "gain", "time_constant", "delay", "stop_stiffness", "stop_damping", "leak_across", "leak_outside",
         "coulomb", "viscous", "axial_force", "stiffness", "damping", "friction", "radius", "edge_length", "shift", "tilt", "burr_height", "burr_position", "burr_half_length", "runout", "runout_hz")
AT = {name: i for i, name in enumerate(NAMES)}
(AREA_1, AREA_2, ROD_AREA, STROKE, DEAD, SUPPLY, EXHAUST, DISCHARGE, GAIN, CONSTANT, DELAY, STOP_K, STOP_C, LEAK_ACROSS, LEAK_OUTSIDE,
 COULOMB, VISCOUS, AXIAL, STIFFNESS, DAMPING, FRICTION, RADIUS, LENGTH, SHIFT, TILT, BURR_H, BURR_P, BURR_W, RUNOUT, RUNOUT_HZ) = range(len(NAMES))


@numba.njit(cache=True)
def flow(area, a, b):
    """Mass flow from pressure a to pressure b [kg/s]."""
    up, down = max(a, b), min(a, b)
    ratio = down / up
    f = CHOKED if ratio < CRITICAL else math.sqrt(max(2 * GAMMA / (GAMMA - 1) * (ratio ** (2 / GAMMA) - ratio ** ((GAMMA + 1) / GAMMA)), 0.0))
    out = area * up / math.sqrt(R * T) * f
    return out if a >= b else -out


@numba.njit(cache=True)
def rates(n, p1, p2, outlet, x, v):
    c = n[DISCHARGE]
    across = flow(n[LEAK_ACROSS] * c, p1, p2)
    into_1 = flow(n[SUPPLY] * c, outlet + ATMOSPHERE, p1) - across - flow(n[LEAK_OUTSIDE] * c, p1, ATMOSPHERE)
    into_2 = across - flow(n[EXHAUST] * c, p2, ATMOSPHERE)
    v1, v2 = n[DEAD] + n[AREA_1] * x, n[DEAD] + n[AREA_2] * (n[STROKE] - x)
    return (R * T * into_1 - p1 * n[AREA_1] * v) / v1, (R * T * into_2 + p2 * n[AREA_2] * v) / v2


@numba.njit(cache=True)
def bump(n, s):
    """Height of the burr at a place along the edge [m] and its slope [1]: a squared cosine."""
    if n[BURR_H] == 0.0 or abs(s - n[BURR_P]) >= n[BURR_W]:
        return 0.0, 0.0
    u = (s - n[BURR_P]) / n[BURR_W]
    c = math.cos(0.5 * math.pi * u)
    return n[BURR_H] * c * c, -n[BURR_H] * math.pi * c * math.sin(0.5 * math.pi * u) / n[BURR_W]


@numba.njit(cache=True)
def step(n, state, elements, edge, time, dt, set_pressure, x, v, place, turn, ball_at, velocity, com, out):
    """Forces at the start of a step and the chambers at its end. `state`: pressures of chambers, outlet (gauge). `edge`: first point, direction, bisector. `velocity` of the moving
    part: angular, then linear at `com`. `out`: force on the slide, contact force, three of the force on the ball, three of its point, gap."""
    p1, p2, outlet = state
    # The seals, bent by the stroke since the step before.
    seal = 0.0
    if n[COULOMB] > 0:
        for i in range(elements.size - 1):
            limit = SHARES[i] * n[COULOMB]
            elements[i] = min(max(elements[i] + limit / YIELDS[i] * (x - elements[-1]), -limit), limit)
            seal += elements[i]
    elements[-1] = x
    force = p1 * n[AREA_1] - p2 * n[AREA_2] - ATMOSPHERE * n[ROD_AREA] - seal - n[VISCOUS] * v + n[AXIAL]
    if x < 0:
        force += max(0.0, -n[STOP_K] * x - n[STOP_C] * v)
    elif x > n[STROKE]:
        force -= max(0.0, n[STOP_K] * (x - n[STROKE]) + n[STOP_C] * v)
    out[0] = force
    # The ball on the edge.
    ball, speed = np.empty(3), np.empty(3)
    for i in range(3):
        ball[i] = place[i] + turn[i, 2] * ball_at
    arm = ball - com
    speed[0] = velocity[3] + velocity[1] * arm[2] - velocity[2] * arm[1]
    speed[1] = velocity[4] + velocity[2] * arm[0] - velocity[0] * arm[2]
    speed[2] = velocity[5] + velocity[0] * arm[1] - velocity[1] * arm[0]
    away = ball - edge[0]
    s, along = np.dot(away, edge[1]), np.dot(speed, edge[1])
    height, slope = bump(n, s)
    turning = 2 * math.pi * n[RUNOUT_HZ]
    outward = n[SHIFT] + n[TILT] * (s - 0.5 * n[LENGTH]) + height + n[RUNOUT] * math.sin(turning * time)
    rate = (n[TILT] + slope) * along + n[RUNOUT] * turning * math.cos(turning * time) - np.dot(speed, edge[2])
    depth = n[RADIUS] + outward - np.dot(away, edge[2])
    pushing = max(0.0, n[STIFFNESS] * depth + n[DAMPING] * rate) if depth > 0 else 0.0
    drag = n[FRICTION] * pushing * math.tanh(along / SLIDING)
    out[1] = pushing
    for i in range(3):
        out[2 + i] = pushing * edge[2, i] - drag * edge[1, i]
        out[5 + i] = ball[i] - n[RADIUS] * edge[2, i]
    out[8] = -depth
    # Heun's method, the slide going on at its speed.
    h = dt / SUBSTEPS
    for k in range(SUBSTEPS):
        here, there = x + k * h * v, x + (k + 1) * h * v
        after = n[GAIN] * set_pressure + (outlet - n[GAIN] * set_pressure) * math.exp(-h / n[CONSTANT])
        a1, a2 = rates(n, p1, p2, outlet, here, v)
        b1, b2 = rates(n, p1 + h * a1, p2 + h * a2, after, there, v)
        p1, p2, outlet = p1 + 0.5 * h * (a1 + b1), p2 + 0.5 * h * (a2 + b2), after
    state[0], state[1], state[2] = p1, p2, outlet


@numba.njit(cache=True)
def lag(command, hold, bandwidth):
    """Motor's angle, speed and acceleration on a grid `hold` times as fine as the commands' (0.002 s), behind a critically damped lag of a bandwidth [Hz]; commands joined by straight lines."""
    w, h = 2 * math.pi * bandwidth, 0.002 / hold
    decay = math.exp(-w * h)
    count = (command.size - 1) * hold + 1
    q, v, a = np.zeros(count), np.zeros(count), np.zeros(count)
    # Departure from the steady response to a ramp, which is late by 2/w: it decays as (c1 + c2 t) exp(-w t).
    q[0] = command[0]
    for i in range(command.size - 1):
        slope = (command[i + 1] - command[i]) / (hold * h)
        for k in range(hold):
            j = i * hold + k
            u, du = q[j] - (command[i] + slope * (k * h - 2 / w)), v[j] - slope
            b = du + w * u
            q[j + 1] = command[i] + slope * ((k + 1) * h - 2 / w) + (u + b * h) * decay
            v[j + 1] = slope + (b - w * (u + b * h)) * decay
    for j in range(count):
        i = min(j // hold, command.size - 2)
        reference = command[i] + (command[i + 1] - command[i]) * (j - i * hold) / hold
        a[j] = w * w * (reference - q[j]) - 2 * w * v[j]
    return q, v, a
