#!/bin/sh
# docs/CLUSTER.md's Slurm on this machine alone: Debian's slurm-wlm and munge on loopback, two jobs of dask-jobqueue as workers, a sweep through them.
# As root, of a machine that may be changed (packages, /etc/slurm/slurm.conf). Ends with 1 where the table differs from that of this program's threads.
set -eu
RUNS=${1:-24}
IDC=${IDC:-target/release/idc}
OUT=$(mktemp -d)
HOST=$(hostname -s)

apt-get install -y slurm-wlm munge > "$OUT/apt.log"
mkdir -p /etc/slurm /var/spool/slurmctld /var/spool/slurmd /run/munge
cat > /etc/slurm/slurm.conf <<CONF
ClusterName=loopback
SlurmctldHost=$HOST(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
StateSaveLocation=/var/spool/slurmctld
SlurmdSpoolDir=/var/spool/slurmd
SlurmctldPidFile=/run/slurmctld.pid
SlurmdPidFile=/run/slurmd.pid
ReturnToService=2
NodeName=$HOST NodeAddr=127.0.0.1 CPUs=2 RealMemory=2000 State=UNKNOWN
PartitionName=main Nodes=$HOST Default=YES MaxTime=INFINITE State=UP
CONF
grep -q " $HOST\$" /etc/hosts || echo "127.0.0.1 $HOST" >> /etc/hosts
chown munge: /run/munge
pgrep munged > /dev/null || runuser -u munge -- munged
pgrep slurmctld > /dev/null || slurmctld
sleep 2
pgrep -x slurmd > /dev/null || slurmd
sleep 3
srun -n1 true

python3 -m venv "$OUT/dask"
"$OUT/dask/bin/pip" -q install distributed dask-jobqueue
cat > "$OUT/cluster.py" <<PYTHON
import time
from dask_jobqueue import SLURMCluster
cluster = SLURMCluster(cores=1, memory="900MB", walltime="01:00:00", log_directory="$OUT")
cluster.scale(jobs=2)
print(cluster.scheduler_address, flush=True)
time.sleep(3600)
PYTHON
"$OUT/dask/bin/python" "$OUT/cluster.py" > "$OUT/address" 2> "$OUT/cluster.log" &
cluster=$!
trap 'kill $cluster; scancel --user root; rm -rf "$OUT"' EXIT
while [ ! -s "$OUT/address" ]; do sleep 1; done

vary() {
    out=$1
    shift
    "$IDC" vary scenarios/plate_edge.toml --sample "latin:$RUNS" --set process.force_n=130..170 --set process.feed_mm_per_s=15.0..25.0 --out "$OUT/$out" --quiet "$@"
}
vary slurm --engine "dask=$(cat "$OUT/address")" --python "$OUT/dask/bin/python"
vary threads
cmp "$OUT/slurm/runs.parquet" "$OUT/threads/runs.parquet"
echo "$RUNS runs by two jobs of Slurm: the same table as by threads"
