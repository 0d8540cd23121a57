# Completion of the command pellicle for bash: commands, options and their choices are those that
# --help of the command itself tells, so that none is forgotten here.

_pellicle_choices() {  # OPTION COMMAND...: what stands between bars behind the option in the help
  local option=$1
  shift
  "$@" --help 2>/dev/null |
    sed -nE "s/^ +(-[a-zA-Z],)?$option +([^ =]*\|[^ =]*).*/\2/p" | tr '|' '\n' | grep -E '^[a-z0-9-]+$'
}

_pellicle_commands() {  # COMMAND...: what can follow it
  "$@" --help 2>/dev/null | sed -nE '/^Subcommands:/,$ s/^  ([a-z]+) .*/\1/p'
}

_pellicle() {
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} next=1 words=''
  local command=("${COMP_WORDS[0]}")  # with its subcommands
  while [ "$next" -lt "$COMP_CWORD" ] &&
    grep -qxF -- "${COMP_WORDS[next]}" <(_pellicle_commands "${command[@]}"); do
    command+=("${COMP_WORDS[next++]}")
  done
  [ "$next" -lt "$COMP_CWORD" ] || words=$(_pellicle_commands "${command[@]}")
  if [[ $word == -* || $COMP_CWORD -eq 1 ]]; then
    words+=" $("${command[@]}" --help 2>/dev/null | sed -nE 's/^  (-[a-zA-Z],)?(--[a-z-]+).*/\2/p')"
  elif [[ $previous == --* ]]; then
    words=$(_pellicle_choices "$previous" "${command[@]}")
  elif [ "${command[1]}" = phantom ] && [ "$COMP_CWORD" -eq 2 ]; then
    words=$("${command[@]}" --help 2>/dev/null | sed -nE 's/^ +KIND .*One of (.*)/\1/p' | tr -d ,)
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  # Whatever has no list of its own may be a file.
  [ ${#COMPREPLY[@]} -gt 0 ] || compopt -o default 2>/dev/null
}

complete -F _pellicle pellicle
