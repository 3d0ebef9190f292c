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

# A screenshot of the page, when demos/web/run.sh --test has taken it.
if [ -f ../../out/web/laptop_rejection.png ]; then
    cp ../../out/web/laptop_rejection.png page.png
fi
