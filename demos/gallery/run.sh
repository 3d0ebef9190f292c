#!/usr/bin/env bash
# Makes the README's gallery anew, in demos/pictures. Needs a release build (demos/run.sh).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

still=$PWD/build/release/demos/stillframe
scripts=$PWD/demos/gallery
cd demos/pictures
export SDL_VIDEODRIVER=dummy

"$still" view builtin:courtyard --resolution 960x540 --script "$scripts/magnified.txt"
"$still" view builtin:courtyard --resolution 960x540 --aa taa:fsr-like --script "$scripts/rejection.txt"
"$still" render builtin:zoo --orbit 40 --frames 24 --fps 12 --resolution 320x180 --output zoo.gif

# One sample a pixel, the same denoised after 32 frames, 1024 samples a pixel.
light=$(mktemp -d)
trap 'rm -r "$light"' EXIT
box=(builtin:cornell --resolution 320x320 --start 31 --frames 1)
"$still" render "${box[@]}" --aa none --denoise off --output "$light/0.png"
"$still" render "${box[@]}" --output "$light/1.png"
"$still" render "${box[@]}" --aa ssaa:1024 --output "$light/2.png"
ffmpeg -v error -y -i "$light/0.png" -i "$light/1.png" -i "$light/2.png" -filter_complex hstack=3 light.png

# A screenshot of the page, when demos/web/run.sh --test has taken it.
if [ -f ../../out/web/laptop_rejection.png ]; then
    cp ../../out/web/laptop_rejection.png page.png
fi
