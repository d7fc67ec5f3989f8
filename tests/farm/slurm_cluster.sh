#!/usr/bin/env bash
# A Slurm cluster of two nodes on the loopback interface of this machine: slurm_cluster.sh start|stop FOLDER. All that it
# writes lies in FOLDER, its keys and its authentication, too; Slurm's commands find it by SLURM_CONF=FOLDER/slurm.conf.
# Needs Debian's slurmctld, slurmd, slurm-client and munge.
set -euo pipefail
PATH=$PATH:/usr/sbin:/sbin
folder=$(readlink -m -- "$2")

start() {
    # Slurm's processes ask for more than a folder of mktemp grants, and munged for no more than one grants.
    mkdir -p "$folder/state" "$folder/munge"
    chmod 755 "$folder"
    head -c 128 /dev/urandom >"$folder/munge/key"
    chmod 400 "$folder/munge/key"
    munged --force --socket="$folder/munge/socket" --key-file="$folder/munge/key" --pid-file="$folder/munge/pid" \
        --seed-file="$folder/munge/seed" --log-file="$folder/munge/log"
    local port=$((20000 + $$ % 10000))
    # A job that is put back into the queue waits until its credential has expired, two minutes by default.
    cat >"$folder/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$folder/munge/socket,cred_expire=5
SlurmctldPort=$port
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool.%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.%n.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/pgid
TaskPlugin=task/none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1
NodeName=n1 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1
NodeName=n2 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES State=UP
CONF
    export SLURM_CONF=$folder/slurm.conf
    slurmctld -f "$SLURM_CONF"
    slurmd -f "$SLURM_CONF" -N n1
    slurmd -f "$SLURM_CONF" -N n2
    for _ in $(seq 60); do
        [[ $(sinfo -h -t idle -o %D 2>/dev/null) == 2 ]] && return
        sleep 0.5
    done
    echo "slurm_cluster: the nodes did not come up: $(tail -n 1 "$folder"/slurmd.n1.log)" >&2
    return 1
}

# Waits for their end, so that the folder can be removed.
stop() {
    local file process
    for file in "$folder"/slurmd.*.pid "$folder/slurmctld.pid" "$folder/munge/pid"; do
        [[ -f $file ]] || continue
        process=$(<"$file")
        kill "$process" 2>/dev/null || continue
        for _ in $(seq 100); do
            readlink -q "/proc/$process/exe" >/dev/null || break
            sleep 0.1
        done
    done
}

case $1 in
    start) start || { stop; exit 1; } ;;
    stop) stop ;;
esac
