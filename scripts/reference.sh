#!/usr/bin/env bash
# Writes docs/reference, the parameters of all built-in components and of this tree's plugins, from the output of the program.
#   reference.sh [GRIT]            writes the pages; GRIT is build/bin/grit unless given
#   reference.sh --check [GRIT]    prints how the pages differ; exit status 1 if they do
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

check=''
if [[ ${1-} == --check ]]; then
  check=yes
  shift
fi
grit=${1:-build/bin/grit}
unset GRIT_PLUGIN_PATH
pages=$(mktemp -d)
trap 'rm -rf "$pages"' EXIT

listed=$("$grit" describe)
# names HEADING: the names that `grit describe` lists under this heading.
names() { sed -n "/^$1\$/,/^\$/{/^  /p}" <<< "$listed" | awk '{print $1}'; }
# tables FOLDER NAME…: the program's description of each, under a heading, with a link to its README if that is in this folder.
tables() {
  local folder=$1 name text readme
  shift
  for name in "$@"; do
    text=$("$grit" describe "$name")
    readme=$folder/$name/README.md
    printf '\n## %s\n' "$name"
    [[ ! -f $readme ]] || printf '[Equations, range and sources](../../%s).\n\n' "$readme"
    printf '```text\n%s\n```\n' "$text"
  done
}
page() { printf '# %s\nWritten by `scripts/reference.sh` from what `grit describe` says. Do not edit.\n' "$1"; }

{
  page 'Sections of a description'
  tables - $(names 'sections of a description')
} > "$pages/sections.md"
{
  page "Files for 'grit study' and 'grit calibrate'"
  tables - $(names "files for 'grit study' and 'grit calibrate'")
} > "$pages/study.md"
# kind NAME PLURAL FOLDER: the page of a kind of plugin.
kind() {
  page "Parameters of $2"
  tables "plugins/$3" $(names "$1")
}
kind body bodies bodies > "$pages/body.md"
kind contact 'contact laws' contacts > "$pages/contact.md"
kind engine engines engines > "$pages/engine.md"
kind geometry geometries geometry > "$pages/geometry.md"
kind probe probes probes > "$pages/probe.md"
kind scenario scenarios scenarios > "$pages/scenario.md"

if [[ -n $check ]]; then
  diff -ru docs/reference "$pages" || {
    echo "docs/reference differs from the output of the program; run scripts/reference.sh and commit the result" >&2
    exit 1
  }
else
  rm -rf docs/reference
  mkdir -p docs/reference
  cp "$pages"/*.md docs/reference/
fi
