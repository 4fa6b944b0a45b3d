#!/bin/bash
# slurm.sh FOLDER COMMAND...: runs a command with a Slurm of its own, one controller and one node of two processors on
# this machine, started without systemd and gone afterward. FOLDER is for its state. Exit code 77 where Slurm is not
# installed (Debian: slurmctld, slurmd, slurm-client), or does not start: the reason is printed.
set -u
skip() {
    echo "skipped: $*" >&2
    exit 77
}
for program in slurmctld slurmd sbatch squeue scontrol; do
    PATH=$PATH:/usr/sbin command -v "$program" >/dev/null || skip "Slurm is not installed: there is no $program"
done
export PATH=$PATH:/usr/sbin
[ "$(id -u)" -eq 0 ] || skip "slurmd starts jobs as root alone"
folder=$1
shift
host=$(hostname -s)
port=$((20000 + $$ % 20000))
mkdir -p "$folder"/{state,spool,log}
cat >"$folder/slurm.conf" <<END
ClusterName=cistula
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/none
CredType=cred/none
SlurmUser=root
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/log/slurmctld
SlurmdLogFile=$folder/log/slurmd
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,batch_sched_delay=0,sched_min_interval=0
ReturnToService=2
KillWait=1
MinJobAge=300
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$folder/slurm.conf
slurmctld -D -c >"$folder/log/ctld.out" 2>&1 &
controller=$!
slurmd -D -c >"$folder/log/slurmd.out" 2>&1 &
node=$!
stop() {
    kill "$node" "$controller" 2>/dev/null
    wait "$node" "$controller" 2>/dev/null
}
trap stop EXIT
for _ in $(seq 100); do
    [ "$(sinfo -h -o %t 2>/dev/null)" = idle ] && break
    kill -0 "$controller" && kill -0 "$node" || skip "Slurm does not start here: $(tail -n 3 "$folder"/log/*)"
    sleep 0.2
done
[ "$(sinfo -h -o %t 2>/dev/null)" = idle ] || skip "Slurm's node does not get ready: $(tail -n 3 "$folder"/log/*)"
"$@"
