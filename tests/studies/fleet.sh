#!/bin/sh
# 200 recordings of five devices over forty days, made by the laboratory: in three something sets in or grows (seals, a leak, the part), in two nothing.
# What, where and since when is found in all three within two days, nothing is reported of the other two, and a new day does its own work alone; tells the time.
set -eu
cargo test --release --test cell -- --ignored --nocapture fleet::two_hundred_recordings_of_five_devices_over_forty_days
