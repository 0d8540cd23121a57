#!/usr/bin/env bash
# The manual page and the completion for bash know every command and option that --help tells.
#   tests/tools/test_manual.sh PELLICLE
set -uo pipefail
pellicle=$(realpath "$1")
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
cd "$here" || exit 1
failures=0

fails() {
  echo "FAILED: $1"
  failures=$((failures + 1))
}

commands=$("$pellicle" --help | sed -nE '/^Subcommands:/,$ s/^  ([a-z]+) .*/\1/p')
[ "$(wc -w <<<"$commands")" -ge 7 ] || fails "--help tells no commands"
options_of() { "$pellicle" $1 --help | grep -oE -- '^  (-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+'; }

# ---- the manual page
"$pellicle" --man >pellicle.1 || fails "--man"
if command -v man >/dev/null; then
  LC_ALL=C.UTF-8 MANWIDTH=200 man --warnings -l pellicle.1 2>warnings >plain || fails "man does not read the page"
  [ ! -s warnings ] || fails "man warns: $(head -3 warnings)"
  col -b <plain >text
  for command in $commands; do
    grep -qE "^ *pellicle $command " text || fails "man shows no pellicle $command"
  done
fi
sed -E 's/\\f[BIR]//g; s/\\-/-/g' pellicle.1 >source
described_in() {  # SECTION: the options that have an entry of their own there
  awk -v section=".SH $1" '/^\.SH / {there = $0 == section} there && entry {print} {entry = $0 == ".TP"}' source |
    grep -oE -- '^(-[a-z], ?)?--[a-z-]+' | grep -oE -- '--[a-z-]+'
}
same_options() {  # WHAT FOUND EXPECTED
  local wrong
  wrong=$(diff <(sort -u <<<"$2") <(sort -u <<<"$3")) || fails "$1: $(xargs <<<"$wrong")"
}
same_options "the manual page's options of all commands" "$(described_in OPTIONS)" "$(options_of '')"
passed_on_in() {  # SECTION: the options that it says to be those of extract
  awk -v section=".SH $1" '/^\.SH / {there = $0 == section} there && /^As of pellicle extract: /' source |
    grep -oE -- '--[a-z-]+'
}
verbs_of() { "$pellicle" "$1" --help | sed -nE '/^Subcommands:/,$ s/^  ([a-z]+) .*/\1/p'; }
for command in $commands; do
  verbs=$(verbs_of "$command")
  mapfile -t calls < <(if [ -n "$verbs" ]; then printf "$command %s\n" $verbs; else echo "$command"; fi)
  for call in "${calls[@]}"; do
    grep -qxF ".B pellicle $call" source || fails "the manual page has no pellicle $call"
    same_options "the manual page's options of $call" \
      "$(described_in "PELLICLE $call"; passed_on_in "PELLICLE $call")" "$(options_of "$call")"
  done
done
[ -n "$(passed_on_in "PELLICLE cohort plan")" ] || fails "the manual page names no options that are passed on"

# ---- completion
mkdir bin
ln -s "$pellicle" bin/pellicle
export PATH=$here/bin:$PATH
# shellcheck source=tools/cmake/pellicle.bash
source "$source/tools/cmake/pellicle.bash"
complete_with() {  # WORD...: what can stand for the last one
  COMP_WORDS=("$@")
  COMP_CWORD=$(($# - 1))
  COMPREPLY=()
  _pellicle
  printf '%s\n' "${COMPREPLY[@]}"
}
same() { [ "$(sort -u <<<"$2")" = "$(sort -u <<<"$3")" ] || fails "completion of $1: $(xargs <<<"$2")"; }
same "commands" "$(complete_with pellicle '' | grep -v '^-')" "$commands"
same "verbs of cohort" "$(complete_with pellicle cohort '')" "$(printf '%s\n' plan run status collect submit)"
same "options of a verb" "$(complete_with pellicle cohort run --)" "$(options_of 'cohort run')"
same "me" "$(complete_with pellicle me)" "$(printf 'measure\nmesh')"
for command in $commands; do
  same "options of $command" "$(complete_with pellicle "$command" --)" "$(options_of "$command")"
done
same "--space" "$(complete_with pellicle extract a.nii --space '')" "$(printf 'lps\nras\nvoxel')"
same "--keep" "$(complete_with pellicle mesh a.ply --keep '')" "$(printf 'all\nlargest')"
same "--inside b" "$(complete_with pellicle extract a.nii --inside b)" below
same "phantoms" "$(complete_with pellicle phantom sh)" shell
same "a file" "$(complete_with pellicle extract he)" ""

[ $failures -eq 0 ] || { echo "$failures failures"; exit 1; }
echo "All as expected."
