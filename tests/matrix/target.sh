#!/usr/bin/env bash
# The determinism test for a processor that is not this one.
#   target.sh --list               names, one a line
#   target.sh --describe NAME      architecture | compiler | kernels | how it runs
#   target.sh --packages NAME      what Debian installs for it
#   target.sh NAME FOLDER          builds it in FOLDER; FOLDER/run ARGUMENTS… is then the program
# The log of a build that fails goes to standard error.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"

names=(aarch64 arm i686 i686-sse4 riscv64 ppc64le s390x)

# Highway 1.0.3 has kernels for x86 from SSSE3 on, for NEON and for WebAssembly. Elsewhere, and for
# SSE2, the scalar kernels run, which are the truth on every machine.
describe() {
    simd=ON flags='' packages=(qemu-user)
    case "$1" in
        aarch64) about='AArch64' triple=aarch64-linux-gnu kernels=NEON qemu=qemu-aarch64 ;;
        arm)
            about='32-bit ARM' triple=arm-linux-gnueabihf kernels=NEON qemu=qemu-arm
            flags='-mfpu=neon-vfpv4'
            ;;
        i686)
            about='32-bit x86, SSE2' triple=i686-linux-gnu kernels=scalar qemu='' simd=OFF
            flags='-msse2 -mfpmath=sse'
            ;;
        i686-sse4)
            about='32-bit x86, SSE4' triple=i686-linux-gnu kernels=SSE4 qemu=''
            flags='-msse4.2 -maes -mpclmul -mfpmath=sse'
            ;;
        riscv64) about='RISC-V 64' triple=riscv64-linux-gnu kernels=scalar qemu=qemu-riscv64 simd=OFF ;;
        ppc64le)
            about='PowerPC 64, little-endian' triple=powerpc64le-linux-gnu kernels=scalar
            qemu=qemu-ppc64le simd=OFF
            ;;
        s390x) about='s390x, big-endian' triple=s390x-linux-gnu kernels=scalar qemu=qemu-s390x simd=OFF ;;
        *)
            echo "$1: not a target, expected one of ${names[*]}" >&2
            exit 2
            ;;
    esac
    if [ -z "$qemu" ]; then
        packages=()
    fi
    packages+=("g++-${triple//_/-}")
}

# The compiler's and the emulator's version, when they are there.
version() {
    "$1" --version 2>/dev/null | sed -En '1s/.* ([0-9]+\.[0-9.]*[0-9]).*/\1/p'
}

build() {
    local folder="$1" launcher=() log
    if command -v ccache >/dev/null; then
        launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    fi
    mkdir -p "$folder"
    folder="$(cd "$folder" && pwd)"
    log="$folder/build.log"
    if ! { cmake -S "$root/tests/matrix" -B "$folder" -G Ninja ${launcher[@]+"${launcher[@]}"} \
        -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR="${triple%%-*}" \
        -DCMAKE_CXX_COMPILER="$triple-g++" -DCMAKE_CXX_FLAGS="$flags" \
        -DCMAKE_BUILD_TYPE=Release -DSTILL_SIMD="$simd" -DSTILL_WERROR=ON &&
        cmake --build "$folder" --target determinism ${STILL_JOBS:+-j "$STILL_JOBS"}; } \
        >"$log" 2>&1; then
        cat "$log" >&2
        return 1
    fi
    printf '#!/bin/sh\nexec %s "%s/determinism" "$@"\n' "$qemu" "$folder" >"$folder/run"
    chmod +x "$folder/run"
}

case "${1:-}" in
    --list) printf '%s\n' "${names[@]}" ;;
    --describe)
        describe "${2:-}"
        echo "$about | g++ $(version "$triple-g++") | $kernels | ${qemu:+$qemu $(version "$qemu")}"
        ;;
    --packages)
        describe "${2:-}"
        printf '%s\n' "${packages[@]}"
        ;;
    '' | -*)
        sed -n '2,6s/^# \{0,1\}//p' "$0" >&2
        exit 2
        ;;
    *)
        describe "$1"
        build "${2:?the folder to build in}"
        ;;
esac
