#!/bin/sh
# Writes the C header examples/report_page.h to standard output: web/report/report.html, report.css and report.js as
# arrays of lines, so that a program needs no file to write its page. Run from the top folder: sh web/report/embed.sh
LC_ALL=C awk '
BEGIN {
    most = 100 # signs of a literal, so that lines keep within 120 columns
    print "/* report_page.h - the page of report.h as text: made of web/report/report.html, report.css and report.js by"
    print "   `make report-page`. Change those, not this. SPDX-License-Identifier: MIT */"
    print "#ifndef REPORT_PAGE_H"
    print "#define REPORT_PAGE_H"
}
function finish() {
    if (open) print "        NULL};\n    return line;\n}"
    open = 0
}
FNR == 1 {
    finish()
    name = FILENAME
    sub(/.*\./, "", name)
    print "\nstatic inline const char *const *page_" name "(void)\n{"
    print "    static const char *const line[] = {"
    open = 1
}
{
    text = $0
    gsub(/\\/, "&&", text)
    gsub(/["?]/, "\\\\&", text) # "?": no trigraphs
    while (length(text) > most) {
        cut = most
        while (substr(text, cut, 1) ~ /[\\"?]/) cut-- # not inside an escape
        print "        \"" substr(text, 1, cut) "\","
        text = substr(text, cut + 1)
    }
    print "        \"" text "\\n\","
}
END { finish(); print "\n#endif" }
' web/report/report.html web/report/report.css web/report/report.js
