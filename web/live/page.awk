# The page docs/method.md as HTML, for readers without a viewer: headings with the anchors that GitHub gives them,
# paragraphs, lists, tables, code, pictures, links. awk -f web/live/page.awk docs/method.md
function escaped(text) {
    gsub(/&/, "\\&amp;", text)
    gsub(/</, "\\&lt;", text)
    gsub(/>/, "\\&gt;", text)
    return text
}

# Words between signs become elements; code first, whose text is left alone.
function spans(text,   out, part, at, url) {
    out = ""
    while (match(text, /`[^`]+`|!?\[[^]]*\]\([^)]*\)|\*\*[^*]+\*\*|\*[^* ][^*]*\*/)) {
        out = out substr(text, 1, RSTART - 1)
        part = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        if (part ~ /^`/) out = out "<code>" substr(part, 2, length(part) - 2) "</code>"
        else if (part ~ /^\*\*/) out = out "<strong>" substr(part, 3, length(part) - 4) "</strong>"
        else if (part ~ /^\*/) out = out "<em>" substr(part, 2, length(part) - 2) "</em>"
        else {
            at = index(part, "](")
            url = substr(part, at + 2, length(part) - at - 2)
            if (part ~ /^!/) out = out "<img src=\"" url "\" alt=\"" substr(part, 3, at - 3) "\">"
            else if (url ~ /^(#|https?:)/) out = out "<a href=\"" url "\">" substr(part, 2, at - 2) "</a>"
            else out = out substr(part, 2, at - 2) # a file of the repository, which is not here
        }
    }
    return out text
}

function anchor(text) {
    text = tolower(text)
    gsub(/[^a-z0-9 _-]/, "", text)
    gsub(/ /, "-", text)
    return text
}

function close_block() {
    if (block != "") print (block == "table" ? "</tbody></table></div>" : "</" block ">")
    block = ""
}

function begin(name) {
    if (block == name) return
    close_block()
    block = name
    print (name == "table" ? "<div class=\"wide\"><table><tbody>" : "<" name ">")
}

function row(text,   n, i, cell) {
    if (text ~ /^\|[-| ]+\|$/) return
    n = split(text, cell, /\|/)
    printf "<tr>"
    for (i = 2; i < n; i++) printf "<td>%s</td>", spans(cell[i])
    print "</tr>"
}

BEGIN {
    print "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">"
    print "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
    print "<meta name=\"color-scheme\" content=\"light dark\">\n<title>mpm.h: the method</title>"
    print "<link rel=\"icon\" href=\"data:,\">\n<link rel=\"stylesheet\" href=\"live.css\">\n</head>\n<body>"
    print "<header>\n<p class=\"program\">mpm.h &middot; docs/method.md</p>\n<nav aria-label=\"Pages\">"
    print "<a href=\"index.html#impact\">An impact</a>\n<a href=\"index.html#step\">One step of the method</a>"
    print "<a href=\"method.html\" aria-current=\"page\">The method, written out</a>"
    print "</nav>\n</header>\n<main><article>"
}
/^```/ {
    code = !code
    if (code) close_block()
    printf "%s", (code ? "<pre tabindex=\"0\"><code>" : "</code></pre>\n")
    next
}
{ line = escaped($0) }
code { print line; next }
/^#+ / {
    close_block()
    match(line, /^#+/)
    level = RLENGTH
    text = substr(line, level + 2)
    printf "<h%d id=\"%s\">%s</h%d>\n", level, anchor(text), spans(text), level
    next
}
/^\|/ { begin("table"); row(line); next }
/^- / { begin("ul"); print "<li>" spans(substr(line, 3)); next }
/^[ \t]*$/ { close_block(); next }
/^[ \t]/ && block == "ul" { print spans(line); next }
{ begin("p"); print spans(line) }
END { close_block(); print "</article></main>\n</body>\n</html>" }
