#!/usr/bin/env bash
# A cohort whose runs are killed, interrupted, and run twice at once; and BIDS trees.
#   tests/tools/test_cohort_killed.sh PELLICLE
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/command_helpers.sh"
# shellcheck source=tests/tools/cohort_helpers.sh
source "$tests/cohort_helpers.sh"

count=12
make_scans $count 96
plan() { works "a plan" 0 "$pellicle" cohort plan scans -o study --iso 0.5; }
no_children() { ! pgrep -f "$here/study/wor[k]|--output=study/wor[k]" >/dev/null; }
whole_and_finished() {  # WHAT
  whole study
  works "$1: run again" 0 "$pellicle" cohort run study
  says "$1: run again" "left 0" stdout
  works "$1: status" 0 "$pellicle" cohort status study
  same_as_single study --iso 0.5
  [ -z "$(find study/work -mindepth 1)" ] || fails "$1: left in work: $(find study/work -mindepth 1)"
}

# ---- killed in the middle, three times: after the first scan, and at any moment of the next ones
plan
for _ in 1 2 3; do
  before=$(done_in study)
  "$pellicle" cohort run study --threads 1 >/dev/null 2>&1 &
  run=$!
  wait_for 20 at_least study $((before + 1)) || fails "kill: nothing was done"
  sleep "0.$((RANDOM % 3))"
  kill -KILL $run 2>/dev/null || fails "kill: the run had ended"
  wait $run 2>/dev/null
  wait_for 10 no_children || fails "kill: the scan goes on without the run"
  whole study
done
whole_and_finished "killed"
rm -r study

# ---- interrupted: what is being made ends, and no more begins
plan
"$pellicle" cohort run study --threads 1 >out/said 2>out/error &
run=$!
wait_for 20 at_least study 2 || fails "interrupt: nothing was done"
kill -TERM $run
code=0
wait $run || code=$?
[ $code -eq 130 ] || fails "interrupt: exit code $code"
says "interrupt" 'failed 0, skipped 0, left [1-9]' out/said
[ "$(cat out/error)" = 'pellicle: interrupted' ] || fails "interrupt: says $(cat out/error)"
[ ! -e study/failed ] || fails "interrupt: is noted as a failure"
whole_and_finished "interrupted"
rm -r study out/*

# ---- a scan that is killed, as one for which there is no memory, is noted; the others are done
plan
"$pellicle" cohort run study --threads 1 >out/said 2>out/error &
run=$!
wait_for 20 at_least study 1 || fails "a killed scan: nothing was done"
child() { pgrep -P $run; }
wait_for 20 child >/dev/null || fails "a killed scan: there is none"
kill -KILL "$(child | head -1)" || fails "a killed scan: it has ended"
code=0
wait $run || code=$?
[ $code -eq 1 ] || fails "a killed scan: exit code $code"
says "a killed scan" 'done 11, failed 1, skipped 0, left 0' out/said
says "a killed scan" 'was killed \(signal 9\), perhaps for want of memory' out/error
works "a killed scan, again" 0 "$pellicle" cohort run study --retry-failed
whole_and_finished "a killed scan"
rm -r study out/*

# ---- three runs at once make each scan once
plan
for i in 1 2 3; do "$pellicle" cohort run study --threads 1 >"out/$i" 2>&1 & done
wait
made=$(sed -nE 's/^done ([0-9]+),.*/\1/p' out/1 out/2 out/3 | paste -sd+ | bc)
[ "$made" = $count ] || fails "three runs at once: $made made, not $count: $(cat out/1 out/2 out/3)"
whole_and_finished "three runs"
rm -r study out/*

# ---- a BIDS tree
mkdir -p bids/sub-01/anat bids/sub-02/ses-a/anat bids/sub-02/ses-a/ct
echo '{"Name": "made up", "BIDSVersion": "1.8.0"}' >bids/dataset_description.json
python3 "$tests/nifti_of_nrrd.py" scans/s1.nrrd bids/sub-01/anat/sub-01_T1w.nii.gz || exit 1
cp bids/sub-01/anat/sub-01_T1w.nii.gz bids/sub-02/ses-a/anat/sub-02_ses-a_run-1_T1w.nii.gz
cp bids/sub-01/anat/sub-01_T1w.nii.gz bids/sub-02/ses-a/anat/sub-02_ses-a_T2w.nii.gz
refused "a BIDS tree without a suffix" '--suffix tells which images' "$pellicle" cohort plan bids -o out/d --iso 0.5
refused "a BIDS tree without such images" 'no scans' "$pellicle" cohort plan bids -o out/d --suffix CT --iso 0.5
derived=bids/derivatives/pellicle
works "a plan of BIDS" 0 "$pellicle" cohort plan bids -o $derived --suffix T1w --iso 0.5
works "BIDS" 0 "$pellicle" cohort run $derived
for name in sub-01/anat/sub-01 sub-02/ses-a/anat/sub-02_ses-a_run-1; do
  [ -s "$derived/${name}_desc-pellicle_mesh.ply" ] || fails "BIDS: no $name"
  [ "$(jq -r .Sources[0] "$derived/${name}_desc-pellicle_mesh.json")" = "${name}_T1w.nii.gz" ] || fails "BIDS: sources of $name"
done
[ "$(jq -r .GeneratedBy[0].Name $derived/dataset_description.json)" = Pellicle ] || fails "BIDS: description"
[ "$(jq -r .DatasetType $derived/dataset_description.json)" = derivative ] || fails "BIDS: type"
works "a plan of two surfaces" 0 "$pellicle" cohort plan bids -o $derived --suffix T1w --iso 0.5,0.6
works "two surfaces" 0 "$pellicle" cohort run $derived
[ -s $derived/sub-01/anat/sub-01_desc-0p6_mesh.ply ] || fails "BIDS: two surfaces: $(find $derived -name '*.ply')"

[ $failures -eq 0 ] || { echo "$failures failures"; exit 1; }
echo "All as expected."
