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

#endif
