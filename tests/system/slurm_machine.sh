#!/bin/bash
# Slurm on this machine alone, for a test: its own folder for configuration, state, spool, key and socket, its own free ports, no systemd, nothing in /etc.
# Needs root and the programs of the packages slurmctld, slurmd, slurm-client and munge.
#   slurm_machine.sh start FOLDER [NODES [ID]] FOLDER is made (it must not be there); NODES are two unless told otherwise: node1, node2 ...; where the process
#                                              ID has ended, it stops by itself
#   slurm_machine.sh kill-node FOLDER NODE     as a node that dies: SIGKILL to its daemon and to all that its jobs started
#   slurm_machine.sh revive-node FOLDER NODE   its daemon again
#   slurm_machine.sh stop FOLDER               ends everything and removes FOLDER
# Between them: SLURM_CONF=FOLDER/slurm.conf sbatch ...
set -u

fail() {
  echo "slurm_machine.sh: $*" >&2
  exit 1
}

usage() {
  sed -n '2,9p' "$0" >&2
  exit 2
}

# Ids of the processes of the node $1 ('*': of all nodes and of Slurm itself). Daemons and steps write a log in this folder; jobs have in their environment the
# node's name and which Slurm it is.
processes() {
  {
    find /proc/[0-9]*/fd -maxdepth 1 -lname "$folder/logs/$1.*" 2>/dev/null | cut -d/ -f3
    grep -lzxF "SLURM_CONF=$folder/slurm.conf" /proc/[0-9]*/environ 2>/dev/null | xargs -r grep -lzxE "SLURMD_NODENAME=${1/\*/.*}" 2>/dev/null | cut -d/ -f3
  } | sort -un | grep -vx $$
}

# All at once, as if the power went: none sees another end and tells of it. Again while some have just started others.
endAll() {
  local ids
  for _ in $(seq 100); do
    ids=$(processes "$1")
    [ -z "$ids" ] && return 0
    kill -STOP $ids 2>/dev/null
    kill -KILL $ids $(processes "$1") 2>/dev/null
    sleep 0.1
  done
  return 1
}

freePort() {
  local port
  while :; do
    port=$((15000 + RANDOM % 15000))  # below those that the system gives to connections
    case " ${ports:-} " in *" $port "*) continue ;; esac
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null && continue
    echo "$port"
    return
  done
}

# Waits until the command succeeds, at most $1 seconds.
waitFor() {
  local until=$((SECONDS + $1))
  shift
  while ! "$@" >/dev/null 2>&1; do
    [ $SECONDS -ge $until ] && return 1
    sleep 0.2
  done
}

startNode() {
  setsid slurmd -D -N "$1" -f "$folder/slurm.conf" </dev/null >>"$folder/logs/$1.out" 2>&1 &
}

nodesUp() {
  [ "$(sinfo --noheader --Node --format=%t | grep -cxE 'idle|mix|alloc|comp')" -ge "$1" ]
}

start() {
  local nodes=${1:-2} owner=${2:-} n ports='' host
  [ "$(id -u)" = 0 ] || fail "must be started by root"
  for program in munged slurmctld slurmd sbatch sinfo; do
    command -v $program >/dev/null || fail "$program is not there; apt-get install slurmctld slurmd slurm-client munge"
  done
  case $folder in *[!A-Za-z0-9_./-]*) fail "$folder: Slurm's configuration holds letters, digits and _./- in a path" ;; esac
  [ ${#folder} -le 80 ] || fail "$folder: too long for the name of a socket"
  mkdir "$folder" || fail "$folder cannot be made"
  mkdir "$folder/logs" "$folder/state" "$folder/spool"
  trap 'echo "slurm_machine.sh: did not come up; logs:" >&2; tail -n 5 "$folder"/logs/* >&2; stop; exit 1' ERR INT TERM
  set -eE

  head -c 128 /dev/urandom >"$folder/munge.key"
  chmod 600 "$folder/munge.key"
  setsid munged --foreground --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" --pid-file="$folder/munged.pid" \
    --log-file="$folder/logs/munged.log" --seed-file="$folder/munge.seed" --num-threads=2 </dev/null >"$folder/logs/munged.out" 2>&1 &
  waitFor 20 munge --no-input --socket="$folder/munge.socket"

  host=$(hostname -s)
  ports=$(freePort)
  {
    # A dead node is noticed after SlurmdTimeout, and what it ran starts again after cred_expire: nothing but what asks for it.
    cat <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$ports
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket,cred_expire=6
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool/%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/%n.pid
SlurmctldLogFile=$folder/logs/slurmctld.log
SlurmdLogFile=$folder/logs/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SchedulerParameters=batch_sched_delay=1,sched_interval=2,bf_interval=5
JobRequeue=0
ReturnToService=2
SlurmdTimeout=6
SlurmctldTimeout=30
KillWait=5
InactiveLimit=0
PartitionName=test Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
    for n in $(seq "$nodes"); do
      ports="$ports $(freePort)"
      echo "NodeName=node$n NodeHostname=$host NodeAddr=127.0.0.1 Port=${ports##* } CPUs=4 State=UNKNOWN"
    done
  } >"$folder/slurm.conf"
  touch "$folder/cgroup.conf"

  export SLURM_CONF=$folder/slurm.conf
  setsid slurmctld -D -f "$folder/slurm.conf" </dev/null >"$folder/logs/slurmctld.out" 2>&1 &
  waitFor 30 sinfo
  for n in $(seq "$nodes"); do
    mkdir "$folder/spool/node$n"
    startNode "node$n"
  done
  waitFor 60 nodesUp "$nodes"
  trap - ERR INT TERM
  if [ -n "$owner" ]; then
    setsid "$0" follow "$folder" "$owner" </dev/null >/dev/null 2>&1 &
  fi
  echo "SLURM_CONF=$folder/slurm.conf"
}

# Ends with the machine, or ends it when its owner has ended.
follow() {
  while kill -0 "$1" 2>/dev/null; do
    [ -f "$folder/munge.key" ] || return 0
    sleep 1
  done
  stop
}

stop() {
  trap - ERR INT TERM
  set +eE
  [ -f "$folder/munge.key" ] || fail "$folder is none of this script's"
  endAll '*' || fail "some processes of $folder do not end: $(processes '*' | tr '\n' ' ')"
  rm -rf -- "$folder"
}

[ $# -ge 2 ] || usage
command=$1
folder=$(realpath -m -- "$2")
shift 2
case $command in
  start) start "$@" ;;
  stop) stop ;;
  follow) follow "$@" ;;
  kill-node)
    [ $# = 1 ] || usage
    [ -n "$(processes "$1")" ] || fail "no node $1 runs in $folder"
    endAll "$1" || fail "$1 does not end"
    ;;
  revive-node)
    [ $# = 1 ] && [ -d "$folder/spool/$1" ] || usage
    [ -z "$(processes "$1")" ] || fail "node $1 runs already"
    export SLURM_CONF=$folder/slurm.conf
    startNode "$1"
    ;;
  *) usage ;;
esac
