#!/usr/bin/env bash
# Builds with a sanitizer into build/asan or build/tsan and runs the tests that it is for; a table of them at the end.
# Kernels are compiled for AVX2 and scalar only: one vector width shows what the others would.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source demos/setup.sh

# One line each: program, and which of its tests.
case "${1:-}" in
    address)
        preset=asan
        runs=("unit_rasterizer ~[slow]" "unit_postfx ~[slow]" "unit_engine ~[slow]" "unit_scenes ~[slow]" "cli/cli_tests ~[slow]"
              "determinism/determinism --few" "soak/soak --frames 20000")
        ;;
    thread)
        preset=tsan
        runs=("unit_rasterizer ~[slow]" "unit_postfx ~[slow]" "unit_engine [concurrency],[frame_loop]"
              "determinism/determinism --few" "soak/soak --frames 20000")
        ;;
    *)
        echo "usage: tests/sanitizers.sh address|thread" >&2
        exit 2
        ;;
esac

install_packages
cmake --preset "$preset" -DSTILL_TESTS=ON "-DSTILL_HIGHWAY_DISABLED=(HWY_SSSE3|HWY_SSE4|HWY_AVX3|HWY_AVX3_DL)" \
    "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1" >/dev/null
targets=()
for run in "${runs[@]}"; do
    program=${run%% *}
    targets+=("${program##*/}")
done
cmake --build --preset "$preset" --target "${targets[@]}"

export ASAN_OPTIONS=detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1 TSAN_OPTIONS=halt_on_error=1
mkdir -p "out/$preset"
failed=0
table="| $1 sanitizer | tests | result | s |"$'\n'"|---|---|---|---:|"
for run in "${runs[@]}"; do
    read -r -a words <<<"$run"
    log=out/$preset/${words[0]##*/}.log
    SECONDS=0
    result=clean
    if ! "build/$preset/tests/${words[0]}" "${words[@]:1}" >"$log" 2>&1; then
        result="see $log"
        failed=1
        tail -n 60 "$log" >&2
    fi
    table+=$'\n'"| ${words[0]##*/} | ${words[*]:1} | $result | $SECONDS |"
done
echo "$table"
exit "$failed"
