#!/usr/bin/env bash
# A cohort on a real Slurm of one node: its tasks are killed, requeued, its node is drained.
#   tests/tools/test_cohort_slurm.sh PELLICLE
# Needs root, and slurmctld, slurmd, munge that start here; else it says so and is left out (exit 77).
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
if [ "$(id -u)" -ne 0 ]; then echo "Left out: only root can start a Slurm."; exit 77; fi
for program in slurmctld slurmd munged sbatch; do
  command -v $program >/dev/null || { echo "Left out: $program is not installed."; exit 77; }
done
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/command_helpers.sh"
# shellcheck source=tests/tools/cohort_helpers.sh
source "$tests/cohort_helpers.sh"
trap '"$tests/slurm_local.sh" stop "$here/slurm"; rm -rf "$here"' EXIT
export_line=$("$tests/slurm_local.sh" start "$here/slurm") ||
  { echo "Left out: Slurm does not start on this machine: $(tail -n 3 "$here"/slurm/*.log)"; exit 77; }
eval "$export_line"

count=20
make_scans $count 96
cp scans/s7.nrrd whole.nrrd
head -c 100000 whole.nrrd >scans/s7.nrrd
works "a plan" 0 "$pellicle" cohort plan scans -o study --iso 0.5

# ---- nothing is done by --dry-run
works "dry run" 0 "$pellicle" cohort submit slurm study --dry-run
says "dry run" '^srun .* cohort run ' stdout
[ ! -e study/submitted ] || fails "dry run: writes"
[ -z "$(squeue -h)" ] || fails "dry run: submits"

# ---- the pilot, and an array of more tasks than MaxArraySize allows
works "submit" 0 "$pellicle" cohort submit slurm study --minutes 0.00001 --option=--comment=made-up
says "submit" '^srun ' stdout
says "submit" "no node has more than $(nproc) cores" stdout
says "submit" "^#SBATCH --cpus-per-task=$(nproc)\$" stdout
says "submit" 'MaxArraySize allows 10 tasks' stdout
says "submit" '^sbatch --parsable .*/submitted/2.sh' stdout
says "submit" '^#SBATCH --array=1-10$' stdout
says "submit" '^#SBATCH --mem=[0-9]+M$' stdout
says "submit" '^#SBATCH --comment=made-up$' stdout
says "submit" 'submitted as job' stdout
job=$(sed -nE 's/.*submitted as job ([0-9]+).*/\1/p' stdout)

# ---- tasks are killed in the middle, one is requeued, the node is drained and comes back
running() { [ -n "$(squeue -h -t R -j "$job" 2>/dev/null)" ]; }
wait_for 30 running || fails "no task runs: $(cat slurm/slurmctld.log)"
first=$(squeue -h -t R -j "$job" -o %i | head -1)
scancel -s KILL --full "$first"
wait_for 30 running
scontrol requeue "$(squeue -h -t R -j "$job" -o %i | head -1)" 2>/dev/null
node=$(sinfo -h -N -o %N)
scontrol update "nodename=$node" state=drain reason=made-up
idle() { [ -z "$(squeue -h -t R,CG)" ]; }
wait_for 60 idle || fails "drained: tasks go on"
whole study
works "drained: status" 1 "$pellicle" cohort status study
scontrol update "nodename=$node" state=resume
gone() { [ -z "$(squeue -h -t R,CG,PD | grep -v BeginTime)" ]; }
wait_for 120 gone || fails "tasks do not end: $(squeue)"
scancel "$job" 2>/dev/null  # what waits to be requeued
wait_for 30 idle
whole study

# ---- what is left is submitted again; all but the truncated scan is done
works "submit again" 0 "$pellicle" cohort submit slurm study --minutes 1
empty() { [ -z "$(squeue -h)" ]; }
wait_for 120 empty || fails "the second array does not end: $(squeue)"
works "status" 1 "$pellicle" cohort status study --json
[ "$(jq -c '[.done, .failed, .left]' stdout)" = "[$((count - 1)),1,0]" ] ||
  fails "status: $(cat stdout; tail -n 20 study/logs/*)"
says "the truncated scan" 's7: .*is truncated' stdout
same_as_single study --iso 0.5
works "nothing is left" 0 "$pellicle" cohort submit slurm study
says "nothing is left" 'nothing is left to do' stdout

# ---- the mended scan, and what Slurm refuses
cp whole.nrrd scans/s7.nrrd
works "a plan of the mended scan" 0 "$pellicle" cohort plan scans -o study --iso 0.5
works "Slurm refuses" 2 "$pellicle" cohort submit slurm study --option=--partition=none
says "Slurm refuses" 'sbatch: ends with exit code 1; nothing has been submitted' stderr
works "submit the mended scan" 0 "$pellicle" cohort submit slurm study
wait_for 60 empty || fails "the mended scan does not end: $(squeue)"
works "all is done" 0 "$pellicle" cohort status study
whole study

[ $failures -eq 0 ] || { echo "$failures failures"; exit 1; }
echo "All as expected."
