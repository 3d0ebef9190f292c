#!/usr/bin/env bash
# Measures what sampled light and upscaling are held to, and prints each figure beside its bound, as
# Markdown. Needs a release build (demos/run.sh). Sponza is measured when the shared data folder is
# there (STILL_DATA, or ../shared/data). The first run makes references, which takes an hour on two
# cores; they are kept in the cache of `stillframe atlas`.
#   --output DIR   keeps pages, tables and JSON there
#   --cache DIR    another folder for references
#   --samples N    at most so many of a reference: quick, and less exact
#   --only noise|upscaling
#   --time-resolution WxH  at which upscaling is timed, default 320x180
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

still=build/release/demos/stillframe
output="" only="" options=(--quiet) times=()
while [ $# -gt 0 ]; do
    case "$1" in
        --output) output=$2 && shift ;;
        --only) only=$2 && shift ;;
        --time-resolution) times=("$1" "$2") && shift ;;
        --cache | --samples) options+=("$1" "$2") && shift ;;
        *)
            sed -n '2,11s/^# //p' "$0" >&2
            exit 2
            ;;
    esac
    shift
done
data=${STILL_DATA:-../shared/data}
if [ -z "$output" ]; then
    output=$(mktemp -d)
    trap 'rm -r "$output"' EXIT
fi
mkdir -p "$output"

# Rows "what, value, bound"; `at most` and `at least` compare.
row='function row(what, value, sign, bound) {
    good = sign == "≤" ? value <= bound : value >= bound
    printf "| %s | %s | %s %s | %s |\n", what, value, sign, bound, good ? "yes" : "**no**"
}'
head() {
    printf '\n## %s\n\n| figure | measured | bound | holds |\n| --- | ---: | ---: | --- |\n' "$1"
}

if [ "$only" != upscaling ]; then
    sponza=()
    if [ -f "$data/sponza/scene.json" ]; then
        sponza=(--model "$data/sponza/scene.json" --lights demos/scenes/sun_and_sky.json)
    fi
    "$still" atlas --suite noise "${sponza[@]}" "${options[@]}" --output "$output/noise" \
        >"$output/noise.txt"
    head "Denoised, one sample a pixel, after 32 frames"
    awk "$row"'
        $3 != "still" { next }
        $1 == "cornell" || $1 == "sponza" {
            row($1 " SSIM", $4, "≥", 0.95)
            row($1 " RMSE", $5, "≤", 0.02)
            row($1 " flicker, of raw", $6, "≤", 0.1)
        }
        $1 == "switch-off" { row("light switched off, left after 3 frames", $7, "≤", 0.02) }
        $1 == "penumbra" { row("trail of a moving object, codes", $8, "≤", 8) }
    ' "$output/noise.txt"
    head "Denoised RMSE over that of as many plain samples as its time buys"
    awk "$row"'
        $3 == "still" && NF >= 14 {
            row($1 ", " $10 " samples", sprintf("%.2f", $12 > 0 ? $13 / $12 : 0), "≤", 1)
        }
    ' "$output/noise.txt"
    printf '\n```\n%s\n```\n' "$(cat "$output/noise.txt")"
fi

if [ "$only" != noise ]; then
    "$still" atlas --presets still,quality,performance,bicubic,bicubic:ratio=2 --versus still \
        "${options[@]}" "${times[@]}" --output "$output/upscaling" >"$output/upscaling.txt"
    head "Upscaled, against native \`still\`, means over the atlas"
    awk "$row"'
        NF >= 8 && $1 != "segment" { psnr[$1, $2] = $4; flip[$1, $2] = $5; time[$1, $2] = $6 }
        function against(name, small, plain) {
            row(name " over bicubic, still, dB", psnr["still", small] - psnr["still", plain],
                "≥", 4)
            row(name " over bicubic, moving, dB", psnr["moving", small] - psnr["moving", plain],
                "≥", 1.5)
        }
        END {
            row("×1.5 PSNR, dB", psnr["all", "quality"], "≥", -1)
            row("×1.5 FLIP, ratio", flip["all", "quality"], "≤", 1.1)
            row("×1.5 time, ratio", time["all", "quality"], "≤", 0.65)
            row("×2 PSNR, dB", psnr["all", "performance"], "≥", -2)
            row("×2 time, ratio", time["all", "performance"], "≤", 0.45)
            against("×1.5", "quality", "bicubic")
            against("×2", "performance", "bicubic:ratio=2")
        }
    ' "$output/upscaling.txt"
    printf '\n```\n%s\n```\n' "$(cat "$output/upscaling.txt")"
fi
