# bash completion of `footfall`. Load it with
#   source tools/completion/footfall.bash
# or copy it to ~/.local/share/bash-completion/completions/footfall.
#
# Sub-commands and options are taken from the program's --help; parameters and gains from the running engine
# (`footfall tune list --names`, half a second at most), none without an engine.

# Words of `footfall [SUB-COMMANDS] --help` that begin with the pattern: "options" or "subcommands".
_footfall_help_words() {
  local kind=$1
  shift
  "$@" --help 2>/dev/null | awk -v kind="$kind" '
    /^Subcommands:/ { in_commands = 1; next }
    /^[A-Z]/ { in_commands = 0 }
    kind == "subcommands" && in_commands && /^  [a-z]/ { print $1 }
    kind == "options" && /^  -/ {
      line = $0
      sub(/^ +/, "", line)
      sub(/  .*/, "", line)
      gsub(/[,{ ]/, "\n", line)
      n = split(line, words, "\n")
      for (i = 1; i <= n; ++i) if (words[i] ~ /^--[a-z]/) print words[i]
    }'
}

# Options before the current word that select the engine.
_footfall_engine_options() {
  local i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case ${COMP_WORDS[i]} in
      --url | --prefix | --key)
        printf '%s\n' "${COMP_WORDS[i]}" "${COMP_WORDS[i + 1]}"
        ;;
      --open) echo --open ;;
    esac
  done
}

_footfall_parameters() {
  local options=()
  mapfile -t options < <(_footfall_engine_options)
  timeout 1 "$1" tune list --names --timeout 0.7s "${options[@]//[\"\']/}" 2>/dev/null
}

_footfall_behaviors() {
  local folder file
  for folder in . "${FOOTFALL_PATH:-.}"; do
    for file in "$folder"/behaviors/library/*.yaml; do
      [[ -f $file ]] && basename "$file" .yaml
    done
  done
}

# Completes names that begin with the word; those for `set` are followed by `=`.
_footfall_reply() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$2")
}

_footfall_tune_arguments() {
  local program=$1 action=$2 word=$3
  case $action in
    set | ramp)
      [[ $word == *=* ]] && return
      _footfall_reply "$(_footfall_parameters "$program")" "$word"
      COMPREPLY=("${COMPREPLY[@]/%/=}")
      compopt -o nospace
      ;;
    get | list | watch | save) _footfall_reply "$(_footfall_parameters "$program")" "$word" ;;
    key) mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;
  esac
}

_footfall() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local commands=() i candidate
  COMPREPLY=()
  # `NAME=` is three words to bash: values are not completed.
  [[ $word == = || $previous == = ]] && return
  # The sub-commands so far: `tune`, `tune set`.
  for ((i = 1; i < COMP_CWORD && ${#commands[@]} < 2; ++i)); do
    candidate=${COMP_WORDS[i]}
    if [[ $candidate == --url || $candidate == --key || $candidate == --prefix || $candidate == --who ||
      $candidate == --timeout ]]; then
      ((++i))
    elif [[ $candidate == [a-z]* && (${#commands[@]} -eq 0 || ${commands[0]} == tune) ]]; then
      commands+=("$candidate")
    fi
  done
  if [[ $word == -* ]]; then
    _footfall_reply "$(_footfall_help_words options "$program" "${commands[@]}")" "$word"
    return
  fi
  case $previous in
    --log | --film | --world | --robot | --key | --to | --script | --lcm-key | --junit)
      mapfile -t COMPREPLY < <(compgen -f -- "$word")
      compopt -o filenames
      return
      ;;
  esac
  if ((${#commands[@]} == 0)); then
    _footfall_reply "$(_footfall_help_words subcommands "$program")" "$word"
  elif [[ ${commands[0]} == tune ]]; then
    if ((${#commands[@]} == 1)); then
      _footfall_reply "$(_footfall_help_words subcommands "$program" tune)" "$word"
    else
      _footfall_tune_arguments "$program" "${commands[1]}" "$word"
    fi
  else
    local names=""
    case ${commands[0]} in
      run | check | graph | signals | config | trace) names=$(_footfall_behaviors) ;;
    esac
    mapfile -t COMPREPLY < <(
      compgen -W "$names" -- "$word"
      compgen -f -- "$word"
    )
    compopt -o filenames
  fi
}

complete -F _footfall footfall
