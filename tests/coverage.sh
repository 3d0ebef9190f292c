#!/usr/bin/env bash
# Line coverage of rasterizer/ and postfx/ by their unit tests and the determinism table. Prints a
# table by module and the files with the most lines that never ran; exit code 1 under 95 %.
#   --lines [TEXT]   prints the lines that never ran, of files whose names hold TEXT
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source demos/setup.sh

goal=95
build=build/coverage
text=
case "${1:-}" in
    --lines) text=${2:-/} ;;
    "") ;;
    *)
        echo "usage: tests/coverage.sh [--lines [TEXT]]" >&2
        exit 2
        ;;
esac

install_packages gcovr
# Kernels alone are built in another way: counting, and for one SIMD target instead of four.
flags="--coverage;-O1;-DHWY_COMPILE_ONLY_STATIC"
if [[ $(uname -m) == x86_64 ]]; then
    grep -q avx2 /proc/cpuinfo || { echo "A processor with AVX2 is needed." >&2; exit 1; }
    flags+=";-march=x86-64-v3;-maes;-mpclmul"
fi
tests=(determinism/determinism unit_rasterizer unit_postfx)
cmake -S . -B $build -G Ninja -DCMAKE_BUILD_TYPE=Release -DSTILL_KERNEL_FLAGS="$flags" \
    -DCMAKE_EXE_LINKER_FLAGS=--coverage -DSTILL_TESTS=ON -DSTILL_VIEWER=OFF \
    -DSTILL_SUBBUILDS=OFF >/dev/null
cmake --build $build --target "${tests[@]##*/}" >/dev/null

find $build -name '*.gcda' -delete
for test in "${tests[@]}"; do
    arguments=("~[slow]")
    [[ $test == determinism/* ]] && arguments=(--few)
    $build/tests/"$test" "${arguments[@]}" >/dev/null
done
# Threads that count at the same time can make counts negative, which gcovr calls an error.
gcovr --gcov-ignore-parse-errors --root . --filter rasterizer/ --filter postfx/ --json $build/lines.json $build

python3 - $build/lines.json $goal "$text" <<'END'
import collections, json, sys

ran, lines = collections.Counter(), collections.Counter()
never = collections.defaultdict(list)
for entry in json.load(open(sys.argv[1]))["files"]:
    file = entry["file"]
    for line in (line for line in entry["lines"] if not line["gcovr/noncode"]):
        for name in (file, file.split("/")[0]):
            lines[name] += 1
            ran[name] += line["count"] > 0
        if line["count"] == 0:
            never[file].append(line["line_number"])
for file, numbers in sorted(never.items()):
    if sys.argv[3] and sys.argv[3] in file:
        source = open(file).read().splitlines()
        print("\n".join(f"{file}:{n}: {source[n - 1]}" for n in numbers))
modules = ("rasterizer", "postfx")
print("| module | lines | ran | % |\n|---|---:|---:|---:|")
for name in modules:
    print(f"| {name} | {lines[name]} | {ran[name]} | {100 * ran[name] / lines[name]:.1f} |")
print("\n| file | lines | never ran |\n|---|---:|---:|")
for file, numbers in sorted(never.items(), key=lambda item: -len(item[1]))[:12]:
    print(f"| {file} | {lines[file]} | {len(numbers)} |")
sys.exit(any(100 * ran[name] < int(sys.argv[2]) * lines[name] for name in modules))
END
