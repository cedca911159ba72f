/* program.h - what the example programs say and where they write. SPDX-License-Identifier: MIT */
#ifndef PROGRAM_H
#define PROGRAM_H

#include "mpm_io.h"
#include "options.h"

static inline int complain(const char *message)
{
    fprintf(stderr, "error: %s\n", message);
    return 0;
}

/* "what: the fault in words" */
static inline int report(const mpm_fault *fault, const char *what)
{
    char text[256], line[1400];
    mpm_io_fault_text(text, sizeof text, fault);
    snprintf(line, sizeof line, "%s: %s", what, text);
    return complain(line);
}

/* folder/name */
static inline const char *file_in(const char *folder, const char *name, char *path, size_t n)
{
    snprintf(path, n, "%s/%s", folder, name);
    return path;
}

/* The options of a run, as the object "options" of its summary. */
static inline void options_json(mpm_io_json *j, const option *options, int n)
{
    char text[256];
    int i;
    mpm_io_json_open(j, "options");
    for (i = 0; i < n; i++) {
        option_text(&options[i], text, sizeof text);
        if (options[i].type == OPTION_REAL) mpm_io_json_number(j, options[i].name, *(double *)options[i].value);
        else if (options[i].type == OPTION_LONG) mpm_io_json_integer(j, options[i].name, *(long *)options[i].value);
        else mpm_io_json_string(j, options[i].name, text);
    }
    mpm_io_json_close(j);
}

/* The text of a file, up to room - 1 bytes; "" if there is none. Returns text. */
static inline const char *text_in(const char *path, char *text, size_t room)
{
    FILE *f = fopen(path, "rb");
    size_t n = 0;
    if (f) {
        n = fread(text, 1, room - 1, f);
        fclose(f);
    }
    text[n] = 0;
    return text;
}

/* What stands behind "key": in the text of a summary, or NULL. */
static inline const char *json_value(const char *text, const char *key)
{
    char quoted[80];
    const char *at;
    snprintf(quoted, sizeof quoted, "\"%s\": ", key);
    at = strstr(text, quoted);
    return at ? at + strlen(quoted) : NULL;
}

/* Whether a summary was made with these n options: each is there with its value, or is not there and has its
   value of `plain`, the same table with the defaults. */
static inline int options_match(const char *summary, const option *o, const option *plain, int n)
{
    const char *block = json_value(summary, "options");
    char text[256], other[256];
    int k;
    if (!block) return 0;
    for (k = 0; k < n; k++) {
        const char *at = json_value(block, o[k].name);
        const int quoted = o[k].type != OPTION_REAL && o[k].type != OPTION_LONG;
        size_t length;
        option_text(&o[k], text, sizeof text);
        length = strlen(text);
        if (!at) option_text(&plain[k], other, sizeof other);
        else if (!quoted) snprintf(other, sizeof other, "%.15g", strtod(at, NULL));
        else if (*at == '"' && !strncmp(at + 1, text, length) && at[1 + length] == '"') continue;
        else return 0;
        if (strcmp(text, other)) return 0;
    }
    return 1;
}

#endif
