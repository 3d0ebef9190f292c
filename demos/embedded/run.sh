#!/usr/bin/env bash
# The demo for small boards: installs what it needs, builds it for a bare-metal Cortex-M and for this
# computer, runs both, compares their frames and prints what the board's takes of flash and RAM.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source demos/setup.sh

install_packages gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib qemu-system-arm
[ -f build/release/build.ninja ] || cmake --preset release -DSTILL_TESTS=OFF >/dev/null
cmake --build --preset release --target embedded_desktop
demos/embedded/compare.sh build/release/demos/embedded_desktop build/embedded
