#!/usr/bin/env bash
# Installs what is missing of the Debian 12 packages that the project needs.
#   bash .ci/setup.sh program   to build and run the program
#   bash .ci/setup.sh tests     the same and what the tests need (the default)
#   bash .ci/setup.sh long      the same and what `tests/run.sh long` needs
# Does nothing when all are there. Needs root or sudo only to install; where there is no apt-get it names
# the packages instead, and exits 2 when a tool of the build is missing.
set -euo pipefail

program=(
  build-essential         # g++, the C++ library, make
  cmake                   # the build
  ninja-build             # its back end
  pkg-config              # finds libraries that bring no CMake configuration
  git                     # the version written into results
  ca-certificates         # https, to clone and to install
  libembree-dev           # ray tracing kernel
  libosd-dev              # OpenSubdiv: the limit surface of garments
  libtinygltf-dev         # reads glTF
  libopenexr-dev          # reads and writes EXR
  libglm-dev              # vectors, matrices, quaternions
  libtbb-dev              # parallel loops
  libcli11-dev            # the command line and its help
  libtomlplusplus-dev     # reads cloth files, with positions for errors
  libfmt-dev              # text formatting
  libstb-dev              # reads and writes PNG and HDR
  zlib1g-dev              # compression under EXR
  nlohmann-json3-dev      # JSON of `rapport info` and of glTF
  librandom123-dev        # counter-based random numbers
  libglfw3-dev            # the window of `rapport view`
  libepoxy-dev            # OpenGL functions
  libimgui-dev            # what is in the window
  fonts-dejavu-core       # its letters
)
tests=(
  libgtest-dev            # unit and statistical tests
  libbenchmark-dev        # measured speed
  xvfb                    # a display for the window's tests
  xauth                   # lets them use it
  libgl1-mesa-dri         # OpenGL without a graphics card
)
long=(
  clang                   # libFuzzer comes with it alone
  libclang-rt-14-dev      # sanitizer and fuzzing runtimes for clang
  debootstrap             # a clean system to try the set-up in
  python3-matplotlib      # draws the charts of tests/bench/charts
)

case "${1:-tests}" in
  program) packages=("${program[@]}") ;;
  tests) packages=("${program[@]}" "${tests[@]}") ;;
  long) packages=("${program[@]}" "${tests[@]}" "${long[@]}") ;;
  *)
    echo "setup.sh: expected program, tests or long, found '$1'" >&2
    exit 2
    ;;
esac

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "setup.sh: no apt-get here; by their Debian names the project needs:" "${packages[@]}" >&2
  absent=()
  for tool in c++ cmake ninja pkg-config git; do
    command -v "$tool" >/dev/null || absent+=("$tool")
  done
  if ((${#absent[@]})); then
    echo "setup.sh: missing tools:" "${absent[@]}" >&2
    exit 2
  fi
  exit 0
fi

present=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "${packages[@]}" 2>/dev/null || true)
missing=()
for package in "${packages[@]}"; do
  grep -qxF "$package installed" <<<"$present" || missing+=("$package")
done
((${#missing[@]})) || exit 0

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "setup.sh: neither root nor sudo; have these packages installed:" "${missing[@]}" >&2
    exit 2
  fi
  as_root=(sudo)
fi
echo "setup.sh: installing" "${missing[@]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends "${missing[@]}"
