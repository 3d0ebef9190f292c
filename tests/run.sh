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

# Compilers and emulators for the targets of the matrix that every run builds.
mapfile -t matrix_packages < <(tests/matrix/target.sh --quick | xargs -n 1 tests/matrix/target.sh --packages)
board_packages=(gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib qemu-system-arm)
install_packages "${matrix_packages[@]}" "${board_packages[@]}" clang libclang-rt-dev llvm libbenchmark-dev xvfb libgtest-dev parallel \
    "${still_peer_packages[@]}"
cmake --preset release -DSTILL_TESTS=ON >/dev/null
cmake --build --preset release
ctest --preset release --parallel "$(nproc)" "${select[@]}"
