#!/usr/bin/env bash
# Builds the tests on another release of Debian, in a chroot, and runs those of the units:
#   bash tests/other_debian.sh trixie      Debian 13: Embree 4, OpenSubdiv 3.6, g++ 14
# The chroot stays in build/SUITE, so that only its first run waits for packages. Needs root.
set -euo pipefail
cd "$(dirname "$0")/.."
suite=${1:?expected the name of a release of Debian}
root=$PWD/build/$suite

if ((EUID != 0)); then
  echo "other_debian.sh: skipped, for a chroot needs root" >&2
  exit 0
fi
if [[ ! -e $root/complete ]]; then
  rm -rf "$root"
  debootstrap --variant=minbase "$suite" "$root"
  touch "$root/complete"
fi
# The sources as they stand, with their times, so that what is built already is not built again.
rm -rf "$root/rapport"
mkdir "$root/rapport"
git ls-files -z --cached --others --exclude-standard | tar -c --null -T - | tar -x -C "$root/rapport"

mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
# The compiler cache that run.sh found is not in there.
env -u CMAKE_CXX_COMPILER_LAUNCHER chroot "$root" bash -euo pipefail -c '
  cd /rapport
  bash .ci/setup.sh tests
  cmake --preset tests -B /build
  cmake --build /build --target unit_tests
  ctest --test-dir /build -L "^unit$" -j 2 --output-on-failure'
