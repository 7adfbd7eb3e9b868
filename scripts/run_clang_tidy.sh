#!/usr/bin/env bash
# clang-tidy over the sources, the most recently changed first.
# usage: run_clang_tidy.sh [--since COMMIT] [--seconds N]
#   --since COMMIT   only what has changed since then, and the sources that include a changed header
#   --seconds N      begins no further file after that time, and names those left
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

since=""
seconds=86400
while [[ $# -gt 0 ]]; do
  case "$1:$#" in
    --since:[2-9]) since=$2 ;;
    --seconds:[2-9]) seconds=$2 ;;
    *)
      echo "usage: $0 [--since COMMIT] [--seconds N]" >&2
      exit 2
      ;;
  esac
  shift 2
done

# What differs from a commit, files that git does not know included.
changed_since() {
  git diff --name-only "$1"
  git ls-files --others --exclude-standard
}

# All sources that CMake compiles, the most recently changed first.
sources_by_age() {
  {
    changed_since HEAD
    git log --format= --name-only
  } | grep '\.cpp$' | awk '!seen[$0]++' | while read -r source; do
    ! grep --quiet --fixed-strings "\"$PWD/$source\"" "$build/compile_commands.json" || echo "$source"
  done
}

# Of the sources on stdin those that are among the changed files or include one.
concerned_by() {
  local changed=$1 includes source
  includes=$(sed -n 's/.*\.h$/#include "&"/p' <<<"$changed")
  while read -r source; do
    if grep --quiet --line-regexp --fixed-strings "$source" <<<"$changed" ||
      { [[ -n $includes ]] && grep --quiet --fixed-strings "$includes" "$source"; }; then
      echo "$source"
    fi
  done
}

sources_to_check() {
  local changed
  [[ -z $since ]] || changed=$(changed_since "$since")
  if [[ -z $since ]] || grep --quiet '^\.clang-tidy$' <<<"$changed"; then
    sources_by_age
  else
    sources_by_age | concerned_by "$changed"
  fi
}

# Run by xargs: one source, unless the time is up; prints what was found.
# shellcheck disable=SC2317
check() {
  if [[ $(date +%s) -ge $deadline ]]; then
    echo "$1" >>"$left"
    return
  fi
  local findings
  if ! findings=$(clang-tidy --quiet -p "$build" "$1" 2>&1); then
    grep --invert-match 'warnings\? .*generated' <<<"$findings"
    return 1
  fi
}

build=build/tidy
left=$build/left.txt
deadline=$(($(date +%s) + seconds))
export build left deadline
export -f check

# clang cannot read the headers that GCC has precompiled.
cmake --preset release -B "$build" -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null
: >"$left"
sources=$(sources_to_check)
status=0
# shellcheck disable=SC2016
xargs --no-run-if-empty --max-procs="$(nproc)" --max-args=1 bash -c 'check "$1"' check <<<"$sources" || status=1
echo "clang-tidy: $(($(grep --count . <<<"$sources" || true) - $(wc -l <"$left"))) sources checked"
if [[ -s $left ]]; then
  echo "clang-tidy: no time was left for:"
  sed 's/^/  /' "$left"
fi
exit "$status"
