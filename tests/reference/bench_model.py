"""The device on the bench rig: reading a scenario, and the model's right-hand side. Used by bench_reference.py.

Reads a scenario of kind "bench" and its device file, and shares nothing with the Rust program but those files.
State: air mass of each chamber [kg], stroke [m], speed [m/s], and with gas_process = "wall_heat" the internal energy of the air
in each chamber [J], all scaled to about 1. The regulator's outlet is put in by its closed form. SI units; equation numbers are
those of the source paper.

The right-hand side has branches: regimes of the orifices, modes of the contacts. It can be made to keep to one of them, on which it is
smooth, for an integration that stops at the border.
"""

import math
import tomllib
from bisect import bisect_right
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Callable, Sequence

import numpy as np

# Regimes of an orifice, by the signed share that the pressure falls by: choked and subsonic outwards, laminar, subsonic and choked inwards.
CHOKED_OUT, SUBSONIC_OUT, LAMINAR, SUBSONIC_IN, CHOKED_IN = range(5)
LAMINAR_RATIO = 0.999

# Modes of a contact. In RELEASED it is still pressed in, but k d + c d_dot < 0, so it does not push.
OPEN, PUSHING, RELEASED = range(3)

# What is not modelled here, and must be left at zero by the device or out of the scenario.
ZERO_DEVICE_KEYS = ("seal_coulomb_force_n", "seal_static_force_n", "seal_viscous_coefficient_n_s_per_m", "hose_length_m")
BENCH_KEYS = {"duration_s", "gravity_along_extension_m_per_s2"}


@dataclass(frozen=True)
class Contact:
    """A stop or a load: pushes by max(0, k d + c d_dot) while d > 0."""

    direction: float  # of its push, along extension
    stiffness: float  # [N/m]
    damping: float  # [N s/m]
    place: Callable[[float], tuple[float, float]]  # position [m] and speed [m/s] of its surface at a time

    def penetration(self, time: float, stroke: float) -> float:
        return self.direction * (self.place(time)[0] - stroke)

    def raw_force(self, time: float, stroke: float, speed: float) -> float:
        """k d + c d_dot [N], of either sign."""
        position, surface_speed = self.place(time)
        return self.direction * (self.stiffness * (position - stroke) + self.damping * (surface_speed - speed))

    def mode(self, time: float, stroke: float, speed: float) -> int:
        if self.penetration(time, stroke) <= 0.0:
            return OPEN
        return PUSHING if self.raw_force(time, stroke, speed) > 0.0 else RELEASED


@dataclass(frozen=True)
class Modes:
    """The branch of the right-hand side: a regime for each chamber's orifice, a mode for each contact."""

    regimes: tuple[int, ...]
    contacts: tuple[int, ...]

    def with_regime(self, chamber: int, regime: int) -> "Modes":
        return replace(self, regimes=self.regimes[:chamber] + (regime,) + self.regimes[chamber + 1 :])

    def with_contact(self, index: int, mode: int) -> "Modes":
        return replace(self, contacts=self.contacts[:index] + (mode,) + self.contacts[index + 1 :])


@dataclass(frozen=True)
class State:
    """The state in SI units, with what follows from it."""

    stroke: float
    speed: float
    masses: tuple[float, float]
    pressures: tuple[float, float]
    temperatures: tuple[float, float]


class Bench:
    """A scenario: the device's constants, the load and the timetable, and the model's right-hand side."""

    def __init__(self, scenario: dict, device: dict) -> None:
        count, bore, rod = device["cylinder_count"], device["bore_mm"] * 1e-3, device["rod_mm"] * 1e-3
        self.extending_area = count * math.pi / 4 * bore**2
        self.retracting_area = self.extending_area - count * math.pi / 4 * rod**2
        self.full_stroke = device["stroke_mm"] * 1e-3
        self.dead_volume = device["dead_volume_cm3"] * 1e-6
        self.moving_mass = device["moving_mass_kg"]
        coefficient = device["discharge_coefficient"]
        self.supply_conductance = coefficient * device["supply_orifice_mm2"] * 1e-6
        self.exhaust_conductance = coefficient * device["exhaust_orifice_mm2"] * 1e-6
        self.gain = device["regulator_gain"]
        self.time_constant = device["regulator_time_constant_s"]
        self.dead_time = device["regulator_dead_time_ms"] * 1e-3
        self.supply_pressure = device["supply_pressure_bar_gauge"] * 1e5
        self.gas_constant = device["gas_constant_j_per_kg_k"]
        self.heat_ratio = device["gas_heat_capacity_ratio"]
        self.temperature = device["gas_temperature_k"]
        self.atmosphere = device["atmosphere_pa_absolute"]
        process = device["gas_process"]
        if process not in ("isothermal", "wall_heat"):
            raise SystemExit(f"bench_reference: gas_process {process!r} is not modelled here")
        self.wall_heat = process == "wall_heat"
        self.wall_conductance = device["wall_conductance_w_per_k"] if self.wall_heat else 0.0
        self._prepare_flow()

        rig = scenario["bench"]
        self.duration = float(rig["duration_s"])
        self.gravity = rig.get("gravity_along_extension_m_per_s2", 0.0)
        stop = (device["end_stop_stiffness_n_per_m"], device["end_stop_damping_n_s_per_m"])
        self.stop_stiffness = stop[0]
        self.contacts = [
            Contact(1.0, *stop, lambda time: (0.0, 0.0)),
            Contact(-1.0, *stop, lambda time: (self.full_stroke, 0.0)),
        ]
        load = scenario["load"]
        if load["kind"] != "free":
            stiffness = load.get("stiffness_n_per_m", 1.5e5)
            damping = load.get("damping_n_s_per_m", 400.0)
            self.contacts.append(Contact(-1.0, stiffness, damping, load_place(load)))

        self.outlet_pieces = self._outlet_pieces(scenario.get("command", []))
        self.valve_changes = [(-math.inf, "extend")] + sorted((v["at_s"], v["position"]) for v in scenario.get("valve", []))
        starts = [load["start_s"]] if load["kind"] == "surface" else []
        inner = {piece[0] for piece in self.outlet_pieces[1:]} | {change[0] for change in self.valve_changes[1:]} | set(starts)
        self.breaks = [0.0, *sorted(t for t in inner if 0.0 < t < self.duration), self.duration]

        mass = self.atmosphere * (self.dead_volume + self.extending_area * self.full_stroke) / (self.gas_constant * self.temperature)
        energy = mass * self.gas_constant * self.temperature / (self.heat_ratio - 1.0)
        self.scale = np.array([mass, mass, self.full_stroke, 1.0] + [energy, energy] * self.wall_heat)

    def _prepare_flow(self) -> None:
        k = self.heat_ratio
        critical_ratio = (2 / (k + 1)) ** (k / (k - 1))  # eq. (11)
        self.choked = math.sqrt(k * (2 / (k + 1)) ** ((k + 1) / (k - 1)))
        self.laminar_slope = self.subsonic(LAMINAR_RATIO) / (1 - LAMINAR_RATIO)
        self.regime_bounds = [critical_ratio - 1, LAMINAR_RATIO - 1, 1 - LAMINAR_RATIO, 1 - critical_ratio]

    def _outlet_pieces(self, commands: Sequence[dict]) -> list[tuple[float, float, float]]:
        """When a set pressure arrives [s], the outlet then and the outlet it goes to [Pa gauge]."""
        pieces = [(0.0, 0.0, 0.0)]
        for command in sorted(commands, key=lambda command: command["at_s"]):
            if "set_pressure_bar_gauge" not in command:
                raise SystemExit("bench_reference: only commands of set_pressure_bar_gauge are modelled, not force_n")
            arrival = command["at_s"] + self.dead_time
            target = min(max(self.gain * command["set_pressure_bar_gauge"] * 1e5, 0.0), self.supply_pressure)
            pieces.append((arrival, relaxed(pieces[-1], self.time_constant, arrival), target))
        return pieces

    def outlet(self, time: float) -> float:
        """Regulator outlet [Pa gauge], eq. (8) in closed form."""
        index = bisect_right(self.outlet_pieces, time, key=lambda piece: piece[0]) - 1
        return relaxed(self.outlet_pieces[index], self.time_constant, time)

    def valve(self, time: float) -> str:
        return self.valve_changes[bisect_right(self.valve_changes, time, key=lambda change: change[0]) - 1][1]

    def start(self) -> np.ndarray:
        """At rest on the retracted stop, or let go at zero stroke when gravity pulls the piston out."""
        stroke = min(0.0, self.moving_mass * self.gravity / self.stop_stiffness)
        masses = [self.atmosphere * volume / (self.gas_constant * self.temperature) for volume in self.volumes(stroke)]
        energies = [m * self.gas_constant * self.temperature / (self.heat_ratio - 1) for m in masses] * self.wall_heat
        return np.array([*masses, stroke, 0.0, *energies]) / self.scale

    def volumes(self, stroke: float) -> tuple[float, float]:
        return (
            self.dead_volume + self.extending_area * stroke,
            self.dead_volume + self.retracting_area * (self.full_stroke - stroke),
        )

    def state(self, y: np.ndarray) -> State:
        mass_1, mass_2, stroke, speed, *energies = (y * self.scale).tolist()
        masses = (mass_1, mass_2)
        volumes = self.volumes(stroke)
        temperatures = (self.temperature, self.temperature)
        if self.wall_heat:
            temperatures = tuple(e * (self.heat_ratio - 1) / (m * self.gas_constant) for e, m in zip(energies, masses))
        pressures = tuple(m * self.gas_constant * t / v for m, t, v in zip(masses, temperatures, volumes))
        return State(stroke, speed, masses, pressures, temperatures)

    def orifices(self, time: float, valve: str) -> tuple[tuple[float, float], tuple[float, float]]:
        """For each chamber: A C of its orifice [m2] and the pressure behind it [Pa absolute]."""
        supply = (self.supply_conductance, self.atmosphere + self.outlet(time))
        exhaust = (self.exhaust_conductance, self.atmosphere)
        return (supply, exhaust) if valve == "extend" else (exhaust, supply)

    def subsonic(self, ratio: float) -> float:
        """The upper branch of eq. (10)."""
        k = self.heat_ratio
        return math.sqrt(max(0.0, 2 * k / (k - 1) * (ratio ** (2 / k) - ratio ** ((k + 1) / k))))

    def flow(self, regime: int, conductance: float, outside: float, inside: float, temperature: float) -> float:
        """Mass flow into a chamber [kg/s], eqs. (9) and (10) by the branch given, in either direction."""
        upstream = max(outside, inside)
        fall = pressure_fall(outside, inside)
        if regime == LAMINAR:
            shape = self.laminar_slope * fall
        else:
            size = self.choked if regime in (CHOKED_OUT, CHOKED_IN) else self.subsonic(1.0 - abs(fall))
            shape = size if regime > LAMINAR else -size
        upstream_temperature = self.temperature if fall > 0.0 else temperature
        return conductance * upstream / math.sqrt(self.gas_constant * upstream_temperature) * shape

    def modes(self, time: float, y: np.ndarray, valve: str) -> Modes:
        """The branch that a state lies in."""
        state = self.state(y)
        falls = [pressure_fall(outside, inside) for (_, outside), inside in zip(self.orifices(time, valve), state.pressures)]
        regimes = tuple(bisect_right(self.regime_bounds, fall) for fall in falls)
        return Modes(regimes, tuple(contact.mode(time, state.stroke, state.speed) for contact in self.contacts))

    def gas_force(self, state: State) -> float:
        push = state.pressures[0] * self.extending_area - state.pressures[1] * self.retracting_area
        return push - self.atmosphere * (self.extending_area - self.retracting_area)

    def contact_forces(self, time: float, state: State, contact_modes: tuple[int, ...]) -> list[float]:
        """Force of each contact along extension [N]."""
        return [
            contact.direction * contact.raw_force(time, state.stroke, state.speed) if mode == PUSHING else 0.0
            for contact, mode in zip(self.contacts, contact_modes)
        ]

    def rates(self, time: float, y: np.ndarray, valve: str, modes: Modes | None) -> np.ndarray:
        """Derivative of the scaled state; without `modes` on the branch where the state lies."""
        if modes is None:
            modes = self.modes(time, y, valve)
        state = self.state(y)
        flows = [
            self.flow(regime, conductance, outside, inside, temperature)
            for regime, (conductance, outside), inside, temperature in zip(
                modes.regimes, self.orifices(time, valve), state.pressures, state.temperatures
            )
        ]
        force = self.gas_force(state) + sum(self.contact_forces(time, state, modes.contacts))
        rates = [*flows, state.speed, force / self.moving_mass + self.gravity]
        if self.wall_heat:
            rates += self.energy_rates(state, flows)
        return np.array(rates) / self.scale

    def energy_rates(self, state: State, flows: Sequence[float]) -> list[float]:
        """First law for each chamber: enthalpy of the air that passes, work on the piston, heat from the wall [W]."""
        heat_capacity = self.heat_ratio / (self.heat_ratio - 1) * self.gas_constant
        growths = (self.extending_area * state.speed, -self.retracting_area * state.speed)
        return [
            flow * heat_capacity * (self.temperature if flow > 0.0 else temperature)
            - pressure * growth
            + self.wall_conductance * (self.temperature - temperature)
            for flow, temperature, pressure, growth in zip(flows, state.temperatures, state.pressures, growths)
        ]

    def at_rest(self, time: float, y: np.ndarray, valve: str) -> bool:
        """Whether nothing moves and nothing will until the next break."""
        piece = self.outlet_pieces[bisect_right(self.outlet_pieces, time, key=lambda piece: piece[0]) - 1]
        return piece[1] == piece[2] and bool(np.all(np.abs(self.rates(time, y, valve, None)) < 1e-12))


def pressure_fall(outside: float, inside: float) -> float:
    """1 - u of eq. (9), negative when the flow is outwards."""
    return (outside - inside) / max(outside, inside)


def relaxed(piece: tuple[float, float, float], time_constant: float, time: float) -> float:
    begin, outlet, target = piece
    return target + (outlet - target) * math.exp(-(time - begin) / time_constant)


def load_place(load: dict) -> Callable[[float], tuple[float, float]]:
    """Position [m] and speed [m/s] of the load's surface at a time."""
    position = load["position_mm"] * 1e-3
    if load["kind"] == "load_cell":
        return lambda time: (position, 0.0)
    if load["kind"] != "surface":
        raise SystemExit(f"bench_reference: load of kind {load['kind']!r} is not modelled here")
    half, begin = load["peak_to_peak_mm"] * 0.5e-3, load["start_s"]
    circular = 2 * math.pi * load["frequency_hz"]

    def place(time: float) -> tuple[float, float]:
        phase = circular * max(0.0, time - begin)
        return position - half * (1 - math.cos(phase)), -half * circular * math.sin(phase)

    return place


def read_bench(path: Path) -> Bench:
    scenario = tomllib.loads(path.read_text())
    if scenario.get("kind") != "bench":
        raise SystemExit(f"bench_reference: {path} is not of kind bench")
    device = tomllib.loads((path.parent / scenario["device"]["model"]).read_text())["device"]
    override = scenario["device"].get("override", {})
    unknown = override.keys() - device.keys()
    if unknown:
        raise SystemExit(f"bench_reference: {path} overrides {', '.join(sorted(unknown))}, which the device does not have")
    device |= override
    refused = [key for key in ZERO_DEVICE_KEYS if device[key] != 0]
    refused += sorted(scenario["bench"].keys() - BENCH_KEYS) + sorted(scenario.keys() & {"hand"})
    if refused:
        raise SystemExit(f"bench_reference: {path} asks for {', '.join(refused)}, not modelled here")
    return Bench(scenario, device)
