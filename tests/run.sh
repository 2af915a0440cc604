#!/usr/bin/env bash
# Builds the tests and runs them, the fast ones first; ends with ctest's own summary and status.
#   bash tests/run.sh        the short counts
#   bash tests/run.sh long   full counts, after the unit tests under the sanitizers and on Debian 13, and a minute of
#                            each fuzzer
set -euo pipefail
cd "$(dirname "$0")/.."

if (($# > 1)) || [[ ${1:-long} != long ]]; then
  echo "run.sh: expected nothing or 'long', found '$*'" >&2
  exit 2
fi
bash .ci/setup.sh "${1:-tests}"

if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
build() {
  cmake --preset "$1"
  cmake --build --preset "$1"
}

if [[ ${1:-} == long ]]; then
  for preset in asan tsan fuzz; do
    build "$preset"
    ctest --preset "$preset"
  done
  bash tests/other_debian.sh trixie
  export RAPPORT_LONG=1
fi
build tests
exec ctest --preset tests ${RAPPORT_LONG:+--timeout 7200}
