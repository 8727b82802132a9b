# shellcheck shell=bash
# Shared by the tools: the project's root as working directory, help and error texts, and stages with their time.
# Sourced by tools/demo, tools/test and tools/check; does nothing on its own.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Colour only on a terminal.
if [[ -t 1 ]]; then bold=$'\e[1m' red=$'\e[31m' green=$'\e[32m' plain=$'\e[0m'; else bold='' red='' green='' plain=''; fi

die() {  # die CODE TEXT...
  local code=$1
  shift
  printf '%serror:%s %s\n' "$red" "$plain" "$*" >&2
  exit "$code"
}

# Prints the tool's head comment as its help text.
usage() { sed -n '2,/^$/ s/^# \{0,1\}//p' "$0"; }

stage_names=() stage_times=() stage_results=()

# stage NAME COMMAND...: runs the command, records its duration and success, returns its exit code.
stage() {
  local name=$1 begin=$SECONDS code=0
  shift
  printf '%s== %s%s\n' "$bold" "$name" "$plain"
  "$@" || code=$?
  stage_names+=("$name") stage_times+=($((SECONDS - begin)))
  if ((code == 0)); then stage_results+=("${green}ok$plain"); else stage_results+=("${red}failed$plain"); fi
  return "$code"
}

print_stages() {
  local i
  printf '\n%s%-28s %8s  %s%s\n' "$bold" stage seconds result "$plain"
  for i in "${!stage_names[@]}"; do
    printf '%-28s %8d  %s\n' "${stage_names[$i]}" "${stage_times[$i]}" "${stage_results[$i]}"
  done
  printf '%-28s %8d\n' total "$SECONDS"
}

# configure PRESET [ARGUMENTS...]: configures quietly; prints the output only on failure.
configure() {
  local preset=$1
  shift
  mkdir -p out
  if ! cmake --preset "$preset" "$@" >"out/configure-$preset.log" 2>&1 </dev/null; then
    cat "out/configure-$preset.log" >&2
    return 1
  fi
}

build() {  # build PRESET [ARGUMENTS...]
  local preset=$1
  shift
  cmake --build --preset "$preset" "$@" </dev/null
}
