#!/usr/bin/env bash
# The determinism test for one processor, system, compiler and level of optimisation.
#   target.sh --list               names, one a line
#   target.sh --quick              those that every test run builds
#   target.sh --describe NAME      machine | compiler, flags | how it runs
#   target.sh --packages NAME      what Debian installs for it
#   target.sh NAME FOLDER          builds it in FOLDER; FOLDER/run ARGUMENTS… is then the program
# Exit code 77: compiler or emulator is not installed. The log of a build that fails goes to standard
# error. STILL_JOBS limits the compilers that run at a time.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"

names=(
    gcc12-{O0,O2,O3-lto} clang14-{O0,O2,O3-lto} clang19-{O0,O2,O3-lto}
    i686 i686-sse4 aarch64 arm riscv64 ppc64le s390x
    windows-gcc windows-clang wasm-simd wasm-scalar
)
quick=(gcc12-O0 clang14-O2 aarch64 s390x wasm-simd)

# Compilers for this machine, with all kernels of Highway for it.
describe_native() {
    machine='x86-64' compiler="${name%%-*}" runner=() source=tests/matrix level="${name#*-}"
    args=() program=determinism
    compiler="${compiler/gcc/g++-}" compiler="${compiler/clang/clang++-}"
    packages=("${compiler/clang++/clang}")
    if [ "$compiler" = clang++-19 ]; then
        werror=OFF # Debian's libstdc++ uses what it deprecates itself
    fi
    case "$level" in
        O0) # with assertions; of the kernels those for AVX2 stand for all
            flags='' optimised='-O0'
            args+=('-DSTILL_HIGHWAY_DISABLED=(HWY_SSSE3|HWY_SSE4|HWY_AVX3|HWY_AVX3_DL)')
            ;;
        O2) flags='' optimised='-O2 -DNDEBUG' ;;
        O3-lto)
            flags='-flto' optimised='-O3 -DNDEBUG'
            case "$compiler" in
                g++*) flags='-flto=auto' args+=(-DCMAKE_AR=/usr/bin/gcc-ar) ;;
                *-14) args+=(-DCMAKE_AR=/usr/bin/llvm-ar-14) packages+=(llvm-14) ;;&
                # Its linker needs no index of the archives, and an older llvm-ar cannot make one.
                *-19) args+=(-DCMAKE_AR=/usr/bin/ar -DCMAKE_RANLIB=/usr/bin/ranlib) ;;&
                clang*)
                    args+=(-DCMAKE_EXE_LINKER_FLAGS=-fuse-ld=lld)
                    packages+=("lld-${compiler##*-}")
                    ;;
            esac
            ;;
    esac
}

# GCC for other processors. Highway 1.0.3 has kernels for x86 from SSSE3 on, for NEON and for
# WebAssembly. Elsewhere, and for SSE2, the scalar kernels run, which are the truth on every machine.
describe_foreign() {
    local triple="$1"
    machine="$2" qemu="$3" simd="$4" flags="$5"
    compiler="$triple-g++" source=tests/matrix program=determinism
    args=(-DCMAKE_SYSTEM_NAME=Linux "-DCMAKE_SYSTEM_PROCESSOR=${triple%%-*}")
    packages=("g++-${triple//_/-}")
    if [ -n "$qemu" ]; then
        runner=("$qemu") packages+=(qemu-user)
    fi
}

# Windows by wine, in a folder of its own for what wine keeps. GCC misplaces the 32-byte vectors that
# it puts on the stack there (GCC bug 54412), so it gets no AVX; Clang does it right.
describe_windows() {
    machine='Windows, x86-64' source=tests/matrix program=determinism.exe
    args=(-DCMAKE_SYSTEM_NAME=Windows -DCMAKE_SYSTEM_PROCESSOR=AMD64)
    runner=(env WINEDEBUG=-all 'WINEPREFIX="$folder/wine"' wine)
    packages=(g++-mingw-w64-x86-64-posix wine wine64)
    case "$name" in
        *-gcc) compiler=x86_64-w64-mingw32-g++-posix flags='-msse4.2 -maes -mpclmul' ;;
        *-clang)
            compiler=clang++-19 werror=OFF flags='--target=x86_64-w64-mingw32 -march=x86-64-v3 -maes -mpclmul'
            args+=(-DCMAKE_EXE_LINKER_FLAGS=-fuse-ld=lld)
            packages+=(clang-19 lld-19)
            ;;
    esac
}

describe_wasm() {
    machine='WebAssembly' compiler=em++ source=demos/web program=determinism.js
    optimised='-O3 -DNDEBUG' # as the page
    args=(-DSTILL_WEB_THREADS=ON) runner=(node --no-experimental-fetch) packages=(emscripten)
    command -v node >/dev/null || packages+=(nodejs)
    configure=(emcmake cmake)
    # Emscripten's own scripts need the acorn that Debian installs beside its own node.
    export NODE_PATH=/usr/share/nodejs
    if [ "$name" = wasm-scalar ]; then
        simd=OFF
    fi
}

describe() {
    name="$1" simd=ON werror=ON flags='' optimised='-O2 -DNDEBUG' runner=() configure=(cmake)
    case "$name" in
        gcc12-* | clang1?-*) describe_native ;;
        i686) describe_foreign i686-linux-gnu '32-bit x86' '' OFF '-msse2 -mfpmath=sse' ;;
        i686-sse4)
            describe_foreign i686-linux-gnu '32-bit x86' '' ON '-msse4.2 -maes -mpclmul -mfpmath=sse'
            ;;
        aarch64) describe_foreign aarch64-linux-gnu 'AArch64' qemu-aarch64 ON '' ;;
        arm) describe_foreign arm-linux-gnueabihf '32-bit ARM' qemu-arm ON '-mfpu=neon-vfpv4 -mfp16-format=ieee' ;;
        riscv64) describe_foreign riscv64-linux-gnu 'RISC-V 64' qemu-riscv64 OFF '' ;;
        ppc64le) describe_foreign powerpc64le-linux-gnu 'PowerPC 64, little-endian' qemu-ppc64le OFF '' ;;
        s390x) describe_foreign s390x-linux-gnu 's390x, big-endian' qemu-s390x OFF '' ;;
        windows-*) describe_windows ;;
        wasm-*) describe_wasm ;;
        *)
            echo "$name: not a target, expected one of ${names[*]}" >&2
            exit 2
            ;;
    esac
}

# A program's version, when it is there.
version() {
    local text
    text="$("$1" --version 2>/dev/null)" || return 0
    grep -Eom 1 '[0-9]+\.[0-9.]*[0-9]' <<<"$text" | head -n 1 || "$1" -dumpversion
}

# The program that runs what is built: node, wine, qemu-…; nothing for native code.
emulator() {
    local word
    for word in "${runner[@]}"; do
        case "$word" in
            env | -* | *=*) ;;
            *) echo "$word" && return ;;
        esac
    done
}

describe_in_words() {
    local how="$(emulator)"
    printf '%s | %s | %s\n' "$machine" \
        "$(basename "$compiler") $(version "$compiler") ${optimised%% *} $flags" \
        "${how:+$how $(version "$how")}" | sed -E 's/ +\|/ |/g; s/\| $/| natively/'
}

build() {
    local tool log="$folder/build.log"
    for tool in "$compiler" $(emulator); do
        if ! command -v "$tool" >/dev/null; then
            echo "$name: $tool is not installed" >&2
            exit 77
        fi
    done
    if command -v ccache >/dev/null; then
        args+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
        # Without these it keeps nothing that uses a precompiled header.
        export CCACHE_SLOPPINESS="${CCACHE_SLOPPINESS:+$CCACHE_SLOPPINESS,}pch_defines,time_macros"
    fi
    if [ "${configure[0]}" = cmake ]; then
        args+=("-DCMAKE_CXX_COMPILER=$compiler")
    fi
    if ! { "${configure[@]}" -S "$root/$source" -B "$folder" -G Ninja "${args[@]}" \
        -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=$optimised" "-DCMAKE_CXX_FLAGS=$flags" \
        -DSTILL_SIMD="$simd" -DSTILL_WERROR="$werror" &&
        cmake --build "$folder" --target determinism ${STILL_JOBS:+-j "$STILL_JOBS"}; } \
        >"$log" 2>&1; then
        tail -n 100 "$log" >&2
        return 1
    fi
    printf '#!/bin/sh\nfolder="%s"\nexec %s "$folder/%s" "$@"\n' "$folder" "${runner[*]}" "$program" \
        >"$folder/run"
    chmod +x "$folder/run"
}

case "${1:-}" in
    --list) printf '%s\n' "${names[@]}" ;;
    --quick) printf '%s\n' "${quick[@]}" ;;
    --describe)
        describe "${2:-}"
        describe_in_words
        ;;
    --packages)
        describe "${2:-}"
        printf '%s\n' "${packages[@]}"
        ;;
    '' | -*)
        sed -n '2,9s/^# \{0,1\}//p' "$0" >&2
        exit 2
        ;;
    *)
        describe "$1"
        mkdir -p "${2:?the folder to build in}"
        folder="$(cd "$2" && pwd)"
        build
        ;;
esac
