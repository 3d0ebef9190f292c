#!/usr/bin/env bash
# Prints how many frames a second the viewer draws, window and panels included, on the courtyard at
# 1280x720: while it is still and its samples are added, and while time runs and the camera circles.
# Needs a release build (demos/run.sh), and nothing else that runs.
#   frame_rate.sh [THREADS]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

threads=${1:-2}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export SDL_VIDEODRIVER=dummy

still_script() { echo "wait $1"; }
moving_script() {
    echo "key space"
    echo "mouse move 300 360"
    echo "mouse down"
    for ((i = 1; i <= $1; ++i)); do
        echo "mouse move $((300 + i)) 360"
    done
}

# Milliseconds of a run of $3 frames with mode $1 and script $2.
run_ms() {
    "$2_script" "$3" >"$work/script.txt"
    local begin_ns
    begin_ns=$(date +%s%N)
    build/release/demos/stillframe view builtin:courtyard --aa "$1" --threads "$threads" \
        --script "$work/script.txt"
    echo $((($(date +%s%N) - begin_ns) / 1000000))
}

# What starting takes falls out of the difference of two runs.
echo "| mode | still | moving |"
echo "| --- | ---: | ---: |"
for mode in taa:still taa:fast taa:tiny none; do
    row="| $mode |"
    for script in still moving; do
        short_ms=$(run_ms "$mode" "$script" 10)
        long_ms=$(run_ms "$mode" "$script" 58)
        row+=" $((48000 / (long_ms - short_ms))) |"
    done
    echo "$row"
done
