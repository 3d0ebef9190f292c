#!/usr/bin/env bash
# Installs packages, builds and runs the tests. --all adds the long sweeps and the builds with other
# compilers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source demos/setup.sh

case "${1:-}" in
    --all) packages=(clang) configure=(-DSTILL_SUBBUILDS=ON) select=() ;;
    "") packages=() configure=(-DSTILL_SUBBUILDS=OFF) select=(-LE slow) ;;
    *)
        echo "usage: tests/run.sh [--all]" >&2
        exit 2
        ;;
esac

install_packages "${packages[@]}"
cmake --preset release -DSTILL_TESTS=ON "${configure[@]}" >/dev/null
cmake --build --preset release
ctest --preset release --parallel "$(nproc)" "${select[@]}"
