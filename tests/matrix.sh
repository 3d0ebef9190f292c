#!/usr/bin/env bash
# The matrix of determinism: installs compilers and emulators, builds the hash table's program for
# every target, runs it and prints one table, target × scene, with hash and time.
#   matrix.sh             all targets (tests/matrix/target.sh --list)
#   matrix.sh TARGET…     these
#   matrix.sh --quick     those that every test run builds
#   matrix.sh --readme …  puts the tables into README.md and tests/matrix/README.md, too
# out/matrix holds tables and reports. Exit code: 0 all cells equal, 1 not, 2 usage.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source demos/setup.sh
target=tests/matrix/target.sh

readme=false
targets=()
for word in "$@"; do
    case "$word" in
        --readme) readme=true ;;
        --quick) mapfile -t targets < <("$target" --quick) ;;
        -*)
            sed -n '2,8s/^# \{0,1\}//p' "$0" >&2
            exit 2
            ;;
        *) targets+=("$word") ;;
    esac
done
if [ ${#targets[@]} -eq 0 ]; then
    mapfile -t targets < <("$target" --list)
fi
packages=()
for name in "${targets[@]}"; do
    "$target" --describe "$name" >/dev/null || exit 2
    mapfile -t -O ${#packages[@]} packages < <("$target" --packages "$name")
done
mapfile -t packages < <(printf '%s\n' "${packages[@]}" | sort -u)
install_packages "${packages[@]}"

# One file a target: its name and description, then a line per scene and SIMD target.
out=out/matrix
rm -rf "$out"
mkdir -p "$out"
for name in "${targets[@]}"; do
    report="$out/$name.tsv"
    printf '%s\t%s\n' "$name" "$("$target" --describe "$name")" >"$report"
    SECONDS=0
    if ! "$target" "$name" "build/matrix/$name"; then
        echo "$name: not built" >&2
        continue
    fi
    built_s=$SECONDS
    "build/matrix/$name/run" --report >>"$report" || true
    sed -i 's/\r$//' "$report" # Windows ends lines in two characters
    echo "$name: built in $built_s s, ran $((SECONDS - built_s)) s" >&2
done

# Every cell against the line of the target "table", which is what is committed.
files=()
for name in "${targets[@]}"; do
    files+=("$out/$name.tsv")
done
today="$(date -u +%Y-%m-%d), $(git rev-parse --short HEAD 2>/dev/null || echo 'no commit')"
code=0
awk -v today="$today" -v table="$out/table.md" -v summary="$out/summary.md" \
    -f tests/matrix/table.awk "${files[@]}" || code=$?
cat "$out/table.md"

# between_markers FILE TEXT: replaces what stands between two lines of FILE.
between_markers() {
    if ! grep -q '^<!-- matrix -->$' "$1" || ! grep -q '^<!-- end of matrix -->$' "$1"; then
        echo "$1: expected a line <!-- matrix --> and a line <!-- end of matrix -->" >&2
        return 1
    fi
    sed -i -e '/^<!-- matrix -->$/,/^<!-- end of matrix -->$/{/^<!-- matrix -->$/r '"$2" \
        -e '/^<!-- /!d}' "$1"
}
if $readme; then
    between_markers tests/matrix/README.md "$out/table.md"
    between_markers README.md "$out/summary.md"
fi
exit "$code"
