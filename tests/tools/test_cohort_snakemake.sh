#!/usr/bin/env bash
# A cohort by tools/cohort/Snakefile: a truncated scan, a scan killed in the middle, a plan that changes.
#   tests/tools/test_cohort_snakemake.sh PELLICLE
# Needs snakemake; else it says so and is left out (exit 77).
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
command -v snakemake >/dev/null || { echo "Left out: snakemake is not installed."; exit 77; }
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/command_helpers.sh"
# shellcheck source=tests/tools/cohort_helpers.sh
source "$tests/cohort_helpers.sh"

flow() {
  XDG_CACHE_HOME=$PWD/cache snakemake -s "$tests/../../tools/cohort/Snakefile" --cores 2 --nolock \
    --config cohort=study "pellicle=$pellicle" "$@"
}
states() { cut -f "$(head -1 study/cohort.tsv | tr '\t' '\n' | grep -nx state | cut -d: -f1)" study/cohort.tsv | sort | uniq -c | xargs; }

make_scans 4 48
cp scans/s3.nrrd whole.nrrd
head -c 50000 whole.nrrd >scans/s3.nrrd
mv scans/s4.nrrd "scans/s four.nrrd"
works "a plan" 0 "$pellicle" cohort plan scans -o study --iso 0.5
# The first scan that is run is killed.
cat >slow <<END
#!/bin/sh
if [ "\$2" = run ] && mkdir killed 2>/dev/null; then exit 137; fi
exec "$pellicle" "\$@"
END
chmod +x slow
flow "pellicle=$PWD/slow" >log 2>&1 && fails "a job that is killed: snakemake tells nothing"
[ ! -e study/cohort.tsv ] || fails "a job that is killed: a table"
works "snakemake" 0 flow --rerun-incomplete
[ "$(states)" = '3 done 1 failed 1 state' ] || fails "states: $(states)"
same_as_single study --iso 0.5
works "nothing is left" 0 flow
says "nothing is left" 'Nothing to be done' stderr
cp whole.nrrd scans/s3.nrrd
works "a plan of the mended scan" 0 "$pellicle" cohort plan scans -o study --iso 0.5
works "the mended scan, in groups" 0 flow --group-components scans=4
[ "$(states)" = '4 done 1 state' ] || fails "states after mending: $(states)"
whole study

[ $failures -eq 0 ] || { echo "$failures failures"; exit 1; }
echo "All as expected."
