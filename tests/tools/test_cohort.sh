#!/usr/bin/env bash
# A cohort on one machine: planned, run in shares, killed, repaired, collected.
#   tests/tools/test_cohort.sh PELLICLE
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/command_helpers.sh"
# shellcheck source=tests/tools/cohort_helpers.sh
source "$tests/cohort_helpers.sh"

# plan_stays WHAT WORD COMMAND...: as refused, but the plan that is there stays.
plan_stays() {
  cp study/cohort.json before
  refused "$@"
  cmp -s before study/cohort.json || fails "$1: the plan is changed"
}

# ---- a table, in two shares, beside single extractions
make_scans 6
head -c 20000 scans/s4.nrrd >scans/cut.nrrd
{
  printf 'name\tinput\tcurvature\tno-late-bubbles\n'
  for i in 1 2 3 5 6; do printf 's%d\tscans/s%d.nrrd\tn/a\tno\r\n' $i $i; done
  printf 'cut\tscans/cut.nrrd\t\t\n'
  printf 'smooth one\tscans/s4.nrrd\t0.2\tyes\n'
} >list.tsv
works "a plan" 0 "$pellicle" cohort plan list.tsv -o study --iso 0.5
says "a plan" 'planned 7 scans' stdout
works "the first share" 0 "$pellicle" cohort run study --task 1/2
says "the first share" 'done 4, failed 0, skipped 0, left 0' stdout
works "half of it" 1 "$pellicle" cohort status study
says "half of it" '^left +3$' stdout
says "half of it" '^end +[0-9]{4}-' stdout
works "the second share" 1 "$pellicle" cohort run study --task 2/2
says "the second share" 'done 2, failed 1' stdout
says "a truncated scan" '^pellicle: cut: .*is truncated' stderr
[ "$(wc -l <stderr)" -eq 1 ] || fails "a truncated scan: not one line"
[ ! -e study/cut.ply ] && [ ! -e study/cut.json ] || fails "a truncated scan leaves an output"
same_as_single study --iso 0.5
expect_hash "options of a row" "study/smooth one.json" scans/s4.nrrd --iso 0.5 --curvature 0.2 --no-late-bubbles
works "its status" 1 "$pellicle" cohort status study --json
[ "$(jq -c '[.done, .failed, .left, (.errors | length)]' stdout)" = '[6,1,0,1]' ] || fails "status --json: $(cat stdout)"
works "again" 0 "$pellicle" cohort run study
says "again: nothing" 'done 0, failed 0, skipped 7' stdout
works "what has failed, again" 1 "$pellicle" cohort run study --retry-failed
says "what has failed, again" 'done 0, failed 1, skipped 6' stdout

# ---- the table of all
works "collect" 0 "$pellicle" cohort collect study
column_of() { awk -F'\t' -v c="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == c) k = i; next } { print $k }' "$2"; }
[ "$(column_of state study/cohort.tsv | sort | uniq -c | xargs)" = '6 done 1 failed' ] || fails "collect: states"
[ "$(column_of hash study/cohort.tsv | head -1)" = "$(jq -r .hash study/s1.json)" ] || fails "collect: hashes"
[ "$(column_of volume_mm3 study/cohort.tsv | head -1)" = "$(jq .surface.volume study/s1.json)" ] || fails "collect: volumes"
[ "$(column_of converged study/cohort.tsv | head -1)" = true ] || fails "collect: converged"
column_of error study/cohort.tsv | grep -q 'is truncated' || fails "collect: errors"
[ "$(awk -F'\t' '{ print NF }' study/cohort.tsv | sort -u | wc -l)" -eq 1 ] || fails "collect: lines differ in columns"
works "collect to stdout" 0 "$pellicle" cohort collect study -o /dev/stdout
cmp -s stdout study/cohort.tsv || fails "collect: stdout differs"

# ---- bad lists
table() { printf "$@" >bad.tsv; }
table 'name\tinput\na\tscans/s1.nrrd\na\tscans/s2.nrrd\n'
plan_stays "a name twice" 'row 3: the name a is that of bad.tsv: row 2' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name\tinput\tis\na\tscans/s1.nrrd\t1\n'
plan_stays "an unknown column" 'bad.tsv: column is is no option' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name\tinput\treport\na\tscans/s1.nrrd\tr.json\n'
plan_stays "a column of files" 'column report is no option' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name\tinput\tiso\na\tscans/s1.nrrd\t0.5\nb\tscans/s2.nrrd\thalf\n'
plan_stays "a bad value" "row 3, column iso: .*'half' is not" "$pellicle" cohort plan bad.tsv -o study
table 'name\tinput\tno-sleeping\na\tscans/s1.nrrd\tmaybe\n'
plan_stays "a bad flag" "row 2, column no-sleeping: 'maybe' is not yes or no" "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name\tinput\tcurvature\na\tscans/s1.nrrd\t-1\n'
plan_stays "a value out of range" 'row 2: curvature -1: must be' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
plan_stays "no iso" 'iso: not set' "$pellicle" cohort plan scans -o study
table 'name\tinput\na\tscans/none.nrrd\n'
plan_stays "a missing input" 'row 2, column input: .*there is no such file' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name\tinput\na/b\tscans/s1.nrrd\n'
plan_stays "a name with a slash" "row 2, column name: 'a/b'" "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name\tinput\nwork\tscans/s1.nrrd\n'
plan_stays "a name that is taken" 'row 2: the name work is taken' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name\tinput\na\n'
plan_stays "a short row" 'row 2: has 1 columns' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name\tinput\tinput\n'
plan_stays "a column twice" 'column input is there twice' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name,input\na,b\n'
plan_stays "commas" 'no column "name"' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name\tinput\n'
plan_stays "no rows" 'there are no scans' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name\tinput\tattach\na\tscans/s1.nrrd\tnone.txt\n'
plan_stays "a missing file of an option" 'none.txt: there is no such file' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
table 'name\tinput\n\xff\tscans/s1.nrrd\n'
plan_stays "a name that is no UTF-8" 'row 2, column name: .*UTF-8' "$pellicle" cohort plan bad.tsv -o study --iso 0.5
plan_stays "a bad option" "curvature: 'x' is not" "$pellicle" cohort plan scans -o study --iso 0.5 --curvature x
refused "no plan" 'cohort.json: cannot be read' "$pellicle" cohort run out
refused "a bad share" "task: '3/2' is not" "$pellicle" cohort run study --task 3/2
echo nobody >names
refused "an unknown scan" 'nobody is no scan' "$pellicle" cohort run study --scans names
refused "no verb" 'plan, run, status, collect or submit' "$pellicle" cohort
refused "an unknown verb" 'plan, run, status, collect or submit' "$pellicle" cohort fun
refused "another scheduler" "'lsf' is not slurm" "$pellicle" cohort submit lsf study

# ---- inputs that change
cp scans/s4.nrrd scans/cut.nrrd
works "a repaired scan" 1 "$pellicle" cohort run study --retry-failed
says "a repaired scan" 'cut: .*has changed since the plan; plan again' stderr
works "another plan" 0 "$pellicle" cohort plan list.tsv -o study --iso 0.5
says "another plan" '^done +6$' stdout
works "the repaired scan" 0 "$pellicle" cohort run study
says "the repaired scan" 'done 1, failed 0, skipped 6' stdout
[ ! -e study/failed/cut.json ] || fails "an error that is mended is still there"
works "all of it" 0 "$pellicle" cohort status study
touch scans/s1.nrrd
works "an input that is only younger" 0 "$pellicle" cohort run study
cp scans/s2.nrrd scans/s1.nrrd
works "an input that changes afterwards" 1 "$pellicle" cohort run study
says "an input that changes afterwards" 's1: its input has changed since the plan; plan again' stderr
cp study/s1.json before
works "a plan of it" 0 "$pellicle" cohort plan list.tsv -o study --iso 0.5
works "that scan alone" 0 "$pellicle" cohort run study
says "that scan alone" 'done 1, failed 0, skipped 6' stdout
cmp -s before study/s1.json && fails "a changed input: the old report is there"
rm study/s3.ply
works "an output that has gone" 0 "$pellicle" cohort run study
says "an output that has gone" 'done 1, failed 0, skipped 6' stdout

# ---- several surfaces, another format, a folder; what an earlier plan has left goes
works "a folder" 0 "$pellicle" cohort plan scans -o study --iso 0.5,0.6 --format stl
works "several surfaces" 0 "$pellicle" cohort run study --jobs 2 --memory 1
for name in s2 s3; do
  for iso in 0.5 0.6; do
    [ -s study/$name/$iso.stl ] && [ -s study/$name/$iso.json ] || fails "no study/$name/$iso"
  done
  [ ! -e study/$name.ply ] || fails "study/$name.ply of the earlier plan is there"
done
grep -q 'work/' study/s2/*.json && fails "a report names the folder where it was made"
works "their table" 0 "$pellicle" cohort collect study
[ "$(wc -l <study/cohort.tsv)" -eq 15 ] || fails "the table of several surfaces has $(wc -l <study/cohort.tsv) lines"
mkdir labels
"$pellicle" phantom labels -o labels/atlas.nrrd --size 40 --count 3 >/dev/null
works "a plan of labels" 0 "$pellicle" cohort plan labels -o parts --labels
works "labels" 0 "$pellicle" cohort run parts
[ -s parts/atlas/1.ply ] && [ -s parts/atlas/2.json ] || fails "labels: $(find parts)"

[ $failures -eq 0 ] || { echo "$failures failures"; exit 1; }
echo "All as expected."
