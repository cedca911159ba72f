/* The command line, and the stores of finished runs: any words, any file. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "fuzz.h"
#include "impact_options.h"
#include "program.h"

#define PATH "build/fuzz/options.json"

static void line(fuzz *f, impact_case *c, option *o, int n)
{
    static char word[16][40];
    char *argv[17], program[] = "program";
    int argc = 1, i;
    (void)c;
    argv[0] = program;
    for (i = 0; i < 16 && f->left; i++) {
        const unsigned b = fuzz_byte(f);
        if (b < 128) snprintf(word[i], sizeof word[i], "--%s", o[b % (unsigned)n].name);
        else if (b < 200) snprintf(word[i], sizeof word[i], "%.17g", fuzz_any(f));
        else fuzz_text(f, word[i], sizeof word[i]);
        if (!strcmp(word[i], "--help") || !strcmp(word[i], "-h")) strcpy(word[i], "x"); /* prints a page */
        argv[argc++] = word[i];
    }
    options_parse(argc, argv, "", o, n);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz f = {data, size};
    impact_case c = impact_case_default(), plain = impact_case_default();
    option o[IMPACT_OPTIONS], p[IMPACT_OPTIONS];
    const int n = impact_options(&c, o);
    char message[300] = "", summary[6000];
    size_t length;
    mpm_io_json j;
    impact_options(&plain, p);
    line(&f, &c, o, n);
    if (!impact_check(&c, message, sizeof message)) FUZZ_WANT(*message);
    if (mpm_io_json_begin(&j, PATH, NULL) < 0) return 0;
    options_json(&j, o, n);
    FUZZ_WANT(mpm_io_json_end(&j, NULL) == MPM_OK);
    length = strlen(text_in(PATH, summary, sizeof summary));
    while (f.left > 3 && length > 0) { /* a few bytes of the store changed, or its end lost */
        const size_t at = (fuzz_byte(&f) | (size_t)fuzz_byte(&f) << 8) % length;
        summary[at] = (char)fuzz_byte(&f);
    }
    options_match(summary, o, p, n);
    json_value(summary, "diameter");
    return 0;
}
