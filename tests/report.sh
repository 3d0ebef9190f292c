#!/usr/bin/env bash
# Measures the errors that the README states, against supersampled references (times and memory:
# tests/bench/run.sh). Prints Markdown. Needs a release build (demos/run.sh); Sponza is measured
# when the shared data folder is there (STILL_DATA, or ../shared/data).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

still=build/release/demos/stillframe
data=${STILL_DATA:-../shared/data}
scenes=(builtin:courtyard)
if [[ -f $data/sponza/scene.json ]]; then
    scenes+=("$data/sponza/scene.json")
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

name_of() {
    case $1 in
        builtin:*) echo "${1#builtin:}" ;;
        *) basename "$(dirname "$1")" ;;
    esac
}

# The last "psnr" of a comparison: over all frames. Exit code 1 only says that they differ.
psnr() {
    { "$still" compare "$1" "$2" || [[ $? == 1 ]]; } | awk '{for (i = 1; i < NF; ++i) if ($i == "psnr") p = $(i + 1)} END {print p}'
}

# One row: scene, what moves, PSNR of raw and TAA against a reference of $3 samples.
error_row() {
    local scene=$1 label=$2 reference=$3
    shift 3
    for mode in none taa "ssaa:$reference"; do
        "$still" render "$scene" --resolution 1280x720 --aa "$mode" "$@" \
            --output "$work/${mode%%:*}.{frame}.png"
    done
    echo "| $(name_of "$scene") | $label | ssaa:$reference | $(psnr "$work/none.{frame}.png" "$work/ssaa.{frame}.png") | $(psnr "$work/taa.{frame}.png" "$work/ssaa.{frame}.png") |"
    rm -f "$work"/*.png
}

echo "## Error: PSNR in dB, 1280x720"
echo
echo "| scene | motion | reference | raw | TAA |"
echo "| --- | --- | --- | ---: | ---: |"
for scene in "${scenes[@]}"; do
    error_row "$scene" "camera still, frame 63" 256 --start 63 --frames 1
    error_row "$scene" "camera orbits 1/3 degree per frame, 24 frames" 64 --orbit 8 --frames 24
done
