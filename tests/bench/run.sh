#!/usr/bin/env bash
# Measures Stillframe and its peers on the same scenes in turns and prints the tables of times,
# ratios, memory and hashes as markdown. Installs and builds what is needed.
#   --quick        one round of few small frames: shows that it works, the figures mean little
#   --rounds N     default 3
#   --threads N    default all cores
#   --build DIR    an existing build instead of build/release
#   --keep DIR     leaves the JSON of all rounds there
# STILL_DATA: folder with sponza/scene.json, measured when it is there. STILL_ANGLE: folder with
# ANGLE's libEGL.so, libGLESv2.so and SwiftShader, default /usr/lib/chromium; left out without it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

rounds=3 threads=$(nproc) resolution=1920x1080 frames=10 build="" keep=""
scenes=(builtin:courtyard builtin:bench-tiny builtin:bench-mid builtin:bench-fill-front
        builtin:bench-fill-back)
while [ $# -gt 0 ]; do
    case "$1" in
        --quick) rounds=1 resolution=640x360 frames=2 scenes=(builtin:bench-fill-front) ;;
        --rounds) rounds=$2 && shift ;;
        --threads) threads=$2 && shift ;;
        --build) build=$2 && shift ;;
        --keep) keep=$2 && shift ;;
        *)
            sed -n '2,10s/^# //p' "$0" >&2
            exit 2
            ;;
    esac
    shift
done
if [ ${#scenes[@]} -gt 1 ] && [ -f "${STILL_DATA:-}/sponza/scene.json" ]; then
    scenes+=("$STILL_DATA/sponza/scene.json")
fi

if [ -z "$build" ]; then
    source demos/setup.sh
    install_packages "${still_peer_packages[@]}"
    build=build/release
    cmake --preset release -DSTILL_TESTS=ON >/dev/null
    cmake --build --preset release --target stillframe bench_peer bench_report >&2
fi
ours=$build/demos/stillframe
peer=$build/tests/bench/peer/bench_peer
report=$build/tests/bench/report/bench_report

work=${keep:-$(mktemp -d)}
mkdir -p "$work"
[ -n "$keep" ] || trap 'rm -r "$work"' EXIT

# Status 77 says that the driver is not on this machine.
measure_peer() { # DRIVER SCENE FILE MOTIONS
    local status=0
    "$peer" "$2" --driver "$1" --libraries "${STILL_ANGLE:-}" --motion "$4" --threads "$threads" \
        --resolution "$resolution" --frames "$frames" --json >"$3" || status=$?
    [ $status -eq 0 ] || rm "$3"
    [ $status -eq 0 ] || [ $status -eq 77 ]
}

swiftshader=yes
for ((round = 1; round <= rounds; ++round)); do
    for i in "${!scenes[@]}"; do
        scene=${scenes[i]} name=$work/$round.$i
        echo "round $round: $scene" >&2
        "$ours" bench "$scene" --threads "$threads" --resolution "$resolution" --json \
            >"$name.ours.json"
        measure_peer llvmpipe "$scene" "$name.llvmpipe.json" still,pan,objects
        if [ $swiftshader = yes ]; then
            measure_peer swiftshader "$scene" "$name.swiftshader.json" pan
            [ -f "$name.swiftshader.json" ] || swiftshader=no
        fi
    done
done

shopt -s nullglob
llvmpipe=("$work"/*.llvmpipe.json)
if [ ${#llvmpipe[@]} -eq 0 ]; then
    echo "SKIPPED: there is no llvmpipe to compare with" >&2
    exit 77
fi
cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
system=$(. /etc/os-release && echo "$PRETTY_NAME")
compiler=$("${CXX:-c++}" --version | head -n 1)
commit=$(git describe --always --dirty 2>/dev/null || echo unknown)
swift=("$work"/*.swiftshader.json)
"$report" --ours "$work"/*.ours.json --llvmpipe "${llvmpipe[@]}" \
    ${swift[0]:+--swiftshader "${swift[@]}"} \
    --note "$(date -u +%Y-%m-%d), commit $commit: $cpu, $(nproc) cores; $system; $compiler." \
    --note "Rounds: $rounds; renderers in turns scene by scene."
