#!/usr/bin/env bash
# Runs grit on two ranks that are on different hosts for the network: namespaces with names of their own, joined by a virtual cable.
#   hosts.sh [DESCRIPTION]                       default: sims/simple-shear/quick.json
# 1. The run has the bits of one process. 2. The cable is cut during another run: mpirun must say so, and end the processes on both
# sides; --resume then goes on to the same bits. Needs root, ip (Debian: iproute2) and mpirun. Exit status 1 if anything of this fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

grit=$PWD/build/bin/grit
description=$(realpath "${1:-sims/simple-shear/quick.json}")
one=grit-host-1 other=grit-host-2
[[ $EUID == 0 ]] || { echo "hosts: only root may make network namespaces" >&2; exit 1; }
for tool in ip mpirun unshare; do command -v "$tool" > /dev/null || { echo "hosts: $tool is missing" >&2; exit 1; }; done
[[ -x $grit ]] || { echo "hosts: $grit does not exist; build the tree first" >&2; exit 1; }

folder=$(mktemp -d)
remove() {
  for host in $one $other; do ip netns del $host 2> /dev/null || true; done
  rm -rf "$folder"
}
trap remove EXIT
for host in $one $other; do ip netns add $host; done
ip link add grit-cable-1 netns $one type veth peer name grit-cable-2 netns $other
for n in 1 2; do
  ip -n grit-host-$n addr add 10.77.0.$n/24 dev grit-cable-$n
  ip -n grit-host-$n link set lo up
  ip -n grit-host-$n link set grit-cable-$n up
done
# Called by mpirun as ssh would be: options, host, command.
cat > "$folder/remote" <<END
#!/bin/bash
while [[ \$1 == -* ]]; do shift; done
shift
exec ip netns exec $other unshare --uts sh -c "hostname $other; \$*"
END
chmod +x "$folder/remote"

# On two cores that are both busy the network gets time only if ranks that wait give way. A connection counts as lost after half a minute.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_plm_rsh_agent=$folder/remote OMPI_MCA_btl=tcp,self OMPI_MCA_mpi_yield_when_idle=1
export OMPI_MCA_btl_tcp_if_include=10.77.0.0/24 OMPI_MCA_oob_tcp_if_include=10.77.0.0/24
export OMPI_MCA_oob_tcp_keepalive_time=10 OMPI_MCA_oob_tcp_keepalive_intvl=5 OMPI_MCA_oob_tcp_keepalive_probes=3
often=(--set '/output/checkpoint_every="1 s"')
on_both() {
  ip netns exec $one unshare --uts sh -c "hostname $one; exec \"\$@\"" - mpirun -n 2 --host 10.77.0.1:1,10.77.0.2:1 "$grit" run "$description" \
    --threads 1 --quiet --no-report "${often[@]}" "$@"
}
same() {
  /usr/bin/python3 scripts/same_results.py "$folder/alone" "$1" > "$folder/differences" || { cat "$folder/differences" >&2; exit 1; }
}

"$grit" run "$description" --threads 1 --quiet --no-report "${often[@]}" --out "$folder/alone" > /dev/null
seconds=$SECONDS
on_both --out "$folder/both" > "$folder/log" 2>&1 || { cat "$folder/log" >&2; echo "hosts: the run on two hosts failed" >&2; exit 1; }
seconds=$((SECONDS - seconds))
same "$folder/both"
echo "two hosts: same bits as one process"

on_both --out "$folder/cut" > "$folder/log" 2>&1 &
sleep $((seconds / 2 + 1))
ip -n $other link set grit-cable-2 down
cut=$SECONDS status=0
wait $! || status=$?
[[ $status != 0 ]] || { echo "hosts: the run was over before the cable was cut; give a longer description" >&2; exit 1; }
grep -q "lost communication with a remote daemon" "$folder/log" || { cat "$folder/log" >&2; echo "hosts: the cut is not reported" >&2; exit 1; }
sleep 2
! pgrep -f -- "--out $folder/cut" > /dev/null || { echo "hosts: processes were left after the cut" >&2; exit 1; }
echo "cable cut: mpirun reports it after $((SECONDS - cut - 2)) s, exit status $status, no process is left"
"$grit" run "$folder/cut" --threads 2 --quiet --no-report --resume > /dev/null
same "$folder/cut"
step=$(sed -n 's/.*"resumed_at_step": *\([0-9]*\).*/\1/p' "$folder/cut/run.json")
[[ ${step:-0} -gt 0 ]] || { echo "hosts: there was no checkpoint yet; give a longer description" >&2; exit 1; }
echo "continued from step $step in one process: same bits"
