#!/usr/bin/env bash
# Writes docs/reference, the parameters of everything built in and of this tree's plugins, from what the program says.
#   reference.sh [GRIT]            writes the pages; GRIT is build/bin/grit unless given
#   reference.sh --check [GRIT]    says how the pages differ; exit status 1 if they do
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

# names HEADING: what `grit describe` lists under this heading.
names() { "$grit" describe | sed -n "/^$1\$/,/^\$/{/^  /p}" | awk '{print $1}'; }
# tables NAME…: what the program says of each, under a heading.
tables() {
  for name in "$@"; do
    printf '\n## %s\n```text\n%s\n```\n' "$name" "$("$grit" describe "$name")"
  done
}
page() { printf '# %s\nWritten by `scripts/reference.sh` from what `grit describe` says. Do not edit.\n' "$1"; }

{
  page 'Sections of a description'
  tables $(names 'sections of a description')
} > "$pages/sections.md"
{
  page "Files for 'grit chart'"
  tables $(names "files for 'grit chart'")
} > "$pages/study.md"
for kind in body contact engine geometry probe scenario; do
  {
    page "Parameters of each $kind"
    tables $(names "$kind")
  } > "$pages/$kind.md"
done

if [[ -n $check ]]; then
  diff -ru docs/reference "$pages" || {
    echo "docs/reference is not what the program says; run scripts/reference.sh and commit what it writes" >&2
    exit 1
  }
else
  rm -rf docs/reference
  mkdir -p docs/reference
  cp "$pages"/*.md docs/reference/
fi
