"""The nominal pneumatics of a concealed case (shared/concealed/README.md, "The nominal model"), for both peers: neither has gas in it.

Regulator: tau dp/dt = gain * set - p (gauge). Chambers, isothermal: dp/dt = (R T m' - p V') / V, with V the dead volume and the swept one.
Orifice between upstream p_u and downstream p_d: m' = Cd A p_u / sqrt(R T) * f(p_d / p_u), f the nozzle function, constant below the
critical ratio and linear above 0.999, where its slope would be infinite. Solenoid 1 joins chamber 1 to the regulator, chamber 2 to the air.
Force of the air along extension: p1 A1 - p2 A2 - p_air (A1 - A2).
"""
import math

import numba
import numpy as np

# rows of the parameter vector
GAIN, TAU, SUPPLY, EXHAUST, DEAD, AREA1, AREA2, STROKE, RT, KAPPA, AIR, CD = range(12)


def pneumatic_parameters(rig):
    """The vector for `step` from a rig.toml as read."""
    cylinder, gas = rig["cylinder"], rig["gas"]
    area1 = cylinder["count"] * math.pi / 4 * cylinder["bore_m"] ** 2
    area2 = area1 - cylinder["count"] * math.pi / 4 * cylinder["rod_m"] ** 2
    return np.array([
        rig["regulator"]["gain"]["value"], rig["regulator"]["time_constant_s"]["value"],
        rig["valve"]["supply_orifice_m2"]["value"], rig["valve"]["exhaust_orifice_m2"]["value"], cylinder["dead_volume_m3"]["value"],
        area1, area2, cylinder["stroke_m"], gas["specific_gas_constant_j_per_kg_k"] * gas["temperature_k"], gas["heat_capacity_ratio"],
        gas["atmosphere_pa"], rig["valve"]["discharge_coefficient"],
    ])


@numba.njit(cache=True)
def nozzle(ratio, kappa):
    critical = (2 / (kappa + 1)) ** (kappa / (kappa - 1))
    if ratio <= critical:
        return math.sqrt(kappa * (2 / (kappa + 1)) ** ((kappa + 1) / (kappa - 1)))
    steep = min(ratio, 0.999)
    value = math.sqrt(2 * kappa / (kappa - 1) * (steep ** (2 / kappa) - steep ** ((kappa + 1) / kappa)))
    return value if ratio <= 0.999 else value * (1 - ratio) / 0.001


@numba.njit(cache=True)
def flow(upstream, downstream, area, p):
    """Mass flow from `upstream` to `downstream` [kg/s], negative when it runs back."""
    if upstream >= downstream:
        return p[CD] * area * upstream / math.sqrt(p[RT]) * nozzle(downstream / upstream, p[KAPPA])
    return -p[CD] * area * downstream / math.sqrt(p[RT]) * nozzle(upstream / downstream, p[KAPPA])


@numba.njit(cache=True)
def step(state, set_pressure, solenoid, stroke, velocity, dt, p, sub):
    """Moves state = [outlet gauge, chamber 1, chamber 2] [Pa] on by dt in `sub` steps; returns the force at its end [N]."""
    h = dt / sub
    x = min(max(stroke, 0.0), p[STROKE])
    for _ in range(sub):
        state[0] += (p[GAIN] * set_pressure - state[0]) * (1 - math.exp(-h / p[TAU]))
        outlet = state[0] + p[AIR]
        v1, v2 = p[DEAD] + p[AREA1] * x, p[DEAD] + p[AREA2] * (p[STROKE] - x)
        if solenoid > 0.5:
            m1, m2 = flow(outlet, state[1], p[SUPPLY], p), flow(p[AIR], state[2], p[EXHAUST], p)
        else:
            m1, m2 = flow(p[AIR], state[1], p[EXHAUST], p), flow(outlet, state[2], p[SUPPLY], p)
        state[1] += h * (p[RT] * m1 - state[1] * p[AREA1] * velocity) / v1
        state[2] += h * (p[RT] * m2 + state[2] * p[AREA2] * velocity) / v2
        x = min(max(x + h * velocity, 0.0), p[STROKE])
    return force(state, p)


@numba.njit(cache=True)
def force(state, p):
    return state[1] * p[AREA1] - state[2] * p[AREA2] - p[AIR] * (p[AREA1] - p[AREA2])


def at_rest(p):
    """Outlet and chambers at the atmosphere."""
    return np.array([0.0, p[AIR], p[AIR]])


@numba.njit(cache=True)
def along(times, set_pressure, solenoid, stroke, velocity, p, sub):
    """Outlet gauge, chamber pressures [Pa] along a measured motion: what the nominal pneumatics would have done."""
    out = np.empty((len(times), 3))
    state = np.array([0.0, p[AIR], p[AIR]])
    for i in range(len(times)):
        out[i] = state
        if i + 1 < len(times):
            step(state, set_pressure[i], solenoid[i], stroke[i], velocity[i], times[i + 1] - times[i], p, sub)
    return out
