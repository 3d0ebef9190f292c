# Reports of matrix.sh in, two Markdown tables out: `table` target × scene, `summary` a line a target.
# Exit code 1 when a cell is missing or not equal to the committed table.
BEGIN { FS = "\t" }

FNR == 1 {
    target = ++targets
    split($2, words, / \| /)
    machine[target] = words[1]
    compiler[target] = words[2]
    how[target] = words[3]
    next
}
$2 == "table" {
    if (!($1 in expected)) {
        scene[++scenes] = $1
    }
    expected[$1] = $3
    next
}
{
    if (!((target, $2) in seen)) {
        seen[target, $2] = 1
        kernels[target, ++variants[target]] = $2
    }
    hash[target, $2, $1] = $3
    time_ms[target, $2, $1] = $4
}

# SSE2 is what every x86-64 has; compilers use it for the scalar kernels unless told of more.
function shown(target, kernel) {
    if (kernel == "scalar" && machine[target] ~ /x86/ && compiler[target] !~ /-march|-msse4/) {
        return "scalar (SSE2)"
    }
    return kernel
}

function cell(target, kernel, name,    found) {
    ++cells
    found = hash[target, kernel, name]
    if (found != "" && found == expected[name]) {
        ++equal
        row_ms += time_ms[target, kernel, name]
        return sprintf("%s %.1f", substr(found, 1, 8), time_ms[target, kernel, name])
    }
    return found == "" ? "**missing**" : "**" substr(found, 1, 8) "**"
}

END {
    line = "| machine, compiler, kernels |"
    rule = "|---|"
    golden = "| tests/determinism/hashes.txt |"
    for (s = 1; s <= scenes; ++s) {
        line = line " " scene[s] " |"
        rule = rule "---|"
        golden = golden " " substr(expected[scene[s]], 1, 8) " |"
    }
    body = line "\n" rule "\n" golden "\n"
    brief = "| machine | compiler | run | cells equal | kernels, ms for all scenes |\n|---|---|---|---|---|\n"
    for (t = 1; t <= targets; ++t) {
        if (variants[t] == 0) {
            variants[t] = 1
            kernels[t, 1] = "not run"
        }
        target_equal = equal
        times = ""
        for (v = 1; v <= variants[t]; ++v) {
            kernel = kernels[t, v]
            row_ms = 0
            body = body "| " machine[t] ", " compiler[t] ", " shown(t, kernel) " |"
            for (s = 1; s <= scenes; ++s) {
                body = body " " cell(t, kernel, scene[s]) " |"
            }
            body = body "\n"
            times = times (v > 1 ? ", " : "") shown(t, kernel) sprintf(" %.0f", row_ms)
        }
        brief = brief "| " machine[t] " | " compiler[t] " | " how[t] " | " \
                (equal - target_equal) " of " variants[t] * scenes " | " times " |\n"
    }
    verdict = sprintf("%d of %d cells equal", equal, cells)
    printf "%s: %s. Each cell: the first half of the hash over all stages and frames, and " \
           "milliseconds of\nprocessor time on one thread.\n\n%s", today, verdict, body > table
    printf "%s: %s. Milliseconds of processor time on one thread.\n\n%s", today, verdict, brief > summary
    exit equal == cells && cells > 0 ? 0 : 1
}
