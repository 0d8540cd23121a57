#!/usr/bin/env bash
# A real Slurm of one node on this machine, for tests:
#   slurm_local.sh start DIR    as root; prints what to eval: export SLURM_CONF=DIR/slurm.conf
#   slurm_local.sh stop DIR     ends what was started
# munged, slurmctld and slurmd run on 127.0.0.1, with sockets, keys, state and logs under DIR and ports of
# their own, beside whatever else of them runs. MaxArraySize is 11, so that tests meet it;
# what is queued again waits for 5 seconds (cred_expire), not for two minutes.
set -euo pipefail
what=${1:?start or stop}
dir=$(realpath -m "${2:?DIR}")
host=$(hostname -s)

start() {
  local port=$((20000 + $$ % 20000))
  mkdir -p "$dir/state" "$dir/spool"
  chmod 755 "$dir"
  (umask 077 && head -c 1024 /dev/urandom >"$dir/munge.key")
  munged --force --socket="$dir/munge.socket" --key-file="$dir/munge.key" --pid-file="$dir/munged.pid" \
    --log-file="$dir/munged.log" --seed-file="$dir/munge.seed"
  cat >"$dir/slurm.conf" <<C
ClusterName=local
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket,cred_expire=5
CryptoType=crypto/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
DefMemPerCPU=200
ReturnToService=2
MaxArraySize=11
KillWait=5
JobRequeue=1
SchedulerParameters=sched_interval=2,requeue_setup_env_fail
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=${SLURM_LOCAL_MEMORY:-1000} State=UNKNOWN
PartitionName=debug Nodes=$host Default=YES MaxTime=INFINITE State=UP
C
  slurmctld -f "$dir/slurm.conf"
  slurmd -f "$dir/slurm.conf"
  export SLURM_CONF=$dir/slurm.conf
  for _ in $(seq 30); do
    if [ "$(sinfo -h -o %T 2>/dev/null)" = idle ]; then
      echo "export SLURM_CONF=$dir/slurm.conf"
      return
    fi
    sleep 1
  done
  echo "slurm: the node did not come up, see $dir/*.log" >&2
  tail -n 5 "$dir"/*.log >&2
  stop
  exit 1
}

stop() {
  local program pid
  for program in slurmd slurmctld munged; do
    pid=$(cat "$dir/$program.pid" 2>/dev/null) || continue
    kill "$pid" 2>/dev/null || continue
    for _ in $(seq 50); do
      kill -0 "$pid" 2>/dev/null || break
      sleep 0.1
    done
  done
}

case $what in
  start) start ;;
  stop) stop ;;
  *) echo "start or stop" >&2; exit 2 ;;
esac
