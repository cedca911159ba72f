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
