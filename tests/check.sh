# check.sh - what the tests written as scripts share; a script sets `dir`, its folder, and sources this.
passed=0
failed=0
check() { # name, command...: one line, "ok - name" where the command succeeds
    check_name=$1
    shift
    if "$@" >"$dir/check.said" 2>&1; then
        passed=$((passed + 1))
        echo "ok - $check_name"
    else
        failed=$((failed + 1))
        echo "not ok - $check_name: $(head -n 3 "$dir/check.said" | tr '\n' ' ')"
    fi
}
check_end() { # the closing line, and the script's result
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}
# Of tests/compile/agree.c, a small impact that ends in five numbers:
numbers() { # file, command...: the command writes five numbers into it
    file=$1
    shift
    "$@" >"$file.raw" || return 1
    tr -d '\r' <"$file.raw" >"$file" # Windows ends lines in two characters
    [ "$(grep -cE '^-?[0-9][0-9.]*(e[-+]?[0-9]+)?$' "$file")" = 5 ] && [ "$(wc -l <"$file")" -eq 5 ]
}
agree() { # two files of numbers, line by line
    paste "$1" "$2" | awk '{ d = $1 - $2; s = $1 < 0 ? -$1 : $1; if (!(d <= 1e-7 * s && d >= -1e-7 * s)) bad = 1 }
                           END { exit bad || NR != 5 }'
}
