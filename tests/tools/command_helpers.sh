# For the tests of the command: sourced with $pellicle set. The test goes on in a folder of its own, $here,
# which has out/ in it and is removed at the end.
# shellcheck shell=bash
failures=0
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
cd "$here" || exit 1
mkdir out

fails() {
  echo "FAILED: $1"
  sed 's/^/    /' stderr
  failures=$((failures + 1))
}

# What is left in out/ is removed, so that every case starts with an empty folder.
left_over() {
  local left
  left=$(find out -mindepth 1)
  find out -mindepth 1 -delete
  echo "$left"
}

# refused WHAT WORD COMMAND...: exit code 2, one line on stderr that has WORD in it, nothing written.
refused() {
  local what=$1 word=$2 code=0 left
  shift 2
  "$@" >stdout 2>stderr </dev/null || code=$?
  left=$(left_over)
  if [ $code -ne 2 ]; then fails "$what: exit code $code, not 2"
  elif [ "$(wc -l <stderr)" -ne 1 ]; then fails "$what: not one line on stderr"
  elif ! grep -qi -- "$word" stderr; then fails "$what: the line does not say \"$word\""
  elif [ -s stdout ]; then fails "$what: writes to stdout"
  elif [ -n "$left" ]; then fails "$what: leaves $left"
  fi
}

# works WHAT CODE COMMAND...: that exit code.
works() {
  local what=$1 expected=$2 code=0
  shift 2
  "$@" >stdout 2>stderr </dev/null || code=$?
  if [ $code -ne "$expected" ]; then fails "$what: exit code $code, not $expected"; fi
}

says() {  # WHAT PATTERN FILE
  grep -qE -- "$2" "$3" || fails "$1: no \"$2\" in $3"
}
