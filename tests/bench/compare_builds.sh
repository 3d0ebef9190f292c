#!/usr/bin/env bash
# Holds two builds of the program against each other, stage by stage: each scene is measured by both
# in turns, on one thread, and of each stage the best frame of all rounds counts. Prints Markdown; a
# ratio above 1 is slower. Times of busy machines tell nothing.
#   tests/bench/compare_builds.sh OLD NEW [--rounds N] [--resolution WxH] [SCENE…]
# OLD and NEW are two `stillframe` programs. Default: 3 rounds, 1280x720, the courtyard and bench-mid.
set -euo pipefail

if [ $# -lt 2 ]; then
    sed -n '2,6s/^# //p' "$0" >&2
    exit 2
fi
old=$1 new=$2 rounds=3 resolution=1280x720 scenes=()
shift 2
while [ $# -gt 0 ]; do
    case "$1" in
        --rounds) rounds=$2 && shift ;;
        --resolution) resolution=$2 && shift ;;
        *) scenes+=("$1") ;;
    esac
    shift
done
[ ${#scenes[@]} -gt 0 ] || scenes=(builtin:courtyard builtin:bench-mid)

measure() { # NAME PROGRAM SCENE: one line for each stage, and the hash of the last picture
    "$2" bench "$3" --threads 1 --frames 24 --resolution "$resolution" --quiet | awk -v name="$1" '
        / triangles, / { split($0, head, ": "); place = head[1]; gsub(" ", "", place) }
        /^machine/ { exit }
        $1 ~ /^(transform|bin|visibility|shade|light|denoise|taa|output)$/ && NF >= 4 {
            print name, place, $1, $2
        }
        $1 == "frame" && $3 == "output" { print name, place, "picture", $4 }
        $1 == "frame" && NF == 4 && $3 != "output" { print name, place, "frame", $2 }
    '
}

for ((round = 1; round <= rounds; ++round)); do
    for scene in "${scenes[@]}"; do
        measure old "$old" "$scene"
        measure new "$new" "$scene"
    done
done | awk '
    $3 == "picture" { picture[$1, $2] = $4; next }
    {
        key = $2 SUBSEP $3
        if (!(key in seen)) { seen[key] = 1; order[++count] = key }
        if (!(($1, key) in best) || $4 < best[$1, key]) best[$1, key] = $4
    }
    END {
        print "| scene, motion | stage | old ms | new ms | ratio | picture |"
        print "| --- | --- | ---: | ---: | ---: | --- |"
        for (i = 1; i <= count; ++i) {
            split(order[i], part, SUBSEP)
            o = best["old", order[i]]; n = best["new", order[i]]
            same = picture["old", part[1]] == picture["new", part[1]] ? "equal" : "**differs**"
            ratio = o == "" || n == "" || o + 0 == 0 ? "–" : sprintf("%.3f", n / o)
            printf "| %s | %s | %s | %s | %s | %s |\n", part[1], part[2], (o == "" ? "–" : o),
                (n == "" ? "–" : n), ratio, (part[2] == "frame" ? same : "")
        }
    }
'
