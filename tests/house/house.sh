#!/usr/bin/env bash
# The house rules that no compiler checks. Prints every line that breaks one; exit status 1 if there is any.
#   house.sh ROOT      checks the tree at ROOT
#   house.sh --self-test ROOT   breaks each rule in a copy of ROOT and sees that it is noticed
set -euo pipefail

# A room may include itself and those before it.
rooms=(format storage plugins description input threads ranks bodies contact motion domain device kernel run simulation output study calibration report lint app)

# sources FOLDER…: the C++ files below those that exist.
sources() {
  for folder in "$@"; do
    [[ -d $folder ]] && find "$folder" -type f \( -name '*.hpp' -o -name '*.cpp' \)
  done | sort
}

# find_in PATTERN: lines of the files named on stdin, "file:line: text" without // comments, that match.
find_in() {
  xargs -r -d '\n' grep -nHE '' | sed -E 's@^([^:]*:[0-9]+:)@\1 @; s@([^:"])//.*@\1@' |
    grep -E "^[^:]*:[0-9]+:.*($1)" || true
}

# report RULE: prefixes each line of stdin with the rule.
report() { sed "s@^@$1: @"; }

check() {
  [[ -d $1/core/src ]] || { echo "no tree of grit at $1" >&2; exit 2; }
  cd "$1"
  local later='' i
  for ((i = ${#rooms[@]} - 1; i >= 0; --i)); do
    if [[ -n $later ]]; then
      sources "core/src/${rooms[i]}" | find_in "#include [\"<](\.\./)*($later)/" | report "includes a later room"
    fi
    later="${rooms[i]}${later:+|$later}"
  done
  sources core/include | find_in "#include [\"<](\.\./|src/)*($later)/" | report "the SDK includes the kernel"
  sources core/src/testing | find_in "#include [\"<](\.\./|src/)*($later)/" | report "the SDK includes the kernel"
  sources plugins | grep -v '/test_[^/]*$' | find_in "#include [\"<](\.\./|core/|src/)*($later)/" |
    report "a plugin includes the kernel"

  sources core plugins tests bench | grep -vE '^(core/src/(storage|output)|tests/output)/' | find_in '#include [<"]([a-z0-9/]*/)?(hdf5|H5[A-Za-z]+)(_hl)?\.h' |
    report "HDF5 outside storage/, output/"
  sources core plugins bench | grep -vE '^core/(include/grit/(description|parameters)\.hpp|src/(storage|input|output|study|calibration|report|app)/)' |
    grep -vE '^plugins/(scenarios/|.*/test_[^/]*$)' | find_in 'nlohmann' | report "JSON outside input/, output/, study/, calibration/, report/, scenarios"

  find . -path './build*' -prune -o -type f \( -name CMakeLists.txt -o -name '*.cmake' -o -name 'CMake*Presets.json' \) \
    -exec grep -nHE '' {} + | sed -E 's@^([^:]*:[0-9]+:[^#]*)#.*@\1@' |
    grep -E -e '-Ofast|-f(fast|unsafe|finite|associative|reciprocal)-math' | report "not the same bits"

  sources core/src/launcher | find_in '#include ("|<grit/)' | report "the launcher includes grit"

  sources core | grep -vE '^core/src/(app|launcher)/' |
    find_in 'std::(cout|cerr|clog)|(^|[^A-Za-z0-9_])((v|f|vf)?printf|f?puts|putchar|abort|_?[eE]xit|quick_exit) *\(' |
    report "library code prints or exits"
  return 0
}

verdict() {
  local broken
  broken=$(check "$1") || return 2
  [[ -z $broken ]] && return
  printf '%s\n' "$broken"
  return 1
}

self_test() {
  local root=$1 failed=0 file
  copy=$(mktemp -d)
  trap 'rm -rf "$copy"' EXIT
  (cd "$root" && cp -r --parents CMakeLists.txt CMakePresets.json cmake core plugins "$copy")

  local expected=() count=0
  # write FILE LINE: a file of its own, with a number in its name, that has this line.
  write() {
    file=${1/planted/planted$((++count))}
    mkdir -p "$(dirname "$copy/$file")"
    printf '%s\n' "$2" > "$copy/$file"
  }
  # planted RULE FILE LINE: this line in this file breaks the rule.   allowed FILE LINE: it breaks none.
  planted() { write "$2" "$3"; expected+=("$1: $file:1:"); }
  allowed() { write "$1" "$2"; }

  for ((i = 0; i + 1 < ${#rooms[@]}; ++i)); do
    planted "includes a later room" "core/src/${rooms[i]}/planted.hpp" "#include \"${rooms[i + 1]}/planted.hpp\""
    allowed "core/src/${rooms[i + 1]}/planted.hpp" "#include \"${rooms[i]}/planted.hpp\""
  done
  planted "includes a later room" core/src/input/planted.cpp '#include "../app/planted.hpp"'
  planted "the SDK includes the kernel" core/include/grit/planted.hpp '#include "bodies/planted.hpp"'
  allowed core/include/grit/planted.hpp '#include "grit/contact/law.hpp"'
  planted "the SDK includes the kernel" core/src/testing/planted.cpp '#include "plugins/registry.hpp"'
  planted "a plugin includes the kernel" plugins/probes/planted/planted.cpp '#include "contact/planted.hpp"'
  allowed plugins/probes/planted/test_planted.cpp '#include "contact/planted.hpp"'
  planted "the launcher includes grit" core/src/launcher/planted.cpp '#include "plugins/build_facts.hpp"'
  planted "the launcher includes grit" core/src/launcher/planted.cpp '#include <grit/error.hpp>'
  planted "HDF5 outside storage/, output/" core/src/run/planted.cpp '#include <hdf5.h>'
  planted "HDF5 outside storage/, output/" plugins/probes/planted/planted.cpp '#include <H5Cpp.h>'
  allowed core/src/storage/planted.cpp '#include <hdf5.h>'
  planted "JSON outside input/, output/, study/, calibration/, report/, scenarios" core/src/run/planted.cpp '#include <nlohmann/json.hpp>'
  planted "JSON outside input/, output/, study/, calibration/, report/, scenarios" core/include/grit/planted.hpp '#include <nlohmann/json_fwd.hpp>'
  planted "JSON outside input/, output/, study/, calibration/, report/, scenarios" plugins/probes/planted/planted.cpp '#include <nlohmann/json.hpp>'
  for place in core/src/{input,output,report,app}/planted.cpp plugins/scenarios/planted/planted.cpp tests/planted.cpp; do
    allowed "$place" '#include <nlohmann/json.hpp>'
  done
  planted "not the same bits" bench/CMakeLists.txt 'add_compile_options(-ffast-math)'
  planted "not the same bits" cmake/planted.cmake 'add_compile_options(-Ofast)'
  allowed cmake/planted.cmake '# -ffast-math is banned'
  for line in 'std::cout << 1;' 'std::printf("1");' '  std::abort();' 'exit(1);' 'fprintf(stderr, "1");'; do
    planted "library code prints or exits" core/src/bodies/planted.cpp "$line"
    allowed core/src/app/planted.cpp "$line"
    allowed core/src/launcher/planted.cpp "$line"
  done
  allowed core/src/bodies/planted.cpp 'std::snprintf(text, 4, "1"); on_exit_of(x); // never exit(1)'

  local found wanted
  found=$(verdict "$copy" | sed 's@: \./@: @' || true)
  for wanted in "${expected[@]}"; do
    grep -qF -- "$wanted" <<< "$found" || { echo "self-test: not noticed: $wanted"; failed=1; }
  done
  while read -r line; do
    [[ " ${expected[*]} " == *" ${line%%:1:*}:1: "* ]] || { echo "self-test: should be allowed: $line"; failed=1; }
  done <<< "$found"
  [[ $failed == 0 ]] && echo "self-test: each of ${#expected[@]} planted lines was noticed, none of $((count - ${#expected[@]})) allowed ones"
  return "$failed"
}

case ${1-} in
  --self-test) self_test "$2" ;;
  ?*) verdict "$1" ;;
  *) echo "usage: house.sh [--self-test] ROOT" >&2; exit 2 ;;
esac
