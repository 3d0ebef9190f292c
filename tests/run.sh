#!/usr/bin/env bash
# Installs packages, builds and runs the tests, the builds by other compilers and the control build
# included. --all adds the long sweeps.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source demos/setup.sh

case "${1:-}" in
    --all) select=() ;;
    "") select=(-LE slow) ;;
    *)
        echo "usage: tests/run.sh [--all]" >&2
        exit 2
        ;;
esac

# The second line is for bench_peer alone, which is left out or skipped without them.
install_packages clang \
    libegl-dev libgles-dev libegl-mesa0 libgl1-mesa-dri
cmake --preset release -DSTILL_TESTS=ON >/dev/null
cmake --build --preset release
ctest --preset release --parallel "$(nproc)" "${select[@]}"
