# check.sh - what the tests written as scripts share; a script sets `dir`, its folder, and sources this.
passed=0
failed=0
check() { # name, command...: one line, "ok - name" where the command succeeds
    name=$1
    shift
    if "$@" >"$dir/out" 2>&1; then
        passed=$((passed + 1))
        echo "ok - $name"
    else
        failed=$((failed + 1))
        echo "not ok - $name: $(head -n 3 "$dir/out" | tr '\n' ' ')"
    fi
}
check_end() { # the closing line, and the script's result
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}
