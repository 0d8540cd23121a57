#!/usr/bin/env bash
# One image by blocks on a real Slurm of one node: a task is killed, another one is queued again.
#   tests/tools/test_blocks_slurm.sh PELLICLE
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

# 21 blocks one above the other: 11 of the first colour, 10 of the fifth, none of the others.
works "an image" 0 "$pellicle" phantom chain --size 60,60,1760 --spacing 1,1,0.04 --type u8 -o chain.ome.zarr
works "a plan" 0 "$pellicle" blocks plan chain.ome.zarr --iso 127 -o plan \
  --side 84 --from-level 0 --reduction 1.2 --levels 8
# Tasks that take long enough to be met, the sixth most of all: they do not come to rest.
jq '.parameters.epsilon = [1e-300] | .parameters.sleeping = [0] | .parameters.max_iterations = [1000]' \
  plan/plan.json >slow.json
mv slow.json plan/plan.json
cp -r plan here
works "here" 0 "$pellicle" blocks run here --quiet

# ---- nothing is done by --dry-run
works "dry run" 0 "$pellicle" blocks submit slurm plan --dry-run
says "dry run" '^sbatch --parsable --array=1-10 .*/submitted/1.sh 0 10$' stdout
says "dry run" '^sbatch --parsable --array=1-10 --dependency=afterok:JOB1 .*/submitted/1.sh 4 10$' stdout
says "dry run" 'MaxArraySize allows 10 tasks: each has up to 2 blocks' stdout
[ "$(grep -c '^sbatch ' stdout)" -eq 2 ] || fails "dry run: steps without blocks are submitted"
[ ! -e plan/submitted ] || fails "dry run: writes"
[ -z "$(squeue -h)" ] || fails "dry run: submits"

# ---- what Slurm refuses
works "refused" 2 "$pellicle" blocks submit slurm plan --option=--partition=none
says "refused" 'sbatch: ends with exit code 1; nothing has been submitted' stderr
[ -z "$(ls plan/submitted)" ] || fails "refused: leaves its script"

# ---- a task is killed: its step is never done, and the next one does not wait for it
submit() { works "$1" 0 "$pellicle" blocks submit slurm plan --memory 200M --minutes 2 --option=--comment=made-up; }
submit "submit"
says "submit" '^#SBATCH --mem=200M$' stdout
says "submit" '^#SBATCH --time=4$' stdout
says "submit" '^#SBATCH --comment=made-up$' stdout
task_pid() { pgrep -f "blocks run $here/plan --step=0 --task=6/10" | head -n 1; }
killed() {  # that with most to do, which has been at work for a while and is not near its end
  local pid
  pid=$(task_pid)
  [ -n "$pid" ] && sleep 0.3 && kill -9 "$pid" 2>/dev/null
}
empty() { [ -z "$(squeue -h)" ]; }
wait_for 30 killed || fails "no task runs: $(cat slurm/slurmctld.log)"
works "status" 1 "$pellicle" blocks status plan
says "status" '^step 4 +level 0 +0 done +10 left$' stdout
wait_for 60 empty || fails "the steps do not end: $(squeue)"
works "killed: status" 1 "$pellicle" blocks status plan
says "killed: status" '^step 4 +level 0 +0 done +10 left$' stdout

# ---- what is left is submitted again; a task is queued again while it runs, and goes on
submit "submit again"
[ "$(grep -c '^sbatch ' stdout)" -eq 2 ] || fails "submit again: $(grep ^sbatch stdout)"
says "submit again" '^sbatch --parsable --array=[0-9,]+ .* 0 10$' stdout
again() { squeue -h -t R -o %i | head -n 1; }
running() { [ -n "$(again)" ]; }
wait_for 30 running || fails "no task runs again"
scontrol requeue "$(again)" || fails "requeue"
wait_for 90 empty || fails "the steps do not end again: $(squeue)"
scontrol show job >stdout
says "queued again" 'Restarts=1' stdout

# ---- the same bytes
works "all is done" 0 "$pellicle" blocks status plan
says "all is done" '^level 0 +has not converged in [0-9]+ of 21 tasks' stdout
for block in here/level0/*.blk; do
  cmp -s "$block" "plan/level0/${block##*/}" || fails "${block##*/}: other bytes than here"
done
[ "$(find plan/level0 -name '*.blk' | wc -l)" -eq 21 ] || fails "not 21 blocks: $(tail -n 20 plan/logs/*)"
[ -z "$(find plan/level0 -name '.*')" ] || fails "something half-written is left"
works "nothing is left" 0 "$pellicle" blocks submit slurm plan
says "nothing is left" 'nothing is left to do' stdout
works "a mesh" 0 "$pellicle" blocks mesh plan -o chain.ply
works "a mesh" 0 "$pellicle" check chain.ply

[ $failures -eq 0 ] || { echo "$failures failures"; exit 1; }
echo "All as expected."
