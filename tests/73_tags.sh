#!/bin/sh
# From equation to function to test: prints that index for sources A and B and holds the headers to it. It fails on
#   a tag "A 3.29", "A7" or "B 24" in a header without a row in docs/source_a.md or docs/spray_model.md,
#   a row whose function no header has, or whose test is not there; so too a name or test on docs/method.md,
#   a "Test:" in a header that names no test program, or one that is not there,
#   a public function without "Test:" in the comment above it (one comment serves a group without blank lines).
# Run from the top folder; with -q without the index.
set -u
[ "${1:-}" = "-q" ] && quiet=1 || quiet=0
awk -v quiet="$quiet" '
function ok(yes, what) {
    if (yes) passed++
    else { failed++; print "not ok - " what }
    return yes
}

function readable(path,   line) {
    if (!(path in known)) {
        known[path] = (getline line < path) > 0
        close(path)
    }
    return known[path]
}

# Is there tests/NAME.c?
function there(name) { return readable("tests/" name ".c") }

# Is there a test or an example of that whole name?
function file(name) { return readable("tests/" name) || readable("tests/verify/" name) || readable("examples/" name) }

# All tests named in a text, NN_name: returns how many, in found[].
function tests(text, found,   n) {
    n = 0
    while (match(text, /[0-9][0-9]_[a-z0-9_]+/)) {
        found[++n] = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
    }
    return n
}

# The numbers behind "A ", "A" or "B " at the start of a text: "3.23, 3.24", "2.4 - 2.8", "7-15, 22", into one[].
function numbers(text, source,   n, i, low, high, part, chapter) {
    n = 0
    while (match(text, /^[0-9]+(\.[0-9]+)?/)) {
        low = substr(text, 1, RLENGTH)
        text = substr(text, RLENGTH + 1)
        high = low
        if (match(text, /^( - |-)A?[0-9]+(\.[0-9]+)?/)) {
            high = substr(text, 1, RLENGTH)
            text = substr(text, RLENGTH + 1)
            sub(/^( - |-)A?/, "", high)
        }
        chapter = ""
        if (source == "A ") {
            if (low !~ /\./ || high !~ /\./) break
            chapter = low
            sub(/\..*/, ".", chapter)
        }
        sub(/^[0-9]*\./, "", low)
        sub(/^[0-9]*\./, "", high)
        for (i = low + 0; i <= high + 0; i++) one[++n] = source chapter i
        if (match(text, /^, A?[0-9]/)) text = substr(text, RLENGTH)
        else break
    }
    return n
}

# Hands every tag of a text to `use`: a row is entered, a header held to the rows.
function tags(text, use,   source, n, i) {
    text = " " text
    while (match(text, /[^A-Za-z0-9_](A [0-9]+\.[0-9]|A[0-9]|B [0-9])/)) {
        text = substr(text, RSTART + 1)
        source = substr(text, 1, 2)
        if (source !~ / /) source = "A"
        text = substr(text, length(source) + 1)
        if (source == "A") sub(/^[0-9]+\.[0-9]+/, "1", text) # A1.3 is of A1
        n = numbers(text, source)
        for (i = 1; i <= n; i++) {
            if (use == "row") row[one[i]] = 1
            else ok(one[i] in row, FILENAME ":" FNR ": " one[i] " has no row in docs/" \
                    (source == "B " ? "spray_model.md" : "source_a.md"))
        }
    }
}

# Does any header have the function? "_name" goes on from a part of the full name before it in its row.
function exists(name, full) {
    if (name !~ /^_/) return (name in defined)
    while (sub(/_[a-z0-9]+$/, "", full))
        if ((full name) in defined) return 1
    return 0
}

# First pass: the functions of the headers, and all their words.
FILENAME ~ /\.h$/ && !second {
    text = $0
    while (match(text, /(mpm|MPM)_[A-Za-z0-9_]+\(?/)) {
        name = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        if (sub(/\($/, "", name)) defined[name] = 1
        word[name] = 1
    }
}

# The pages speak of what there is: names in backquotes, tests by their number.
FILENAME ~ /\.md$/ {
    text = $0
    while (match(text, /`(mpm|MPM)_[A-Za-z0-9_]+/)) {
        name = substr(text, RSTART + 1, RLENGTH - 1)
        text = substr(text, RSTART + RLENGTH)
        if (text !~ /^\.h/) ok(name in word, FILENAME ":" FNR ": no header has " name)
    }
    text = rest = $0
    while (match(rest, /[0-9][0-9]_[a-z0-9_]+\.(c|sh)/)) {
        name = substr(rest, RSTART, RLENGTH)
        rest = substr(rest, RSTART + RLENGTH)
        ok(file(name), FILENAME ":" FNR ": no " name " in tests or examples")
    }
    gsub(/[0-9][0-9]_[a-z0-9_]+\.(c|sh)/, "", text)
    n = tests(text, found)
    for (i = 1; i <= n; i++) ok(there(found[i]), FILENAME ":" FNR ": no tests/" found[i] ".c")
}

# The tables: rows of the section "Equation, function, test".
FILENAME ~ /\.md$/ {
    if (/^## /) table = /^## Equation, function, test/
    if (!table || !/^\|/ || /^\|[- |]*$/ || /^\| source/) next
    columns = split($0, cell, /\|/)
    tags(cell[2], "row")
    names = full = ""
    text = $0
    while (match(text, /`[a-z0-9_]+`/)) {
        name = substr(text, RSTART + 1, RLENGTH - 2)
        text = substr(text, RSTART + RLENGTH)
        names = names " " name
        if (name !~ /^_/) full = name
        ok(exists(name, full), FILENAME ":" FNR ": no header has " name)
    }
    ok(names != "", FILENAME ":" FNR ": no function")
    n = tests(cell[columns - 1], found)
    ok(n > 0, FILENAME ":" FNR ": no test")
    listed = ""
    for (i = 1; i <= n; i++) {
        ok(there(found[i]), FILENAME ":" FNR ": no tests/" found[i] ".c")
        listed = listed " " found[i]
    }
    gsub(/^ +| +$/, "", cell[2])
    if (!quiet) printf "%-28s ->%s ->%s\n", cell[2], names, listed
}

# Second pass over the headers.
FILENAME ~ /\.h$/ && second {
    tags($0, "header")
    if (/^\/\*/) { comment = ""; inside = 1 }
    else if (!inside && /^[ \t]*$/) comment = ""
    if (inside) comment = comment " " $0
    if (/\*\//) inside = 0
    text = $0
    if (match(text, /Tests?: /)) {
        text = substr(text, RSTART + RLENGTH)
        n = tests(text, found)
        ok(n > 0, FILENAME ":" FNR ": Test: without a file")
        for (i = 1; i <= n; i++) ok(there(found[i]), FILENAME ":" FNR ": no tests/" found[i] ".c")
    }
    if (/^MPM_API /) { declaration = ""; open = 1 }
    if (open) {
        declaration = declaration $0
        if (/\{/) open = 0 # a definition
        else if (/;/) {
            open = 0
            match(declaration, /[a-z0-9_]+\(/)
            ok(comment declaration ~ /Tests?: /, FILENAME ":" FNR ": " \
               substr(declaration, RSTART, RLENGTH - 1) " has no Test:")
        }
    }
}
END { printf "%d passed, %d failed\n", passed, failed; exit (failed > 0) }
' mpm*.h docs/source_a.md docs/spray_model.md docs/method.md second=1 mpm*.h
