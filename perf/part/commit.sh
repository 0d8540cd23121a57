# What results are of. Sourced by perf/run and perf/experiments.

# commit_of ROOT: that of the sources, "-dirty" where they differ from it. To commit results changes
# nothing.
commit_of() {
  local commit
  commit=$(git -C "$1" log -1 --format=%h -- . ':!perf/results') || commit=
  if [ -z "$commit" ]; then
    echo unknown
  elif git -C "$1" diff --quiet HEAD -- . ':!perf/results'; then
    echo "$commit"
  else
    echo "$commit-dirty"
  fi
}

# require_clean NAME COMMIT: nobody can repeat what was measured of anything else.
require_clean() {
  case $2 in
    unknown) echo "$1: not in a git repository: of which commit the results are nobody knows" >&2 ;;
    *-dirty) echo "$1: the sources differ from commit ${2%-dirty}: commit them first" >&2 ;;
    *) return 0 ;;
  esac
  exit 2
}
