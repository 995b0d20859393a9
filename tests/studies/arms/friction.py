"""Friction as a generalised Maxwell slip: elements in parallel that stick and slip, with a Stribeck curve and a lag while they slip.

Source: Al-Bender, Lampaert, Swevers, The generalized Maxwell-slip model, IEEE Transactions on Automatic Control 50 (2005), 1883. The tool's own law is another: bristles of one stiffness.
"""
import numba
import numpy as np

# Shares of the elements, and the way over which each of them yields [rad or m].
SHARES = np.array([0.22, 0.24, 0.2, 0.18, 0.16])
YIELDS = np.array([2e-5, 5e-5, 9e-5, 1.5e-4, 2.8e-4])
LAG = 0.004  # Time in which the elements reach the Stribeck curve while they slip [s].


@numba.njit(cache=True)
def step(elements, moved, dt, sliding, stiff):
    """One step: `moved` [rad], sliding friction at this speed [N m], `stiff` friction that the stiffness of elements is of [N m]; their sum."""
    total = 0.0
    for i in range(elements.size):
        limit = SHARES[i] * sliding
        force = elements[i]
        trial = force + SHARES[i] * stiff / YIELDS[i] * moved
        if abs(trial) <= limit:
            elements[i] = trial
        else:
            sign = 1.0 if trial > 0 else -1.0
            # What was held beyond the curve (it fell as the joint started) goes with the lag, not at once.
            held = max(sign * force, 0.0)
            elements[i] = sign * (limit + (held - limit) * np.exp(-dt / LAG) if held > limit else limit)
        total += elements[i]
    return total


@numba.njit(cache=True)
def along(position, dt, sliding, stiff, start):
    """Dry friction along a measured motion [N m], from elements that are bent by `start` of their limit."""
    elements = SHARES * sliding[0] * start
    out = np.zeros(position.size)
    for i in range(position.size):
        out[i] = step(elements, position[i] - position[max(i - 1, 0)], dt, sliding[i], stiff)
    return out


@numba.njit(cache=True)
def servo(command, dt, inertia, bandwidth, load, held, coulomb, static, stribeck_speed, viscous, start):
    """A joint behind its servo: position on the motor's side, speed, acceleration. `load` is what the motion asks for [N m], `held` what the servo adds beforehand."""
    n = command.size
    q, v, a = np.zeros(n), np.zeros(n), np.zeros(n)
    elements = SHARES * coulomb * start
    position, speed, before = command[0], 0.0, command[0]
    for i in range(n):
        aim = (command[min(i + 1, n - 1)] - command[max(i - 1, 0)]) / (dt * (min(i + 1, n - 1) - max(i - 1, 0)))
        wanted = (command[min(i + 1, n - 1)] - 2 * command[i] + command[max(i - 1, 0)]) / dt**2 if 0 < i < n - 1 else 0.0
        sliding = coulomb + (static - coulomb) * np.exp(-((speed / stribeck_speed) ** 2))
        dry = step(elements, position - before, dt, sliding, max(coulomb, 1e-9))
        drive = inertia * (bandwidth**2 * (command[i] - position) + 2 * bandwidth * (aim - speed)) + held[i] + viscous * aim
        acceleration = wanted + (drive - load[i] - dry - viscous * speed) / inertia
        q[i], v[i], a[i] = position, speed, acceleration
        before = position
        speed += acceleration * dt
        position += speed * dt
    return q, v, a
