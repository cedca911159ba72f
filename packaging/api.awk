# api.awk - the reference of the public names, one page of HTML for each header and an index, from the comments that
# stand in the headers: awk -v out=FOLDER -f packaging/api.awk mpm*.h. SPDX-License-Identifier: MIT
#
# What counts: functions (MPM_API, or static inline), types, macros up to the line "stop here if you only want the API";
# no name with two underscores, no guard, none of the names that MPM_FLOAT gives. A comment serves the declarations
# below it up to the next blank line; one behind a declaration serves that one. A name without either is a warning, and
# so is a line that is none of these. The exit status is 1 after a warning.

function warn(what) {
    print FILENAME ":" FNR ": " what > "/dev/stderr"
    warnings++
}

function html(text) {
    gsub(/&/, "\\&amp;", text)
    gsub(/</, "\\&lt;", text)
    gsub(/>/, "\\&gt;", text)
    return text
}

# HTML with every public name as a link, and every test and page that a comment names.
function linked(text, page,   done, name) {
    text = html(text)
    done = ""
    while (match(text, /(mpm|MPM)_[A-Za-z0-9_]+(\.h)?|[0-9][0-9]_[a-z][a-z0-9_]*|docs\/[a-z_]+\.md/)) {
        name = substr(text, RSTART, RLENGTH)
        done = done substr(text, 1, RSTART - 1)
        text = substr(text, RSTART + RLENGTH)
        if (name ~ /\.h$/ && there(name)) done = done "<a href=\"" name ".html\">" name "</a>"
        else if (name in home)
            done = done "<a href=\"" (home[name] == page ? "" : home[name] ".html") "#" name "\">" name "</a>"
        else if (name ~ /^docs/) done = done "<a href=\"../../" name "\">" name "</a>"
        else if (name ~ /^[0-9]/ && there("tests/" name ".c"))
            done = done "<a href=\"../../tests/" name ".c\">" name "</a>"
        else done = done name
    }
    return done text
}

function there(path,   line) {
    if (!(path in known)) known[path] = (getline line < path) > 0
    close(path)
    return known[path]
}

# The words of a comment, without its marks and the blanks it is indented with.
function words(text) {
    sub(/^\/\*[ \t]*/, "", text)
    sub(/[ \t]*\*\/[ \t]*$/, "", text)
    gsub(/\n   /, "\n", text)
    return text
}

# A new entry: a comment and the declarations below it.
function begin_entry() {
    entry = ++entries
    page_of[entry] = page
    section_of[entry] = section
    comment_of[entry] = comment
    section = ""
}

function public(name, kind, code) {
    if (!entry) begin_entry()
    if (name in home) return # declared again
    # choices made of a list have the list's comment
    if (comment_of[entry] == "" && match(code, /MPM_[A-Z_]+_LIST\(/))
        comment_of[entry] = comment_of[entry_of[substr(code, RSTART, RLENGTH - 1)]]
    behind = code
    if (behind ~ /\{/) behind = "" # comments of members say nothing of the whole
    if (comment_of[entry] == "" && behind !~ /\/\*/) warn(kind " " name " has no comment")
    entry_of[name] = entry
    home[name] = page
    kind_of[name] = kind
    names[page] = names[page] " " name
    named[entry] = named[entry] " " name
    count[kind]++
}

function declare(code) {
    if (!entry) begin_entry()
    code_of[entry] = code_of[entry] code "\n"
}

function macro(code,   name) {
    name = code
    sub(/^#define +/, "", name)
    match(name, /^[A-Za-z0-9_]+/)
    name = substr(name, 1, RLENGTH)
    if (name ~ /__/ || name ~ /^mpm_/ || name == "MPM_IMPLEMENTATION" || name ~ /^MPM_([A-Z0-9]+_)?H$/) return
    public(name, "macro", code)
    declare(code)
}

function function_of(code, kind,   name, text) {
    text = code
    if (!match(text, /[a-z0-9_]+ *\(/)) return
    name = substr(text, RSTART, RLENGTH)
    sub(/ *\($/, "", name)
    if (name ~ /__/) return
    public(name, kind, code)
    declare(code)
}

function type_of(code,   name) {
    if (code ~ /^struct /) { split(code, part_of, / /); name = part_of[2] }
    else if (match(code, /\(\*mpm_[a-z0-9_]+\)/)) name = substr(code, RSTART + 2, RLENGTH - 3)
    else {
        name = code
        gsub(/\/\*[^*]*\*\//, "", name)
        sub(/;[ \n]*$/, "", name)
        if (name ~ /\)$/) { sub(/\(.*$/, "", name); sub(/[ \n]+$/, "", name) }
        match(name, /[A-Za-z0-9_]+$/)
        name = substr(name, RSTART, RLENGTH)
    }
    if (name ~ /__/) return
    public(name, "type", code)
    declare(code)
}

# Braces open in a line, without those in comments.
function depth_of(line,   open, close_) {
    gsub(/\/\*[^*]*\*\//, "", line)
    open = gsub(/\{/, "", line)
    close_ = gsub(/\}/, "", line)
    return open - close_
}

FNR == 1 {
    page = FILENAME
    sub(/.*\//, "", page)
    pages[++page_count] = page
    private = in_comment = in_macro = in_function = in_type = in_body = entry = 0
    comment = section = ""
}
/stop here if you only want the API/ || /^#if defined\(MPM_IMPLEMENTATION\)/ { private = 1 }
private { next }

in_comment {
    comment = comment "\n" $0
    if (/\*\//) {
        in_comment = 0
        if (head) { head_of[page] = words(comment); comment = "" }
        head = 0
    }
    next
}
in_macro {
    code = code "\n" $0
    if (!/\\$/) { in_macro = 0; macro(code) }
    next
}
in_function {
    code = code "\n" $0
    if (/;[ \t]*(\/\*.*\*\/)?[ \t]*$/) { in_function = 0; function_of(code, "function") }
    next
}
in_type {
    code = code "\n" $0
    depth += depth_of($0)
    if (depth == 0 && /;[ \t]*(\/\*.*\*\/)?[ \t]*$/) { in_type = 0; type_of(code) }
    next
}
in_body == 1 { # a signature of more than a line
    code = code "\n" $0
    if (/\)[ \t]*$/) next
    if (/^\{/) { sub(/\n\{$/, "", code); function_of(code ";", "function"); in_body = 2; next }
    if (/\}[ \t]*$/ && /\{/) { sub(/[ \n]*\{.*$/, "", code); function_of(code ";", "function"); in_body = 0 }
    next
}
in_body == 2 {
    if (/^\}/) in_body = 0
    next
}

/^[ \t]*$/ { comment = ""; entry = 0; next }
/^\/\* ----/ || /^\/\* ====/ {
    section = words($0)
    gsub(/[-=][-=]+/, "", section)
    gsub(/^ +| +$/, "", section)
    next
}
/^\/\*/ {
    comment = $0
    entry = 0
    head = FNR == 1
    in_comment = !/\*\//
    next
}
/^#define / {
    code = $0
    if (/\\$/) in_macro = 1
    else macro(code)
    next
}
/^#/ || /^extern "C"/ || /^\}$/ || /^struct [a-z_]+;$/ || /^MPM_[A-Z_]+\([A-Za-z_]+\)$/ { next }
/^enum \{ MPM__/ || /^typedef [a-z0-9_]+ mpm__/ { next }
/^MPM_API / {
    code = $0
    if (/;[ \t]*(\/\*.*\*\/)?[ \t]*$/) function_of(code, "function")
    else in_function = 1
    next
}
/^(static inline|MPM_KERNEL) / {
    code = $0
    if (/\{.*\}[ \t]*$/) { sub(/[ \t]*\{.*$/, ";", code); function_of(code, "function") }
    else in_body = 1
    next
}
/^(typedef|struct|enum) / {
    code = $0
    depth = depth_of($0)
    if (depth == 0 && /;[ \t]*(\/\*.*\*\/)?[ \t]*$/) type_of(code)
    else in_type = 1
    next
}
{ warn("neither a comment nor a declaration: " $0) }

function top(file, title) {
    print "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" html(title) "</title>\n" \
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<style>\n" \
        ":root { color-scheme: light dark }\n" \
        "body { font: 16px/1.5 sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem }\n" \
        "pre { font: 14px/1.45 monospace; overflow-x: auto; padding: .6rem .8rem; margin: .4rem 0 }\n" \
        "pre.code { background: #8881; border-left: 3px solid #8888 }\n" \
        "section { margin: 1.6rem 0 }\n" \
        "code { font-size: 14px }\n</style>\n</head>\n<body>" > file
}

# The first line of a header's comment, behind its name.
function purpose(p,   line) {
    line = head_of[p]
    sub(/\n.*/, "", line)
    sub(/^[^ ]* - /, "", line)
    return line
}

function list(text, page,   part, n, i, line) {
    n = split(text, part, / +/)
    line = ""
    for (i = 1; i <= n; i++)
        if (part[i] != "") line = line (line == "" ? "" : " &middot; ") linked(part[i], page)
    return line
}

function write_page(p,   file, i, part, n, k) {
    file = out "/" p ".html"
    top(file, p)
    print "<p><a href=\"index.html\">all headers</a></p>\n<h1>" p "</h1>\n<pre>" linked(head_of[p], p) "</pre>" > file
    print "<h2>Names</h2>\n<p>" list(names[p], p) "</p>" > file
    for (i = 1; i <= entries; i++) {
        if (page_of[i] != p) continue
        if (section_of[i] != "") print "<h2>" html(section_of[i]) "</h2>" > file
        if (named[i] == "") continue
        print "<section>" > file
        n = split(named[i], part, / +/)
        for (k = 1; k <= n; k++) if (part[k] != "") printf "<a id=\"%s\"></a>", part[k] > file
        printf "<pre class=\"code\">%s</pre>\n", linked(code_of[i], p) > file
        if (comment_of[i] != "") print "<pre>" linked(words(comment_of[i]), p) "</pre>" > file
        print "</section>" > file
    }
    print "</body>\n</html>" > file
    close(file)
}

END {
    for (i = 1; i <= page_count; i++) write_page(pages[i])
    file = out "/index.html"
    top(file, "mpm.h: reference")
    print "<h1>mpm.h: reference</h1>\n<p>" count["function"] " functions, " count["type"] " types, " count["macro"] \
        " macros; the text is that of the headers.</p>" > file
    for (i = 1; i <= page_count; i++)
        print "<h2><a href=\"" pages[i] ".html\">" pages[i] "</a></h2>\n<p>" html(purpose(pages[i])) "</p>\n<p>" \
            list(names[pages[i]], "") "</p>" > file
    print "</body>\n</html>" > file
    printf "%s: %d functions, %d types, %d macros in %d headers, %d warnings\n", file, count["function"], count["type"],
        count["macro"], page_count, warnings
    exit warnings > 0
}
