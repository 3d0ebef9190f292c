#!/usr/bin/env bash
# compare.sh DESKTOP_PROGRAM FOLDER: builds the board's program in FOLDER, runs it in an emulated
# board, and the desktop's with all its SIMD targets and thread counts; all must print the same
# hashes. Prints how much memory the board's takes. Exit code 77 when there is no compiler for the
# board, or no emulator; then the desktop's are compared with one another.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
desktop="$1" folder="$2"
mkdir -p "$folder"

"$desktop" 1 scalar | tee "$folder/scalar.txt" | grep '^frame' >"$folder/expected.txt"
frames=$(wc -l <"$folder/expected.txt")
grep '^arena' "$folder/scalar.txt" | sed 's/^/desktop: /'
for target in $("$desktop" --targets); do
    for threads in 1 4; do
        if ! diff "$folder/expected.txt" <("$desktop" "$threads" "$target" | grep '^frame'); then
            echo "error: $target with $threads threads is not what scalar kernels give" >&2
            exit 1
        fi
    done
    echo "desktop: $frames frames are equal with $target, 1 and 4 threads"
done

for tool in arm-none-eabi-g++ qemu-system-arm ninja; do
    if ! command -v "$tool" >/dev/null; then
        echo "no $tool: the board is left out"
        exit 77
    fi
done
launcher=()
if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
cmake -S "$here" -B "$folder" -G Ninja --toolchain "$here/cortex-m.cmake" \
    ${launcher[@]+"${launcher[@]}"} >/dev/null
cmake --build "$folder" --target embedded >"$folder/build.txt" || {
    cat "$folder/build.txt" >&2
    exit 1
}
# Semihosting prints to the emulator's standard error.
timeout 300 qemu-system-arm -M mps2-an386 -display none -monitor none -serial none \
    -semihosting-config enable=on,target=native -kernel "$folder/embedded.elf" \
    >"$folder/board.txt" 2>&1 || {
    cat "$folder/board.txt" >&2
    exit 1
}
if ! diff "$folder/expected.txt" <(grep '^frame' "$folder/board.txt"); then
    echo "error: the board's frames (>) are not the desktop's (<)" >&2
    exit 1
fi
read -r code data bss _ < <(arm-none-eabi-size "$folder/embedded.elf" | tail -n 1)
echo "board: $frames frames are equal (Cortex-M4 with FPU, $(qemu-system-arm --version | head -n 1))"
echo "board: flash $((code + data)) of 262144 bytes"
echo "board: RAM $((data + bss)) of 1048576 bytes, of which"
grep -v '^frame' "$folder/board.txt" | sed 's/^/board:   /'
