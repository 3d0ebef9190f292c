#!/usr/bin/env bash
# Builds the fuzz targets and runs them, all at once. Prints a table. Fails when one of them found
# something; the input then lies in out/fuzz/, and `build/fuzz/tests/fuzz/fuzz_TARGET FILE` repeats
# it. What is learned about inputs stays in build/fuzz/corpus/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source demos/setup.sh

usage() {
    echo "usage: tests/fuzz/run.sh [--seconds N | --runs N] [TARGET…]" >&2
    exit 2
}

limit=-max_total_time=60
case "${1:-}" in
    --seconds | --runs)
        [[ "${2:-}" =~ ^[1-9][0-9]*$ ]] || usage
        [ "$1" = --seconds ] && limit="-max_total_time=$2" || limit="-runs=$2"
        shift 2
        ;;
esac
targets=("$@")
[ ${#targets[@]} -gt 0 ] ||
    targets=(obj_mtl image scene_json camera_json golden_manifest draw_list taa_calls)
for target in "${targets[@]}"; do
    [ -d "tests/fuzz/corpus/$target" ] || usage
done

install_packages clang libclang-rt-dev llvm
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target "${targets[@]/#/fuzz_}" >build/fuzz/build.log ||
    { cat build/fuzz/build.log; exit 1; }
mkdir -p out/fuzz

# Memory is limited because a small input must not ask for much; 25 s is far more than any takes.
run() {
    local target=$1 options=("$limit" -rss_limit_mb=1500 -timeout=25 -max_len=4096
        -print_final_stats=1 -entropic=0 "-artifact_prefix=out/fuzz/$1-")
    [ ! -f "tests/fuzz/dictionaries/$target" ] || options+=("-dict=tests/fuzz/dictionaries/$target")
    mkdir -p "build/fuzz/corpus/$target"
    ASAN_OPTIONS=allocator_may_return_null=1 "build/fuzz/tests/fuzz/fuzz_$target" "${options[@]}" \
        "build/fuzz/corpus/$target" "tests/fuzz/corpus/$target" >"out/fuzz/$target.log" 2>&1
}

declare -A job
start=$SECONDS
for target in "${targets[@]}"; do
    run "$target" &
    job[$target]=$!
done
declare -A result seconds
for target in "${targets[@]}"; do
    wait "${job[$target]}" && result[$target]=none || result[$target]="out/fuzz/$target.log"
    seconds[$target]=$((SECONDS - start))
done

failed=0
echo "| target | executions | a second | seconds | findings |"
echo "| --- | --- | --- | --- | --- |"
for target in "${targets[@]}"; do
    log=out/fuzz/$target.log
    stat() { sed -n "s/^stat::$1: *//p" "$log" | tail -n 1; }
    echo "| $target | $(stat number_of_executed_units) | $(stat average_exec_per_sec) |" \
        "${seconds[$target]} | ${result[$target]} |"
    [ "${result[$target]}" = none ] || failed=1
done
exit $failed
