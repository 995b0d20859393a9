"""The environments: Gymnasium's checker without a warning, and rewards that a good controller earns."""

import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import idc
import idc.gym

BENCH = "scenarios/paper_step.toml"
CELL = "scenarios/plate_edge_ideal.toml"


@pytest.mark.parametrize(("scenario", "options"), [(BENCH, {"force_n": 200.0}), (CELL, {"period_s": 0.02})])
def test_the_checker_has_nothing_to_say(scenario, options):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(idc.gym.make(scenario, **options), skip_render_check=True)
        idc.gym.register()
        name = "idc/Cell-v0" if scenario == CELL else "idc/Bench-v0"
        env = gymnasium.make(name, scenario=scenario, **options)
        env.reset(seed=3)
        env.step(env.action_space.sample())


def course(env, controller, seed=1):
    seen, _ = env.reset(seed=seed)
    rewards, terminated = [], False
    while not terminated:
        seen, reward, terminated, truncated, _ = env.step(controller(seen))
        rewards.append(reward)
        assert seen in env.observation_space and not truncated
    return np.array(rewards)


def test_a_controller_by_the_load_cell_earns_more_than_one_that_does_nothing():
    env = idc.gym.make(BENCH, force_n=200.0, set={"bench.duration_s": 12})
    share = [0.2]

    def integral(seen):
        share[0] = min(1.0, max(0.0, share[0] + 0.5e-6 * (seen[0] - seen[1])))
        return np.array([2.0 * share[0] - 1.0], dtype=np.float32)

    kept = course(env, integral)
    idle = course(env, lambda _: np.array([-1.0], dtype=np.float32))
    assert kept[-500:].mean() > -0.01
    assert idle[-500:].mean() == -1.0
    assert len(kept) == len(idle)
    assert env.unwrapped.finish().metrics


def test_an_action_is_a_set_pressure():
    env = idc.gym.make(BENCH, force_n=200.0, max_pressure_bar=4.0)
    env.reset(seed=1)
    seen, *_ = env.step(np.array([0.5], dtype=np.float32))
    assert seen[idc.gym.FIELDS.index("set_pressure_bar_gauge")] == pytest.approx(3.0)
    assert env.set_pressure_pa_gauge(np.array([0.5], dtype=np.float32)) == pytest.approx(3.0e5)


def test_a_cell_is_judged_while_it_engages_and_follows():
    env = idc.gym.make(CELL, period_s=0.02)
    env.reset(seed=1)
    phase = idc.gym.FIELDS.index("phase")
    terminated, by_phase = False, {}
    while not terminated:
        seen, reward, terminated, _, _ = env.step(np.array([-0.5], dtype=np.float32))
        by_phase.setdefault(int(seen[phase]), []).append(reward)
    assert set(by_phase) == {0, 1, 2, 3}
    assert not any(by_phase[0][:-1]) and all(by_phase[2][1:-1])


def test_a_bench_without_a_force_is_refused():
    with pytest.raises(idc.Error, match="force_n="):
        idc.gym.make(BENCH)
