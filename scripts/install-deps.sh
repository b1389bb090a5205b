#!/usr/bin/env bash
# Installs the dependencies of grit on Debian 12. Needs root or sudo only if something is missing; can be run again.
#   install-deps.sh [--run | --viewers | --sanitizers | --site]
#     --run         only what building and running grit needs: no libraries for tests and benchmarks
#     --viewers     also Chromium and ParaView (1 GB), in which some tests open results as users do, Doxygen, and what
#                   checks completion in zsh, manual pages and packages
#     --site        only what scripts/site.sh needs: Sphinx, its theme and Doxygen
#     --sanitizers  also what scripts/sanitize.sh and scripts/fuzz.sh need: sanitizers, libFuzzer, names of functions in reports, valgrind
set -euo pipefail

packages=(
  clang-16 g++ cmake ninja-build git # the build; g++ for its C++ library
  libboost-dev                       # Boost.DLL, Boost.Beast
  libboost-program-options-dev
  libeigen3-dev
  libhdf5-dev
  libmuparser-dev
  libopenmpi-dev openmpi-bin         # one run in several processes
  libnlopt-dev libnlopt-cxx-dev      # optimisation of 'grit calibrate'
  libspdlog-dev
  libudunits2-dev
  nlohmann-json3-dev
  zlib1g-dev
  libjs-vega                         # draws the curves of a report; embedded in the library
  pybind11-dev python3-dev python3-numpy # the Python module that drives simulations
)
for_tests=(
  libgtest-dev libgmock-dev libbenchmark-dev
  libvalijson-dev
  librsvg2-bin                       # pictures as PNG
  groff-base                         # manual pages
  dpkg-dev file                      # Debian packages
  python3 python3-h5py               # tests of vector instructions and of the documentation
)
viewers=(chromium paraview python3-paraview xvfb doxygen zsh mandoc lintian)
site=(python3-sphinx python3-myst-parser furo python3-sphinx-copybutton doxygen doxygen-awesome-css)
sanitizers=(libclang-rt-16-dev llvm-16 valgrind)
case ${1-} in
  --run) ;;
  '') packages+=("${for_tests[@]}") ;;
  --viewers) packages+=("${for_tests[@]}" "${viewers[@]}") ;;
  --sanitizers) packages+=("${for_tests[@]}" "${sanitizers[@]}") ;;
  --site) packages=("${site[@]}") ;;
  *)
    echo "install-deps: unknown option '$1'; usage: install-deps.sh [--run | --viewers | --sanitizers | --site]" >&2
    exit 1
    ;;
esac

missing=()
for package in "${packages[@]}"; do
  [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true) == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} == 0 ]]; then
  echo "install-deps: all ${#packages[@]} packages are installed"
  exit 0
fi

as_root=()
if [[ $(id -u) != 0 ]]; then
  command -v sudo > /dev/null || {
    echo "install-deps: not root and no sudo; run as root: apt-get install ${missing[*]}" >&2
    exit 1
  }
  as_root=(sudo)
fi
echo "install-deps: installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
