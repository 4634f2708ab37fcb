#!/bin/sh
# Counts lines of `src` that are neither blank, comments nor tests, and lines of shaders that are neither blank nor
# comments: the size of a change is the difference. `sh .ci/lines.sh [DIRECTORY]`
cd "${1:-$(dirname "$0")/..}" || exit 1

# An item under `#[cfg(test)]` ends with a line that closes it at the indentation at which it begins.
find src -name '*.rs' -exec awk '
    FNR == 1 { test = 0 }
    { line = $0; sub(/^[ \t]*/, "", line); indentation = length($0) - length(line) }
    test == 1 && line ~ /^#\[/ { next }
    test == 1 { test = line ~ /;$/ ? 0 : 2; begin = indentation; next }
    test == 2 { if (indentation == begin && line ~ /^}/) test = 0; next }
    line ~ /^#\[cfg\(test\)\]/ { test = 1; next }
    line != "" && line !~ /^\/\// { count++ }
    END { print count }' {} + | awk '{ sum += $1 } END { print sum " lines of src" }'
find shaders -name '*.wgsl' -exec cat {} + |
    awk '{ sub(/^[ \t]*/, "") } $0 != "" && $0 !~ /^\/\// { count++ } END { print count " lines of shaders" }'
