"""EMPS after a filter of the authors' kind: python3 emps_filtered.py emps_train.csv   (needs numpy, scipy)

Force and regressors through the same zero-phase Butterworth filter of fourth order, least squares, residual over force. The motion's derivatives are those
of cubics over nine samples; 50 samples are dropped at each end. docs/EVIDENCE.md quotes it beside what `idc diagnose` leaves unfiltered.
"""
import sys

import numpy as np
from scipy.signal import butter, filtfilt, savgol_filter

time, _, position, _, force = np.loadtxt(sys.argv[1], delimiter=",", skiprows=1).T
step = float(np.median(np.diff(time)))
speed = savgol_filter(position, 9, 3, deriv=1, delta=step)
acceleration = savgol_filter(position, 9, 3, deriv=2, delta=step)
regressors = np.c_[acceleration, speed, np.abs(speed), np.ones_like(speed), np.tanh(speed / 5e-4)]
inner = slice(50, -50)
for limit in (20, 30, 40, 60, 100):
    b, a = butter(4, 2 * step * limit)
    columns = np.apply_along_axis(lambda x: filtfilt(b, a, x), 0, regressors)[inner]
    filtered = filtfilt(b, a, force)[inner]
    found, *_ = np.linalg.lstsq(columns, filtered, rcond=None)
    left = np.linalg.norm(filtered - columns @ found) / np.linalg.norm(filtered)
    print(f"below {limit} Hz: {100 * left:.2f} %, M F_v B F_0 F_c = {np.round(found, 2)}")
