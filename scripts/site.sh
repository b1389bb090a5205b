#!/usr/bin/env bash
# Builds the documentation as a site with search, which needs no server and no network. A warning fails, as a broken link is.
#   site.sh [FOLDER]      writes to FOLDER, build-site unless given; read FOLDER/index.html
# The tools are those of scripts/install-deps.sh --site.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(realpath -m "${1-$root/build-site}")
python=/usr/bin/python3 # that of Debian's packages

for tool in doxygen /usr/share/doxygen-awesome-css/doxygen-awesome.css; do
  command -v "$tool" > /dev/null || [[ -f $tool ]] || { echo "site: no $tool; run scripts/install-deps.sh --site" >&2; exit 1; }
done
"$python" -c 'import sphinx, myst_parser, furo, sphinx_copybutton' || { echo 'site: Python packages are missing; run scripts/install-deps.sh --site' >&2; exit 1; }
if [[ -e $folder && ! -f $folder/.buildinfo && -n $(ls -A "$folder") ]]; then
  echo "site: $folder is not empty and no site; name another folder" >&2
  exit 1
fi

made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
cd "$root"
doxygen - <<< "$(cat docs/site/Doxyfile)
OUTPUT_DIRECTORY = $made/site
GENERATE_TAGFILE = $made/sdk.tags"
"$python" -m sphinx -q -W --keep-going -b html -c docs/site -d "$made/doctrees" -D "sdk_tags=$made/sdk.tags" . "$made/site"
rm -rf "$folder"
mkdir -p "$(dirname "$folder")"
mv "$made/site" "$folder"
echo "site: $folder/index.html"
