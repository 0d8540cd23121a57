# Completion of the command pellicle for bash: commands, options and their choices are those that
# --help of the command itself tells, so that none is forgotten here.

_pellicle_choices() {  # PROGRAM COMMAND OPTION: what stands between bars behind the option in the help
  "$1" "$2" --help 2>/dev/null |
    sed -nE "s/^ +(-[a-zA-Z],)?$3 +([^ =]*\|[^ =]*).*/\2/p" | tr '|' '\n' | grep -E '^[a-z0-9-]+$'
}

_pellicle() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}
  local command=${COMP_WORDS[1]} words=
  if [ "$COMP_CWORD" -eq 1 ]; then
    words=$("$program" --help 2>/dev/null |
      sed -nE '/^Subcommands:/,$ s/^  ([a-z]+) .*/\1/p; s/^  (-[a-zA-Z],)?(--[a-z-]+).*/\2/p')
  elif [[ $word == -* ]]; then
    words=$("$program" "$command" --help 2>/dev/null |
      sed -nE 's/^  (-[a-zA-Z],)?(--[a-z-]+).*/\2/p')
  elif [[ $previous == --* ]]; then
    words=$(_pellicle_choices "$program" "$command" "$previous")
  elif [ "$command" = phantom ] && [ "$COMP_CWORD" -eq 2 ]; then
    words=$("$program" phantom --help 2>/dev/null |
      sed -nE 's/^ +KIND .*One of (.*)/\1/p' | tr -d ,)
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  # Whatever has no list of its own may be a file.
  [ ${#COMPREPLY[@]} -gt 0 ] || compopt -o default 2>/dev/null
}

complete -F _pellicle pellicle
