"""Steps of 1 ms of the bench's environment a second on one core, and stable-baselines3's checker where it is installed."""

import time

import idc.gym

env = idc.gym.make("scenarios/paper_step.toml", force_n=200.0)
action = env.action_space.sample()
steps, best = 0, 0.0
for seed in range(20):
    env.reset(seed=seed)
    steps, terminated, begin = 0, False, time.process_time()
    while not terminated:
        _, _, terminated, _, _ = env.step(action)
        steps += 1
    best = max(best, steps / (time.process_time() - begin))
print(f"{best:.0f} steps a second, each of {1e3 * env.period_s:g} ms")
try:
    from stable_baselines3.common.env_checker import check_env
except ImportError:
    print("stable-baselines3 is not installed")
else:
    check_env(env)
    print("stable-baselines3's checker has nothing to say")
