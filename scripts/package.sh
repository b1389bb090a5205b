#!/usr/bin/env bash
# Builds grit for several instruction sets and installs them side by side; the command bin/grit picks one at each start.
#   package.sh [--deb] [TARGET [LEVEL…]] [-- ARGUMENTS OF CMAKE…]
# TARGET is a folder, or a file that ends in .tar.gz: grit.tar.gz unless given. LEVEL is what -march= takes: x86-64-v2,
# x86-64-v3 and x86-64-v4 unless given. With --deb, TARGET is a folder, debs unless given, into which Debian packages are
# written. Builds are kept in build-package/<LEVEL>; GRIT_PACKAGE_BUILDS names another folder.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

deb=''
if [[ ${1-} == --deb ]]; then
  deb=yes
  shift
  for tool in dpkg-shlibdeps file; do # without them CPack would write packages that depend on nothing
    command -v "$tool" > /dev/null || { echo "package: $tool is missing; install it: apt-get install dpkg-dev file" >&2; exit 1; }
  done
fi
words=()
while [[ $# != 0 && $1 != -- ]]; do
  words+=("$1")
  shift
done
[[ $# == 0 ]] || shift
[[ ${#words[@]} != 0 ]] || words=("${deb:+debs}")
target=$(realpath -m "${words[0]:-grit.tar.gz}")
levels=("${words[@]:1}")
[[ ${#levels[@]} != 0 ]] || levels=(x86-64-v2 x86-64-v3 x86-64-v4)
builds=$(realpath -m "${GRIT_PACKAGE_BUILDS-$root/build-package}")

prefix=$target
places=(-DGRIT_PYTHON_DIR=share/grit/python)
if [[ -n $deb ]]; then
  prefix=/usr/local # CPack says /usr; CMake, told so, would replace lib by the folder of the architecture
  places=(-DCMAKE_INSTALL_LIBDIR=lib -DGRIT_PYTHON_DIR=lib/python3/dist-packages)
elif [[ $target == *.tar.gz ]]; then
  stage=$(mktemp -d)
  trap 'rm -rf "$stage"' EXIT
  prefix=$stage/$(basename "$target" .tar.gz)
fi

# All are built before one is installed: a partial package would run, but not with the best instruction set of a processor.
for level in "${levels[@]}"; do
  cmake -S "$root" -B "$builds/$level" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$prefix" \
    -DGRIT_ARCH="$level" -DGRIT_TESTS=OFF -DGRIT_BENCH=OFF "${places[@]}" "$@"
  cmake --build "$builds/$level"
done

if [[ -n $deb ]]; then
  stage=$(mktemp -d)
  trap 'rm -rf "$stage"' EXIT
  projects=''
  for level in "${levels[@]}"; do
    projects+="${projects:+;}$builds/$level;grit;ALL;/"
  done
  # The first level is the lowest, for which manual pages could be written on any processor.
  (umask 022 && cpack -G DEB --config "$builds/${levels[0]}/CPackConfig.cmake" -B "$stage" -D "CPACK_INSTALL_CMAKE_PROJECTS=$projects") \
    > "$builds/cpack.log" || { cat "$builds/cpack.log" >&2; exit 1; }
  mkdir -p "$target"
  rm -f "$target"/{grit,grit-mpi,grit-dev,python3-grit,grit-doc}_*.deb
  mv "$stage"/*.deb "$target"
  echo "packages: ${levels[*]} in $target"
  exit
fi

for level in "${levels[@]}"; do
  cmake --install "$builds/$level" > "$builds/$level/install.log"
done
if [[ $target == *.tar.gz ]]; then
  mkdir -p "$(dirname "$target")"
  tar -C "$stage" --owner=0 --group=0 -czf "$target" "$(basename "$prefix")"
fi
echo "package: ${levels[*]} in $target"
