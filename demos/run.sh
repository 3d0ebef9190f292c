#!/usr/bin/env bash
# From a fresh machine to pictures: installs packages, builds, renders the courtyard into out/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source demos/setup.sh

install_packages
cmake --preset release -DSTILL_TESTS=OFF >/dev/null
cmake --build --preset release

mkdir -p out
programs=build/release/demos
"$programs/stillframe" render builtin:courtyard --output out/courtyard.png --frames 8 --start 56
"$programs/stillframe" render builtin:courtyard --output out/courtyard.gif --resolution 480x270 \
    --frames 48 --fps 24
"$programs/side_by_side" out/side_by_side.png

echo
echo "Pictures:"
ls -1 "$PWD"/out/courtyard.*.png
echo "$PWD/out/courtyard.gif"
echo "$PWD/out/side_by_side.png   raw | TAA | reference of 256 samples, details at 400 %"
