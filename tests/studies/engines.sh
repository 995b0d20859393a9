#!/bin/sh
# The same runs by threads, Dask and Snakemake, with a worker killed at a third and the driver at two thirds: equal tables, nothing done twice.
#
#   tests/studies/engines.sh [RUNS [SCENARIO]]      IDC names the program, PYTHON one with distributed and snakemake
#
# Prints the time of each and the hash of each table; exits 1 where they differ, or where what was finished was done again.
set -eu
RUNS=${1:-400}
SCENARIO=${2:-scenarios/plate_edge.toml}
IDC=${IDC:-target/release/idc}
PYTHON=${PYTHON:-python3}
OUT=$(mktemp -d)
trap 'rm -rf "$OUT"' EXIT

vary() {
    out=$1
    shift
    "$IDC" vary "$SCENARIO" --sample "latin:$RUNS" --set process.force_n=130..170 --set process.feed_mm_per_s=15.0..25.0 --out "$OUT/$out" --quiet "$@"
}
timed() {
    begin=$(date +%s.%N)
    "$@"
    end=$(date +%s.%N)
    echo "$1 $2: $(echo "$end - $begin" | bc) s"
}
finished() { find "$OUT/killed/tasks" -name result.json 2>/dev/null | wc -l; }
wait_for() { while [ "$(finished)" -lt "$1" ]; do sleep 0.1; done; }

timed vary local
timed vary dask --engine dask=local:2 --python "$PYTHON"

vary snake --plan
"$IDC" task "$OUT/snake/plan.jsonl" --export snakemake --out "$OUT/Snakefile"
begin=$(date +%s.%N)
(cd "$OUT" && "$PYTHON" -m snakemake --snakefile Snakefile --cores 2 --quiet all > "$OUT/snakemake.log" 2>&1)
echo "snakemake: $(echo "$(date +%s.%N) - $begin" | bc) s"
vary snake --resume

vary killed --engine dask=local:2 --python "$PYTHON" 2> "$OUT/killed.log" &
parent=$!
wait_for $((RUNS / 3))
# The shell's own child is the program, whose child is the driver, whose last child is a worker.
driver=$(pgrep -P "$(pgrep -P $parent | head -1)" | head -1)
worker=$(pgrep -P "$driver" | tail -1)
kill -9 "$worker"
echo "worker $worker killed with $(finished) runs finished"
wait_for $((2 * RUNS / 3))
kill -9 "$driver"
wait $parent && exit 1
sleep 2
echo "driver $driver killed with $(finished) runs finished: $(cat "$OUT/killed.log")"
find "$OUT/killed/tasks" -name result.json -printf '%p %i\n' | sort > "$OUT/before"
vary killed --resume
find "$OUT/killed/tasks" -name result.json -printf '%p %i\n' | sort > "$OUT/after"
again=$(comm -23 "$OUT/before" "$OUT/after" | wc -l)
echo "done again of what was finished: $again of $(wc -l < "$OUT/before")"
[ "$again" -eq 0 ]
(cd "$OUT" && sha256sum local/runs.parquet dask/runs.parquet snake/runs.parquet killed/runs.parquet)
[ "$(cd "$OUT" && sha256sum ./*/runs.parquet | cut -d' ' -f1 | sort -u | wc -l)" -eq 1 ] && echo "all tables are equal"
