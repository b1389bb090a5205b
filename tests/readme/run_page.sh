#!/usr/bin/env bash
# Runs a page of the documentation in a folder of its own: writes its ```json NAME and ```stl NAME blocks to files, runs the
# commands of its ```sh blocks in order, and its ```python blocks where h5py is there; sees that what its links name exists.
#   run_page.sh ROOT GRIT PAGE              PAGE is a path below ROOT
#   run_page.sh --check ROOT GRIT PAGE…     has what would be run for minutes checked instead, and nothing in it may be without effect
#   run_page.sh --self-test ROOT GRIT       sees that wrong pages are noticed
set -euo pipefail

# not_run COMMAND: whether a command builds, installs or edits, and so is not run from within a test.
not_run() { [[ $1 =~ ^(cmake|ctest|sudo|git|clang-format|clang-tidy)\  || $1 =~ ^(\./)?scripts/ ]]; }

# unfinished COMMAND: whether it goes on in the next line.
unfinished() { [[ $1 == *'\' ]] || ! bash -n -c "$1" 2> /dev/null; }

# checker GRIT FILE: writes a program that takes grit's command lines, and checks what grit would run.
checker() {
  cat > "$2" << end
#!/usr/bin/env bash
set -euo pipefail
case \$1 in
  run)
    told=\$('$1' check "\${@:2}")
    ! grep --after-context=9 'without effect' <<< "\$told" ;;
  study) '$1' "\$@" --dry-run ;;
  *) '$1' "\$@" ;;
esac
end
  chmod +x "$2"
}

run_page() {
  local checked=''
  if [[ $1 == --check ]]; then
    checked=yes
    shift
  fi
  local root=$1 grit=$2 page=$3 line language='' name='' text='' command='' number=0 failed=0 base linked=()
  place=$(mktemp -d)
  trap 'rm -rf "$place"' EXIT
  mkdir -p "$place/build/bin"
  if [[ -n $checked ]]; then
    checker "$grit" "$place/build/bin/grit"
  else
    ln -s "$grit" "$place/build/bin/grit"
  fi
  for entry in "$root"/*; do
    base=${entry##*/}
    [[ -e $place/$base || $base == build* || $base == results* ]] || linked+=("$entry")
  done
  ln -s "${linked[@]}" "$place/"

  complain() { echo "$page:$number: $1"; failed=1; }
  run_line() {
    local command=$1 log=$place/.log
    if not_run "$command"; then
      if [[ $command =~ ^(\./)?(scripts/[a-z-]+\.sh) ]]; then
        [[ -x $root/${BASH_REMATCH[2]} ]] || complain "cannot be run: ${BASH_REMATCH[2]}"
      fi
      return 0
    fi
    (cd "$place" && bash -euo pipefail -c "$command") > "$log" 2>&1 < /dev/null || {
      complain "failed: $command"
      tail -n 20 "$log"
    }
  }
  end_block() {
    case $language in
      json | stl)
        if [[ -n $name ]]; then printf '%s' "$text" > "$place/$name"; fi ;;
      python)
        python=''
        for candidate in python3 /usr/bin/python3; do
          "$candidate" -c 'import h5py' 2> /dev/null && python=$candidate && break
        done
        # Simulations need the module of the build folder.
        local module=${grit%/bin/grit}/python
        [[ -e $module/grit/_place.py ]] || module=$root/python
        [[ $module != "$root/python" || $text != *grit.Simulation* ]] || python=''
        if [[ -n $python ]]; then
          (cd "$place" && PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=agg PYTHONPATH=$module "$python" -c "$text") > "$place/.log" 2>&1 || { complain "python failed"; cat "$place/.log"; }
        fi ;;
    esac
  }

  while IFS= read -r line; do
    number=$((number + 1))
    if [[ -z $language && $line == '```'* ]]; then
      read -r language name <<< "${line#\`\`\`} " || true
      language=${language:-text} text=''
    elif [[ -n $language && $line == '```' ]]; then
      [[ -z $command ]] || run_line "$command"
      end_block
      language='' name='' command=''
    elif [[ $language == sh ]]; then
      [[ -z $command && $line =~ ^[[:space:]]*(#|$) ]] || command+=${command:+$'\n'}$line
      if [[ -n $command ]] && ! unfinished "$command"; then
        run_line "$command"
        command=''
      fi
    elif [[ -n $language ]]; then
      text+=$line$'\n'
    else
      while [[ $line =~ \]\(([^\)#]+)(#[^\)]*)?\)(.*) ]]; do
        local target=${BASH_REMATCH[1]} line=${BASH_REMATCH[3]} beside=$root/$page
        [[ $target == http* || -e ${beside%/*}/$target ]] || complain "there is no $target"
      done
    fi
  done < "$root/$page"
  return "$failed"
}

self_test() {
  local root=$1 grit=$2 wrong failed=0
  copy=$(mktemp -d)
  local pages=(
    $'```sh\nbuild/bin/grit run nothing.json\n```'
    $'```json bad.json\n{"titel": 1}\n```\n```sh\nbuild/bin/grit check bad.json\n```'
    $'```sh\n./scripts/nothing.sh\n```'
    'see [this](nothing.md)'
  )
  for wrong in "${pages[@]}"; do
    printf '%s\n' "$wrong" > "$copy/page.md"
    if (run_page "$copy" "$grit" page.md) > /dev/null; then
      printf 'not noticed:\n%s\n' "$wrong"
      failed=1
    fi
  done
  local unchecked=(
    $'```sh\nbuild/bin/grit run sims/column/quick.json \\\n  --set /probes/energy/stages/0=nothing\n```'
    $'```sh\nbuild/bin/grit run sims/column/quick.json --set \'/probes/other={"type": "void-ratio",\n  "stages": ["look"]}\'\n```'
    $'```sh\nbuild/bin/grit study sims/column/quick.json\n```'
    $'```sh\nbuild/bin/grit run \'sims/column/quick.json\n```'
  )
  ln -s "$root/sims" "$copy/sims"
  for wrong in "${unchecked[@]}"; do
    printf '%s\n' "$wrong" > "$copy/page.md"
    if (run_page --check "$copy" "$grit" page.md) > /dev/null; then
      printf 'not noticed:\n%s\n' "$wrong"
      failed=1
    fi
  done
  printf '%s\n' $'```sh\nbuild/bin/grit --version  # a comment\n```\n[this](page.md) and [that](https://example.org/x)' > "$copy/page.md"
  (run_page "$copy" "$grit" page.md) || failed=1
  printf '%s\n' $'```sh\nbuild/bin/grit run sims/column/quick.json \\\n  --set \'/probes/other={"type": "void-ratio",\n  "every_steps": 5}\'\n```' > "$copy/page.md"
  (run_page --check "$copy" "$grit" page.md) || failed=1
  rm -rf "$copy"
  return "$failed"
}

case ${1-} in
  --self-test) self_test "$2" "$3" ;;
  --check)
    failed=0
    for page in "${@:4}"; do (run_page --check "$2" "$3" "$page") || failed=1; done
    exit "$failed" ;;
  *) run_page "$@" ;;
esac
