/* How a program shows how far it is (examples/terminal.h): once for every tenth where messages go into a file, in a
   line that fits where they go to a terminal; the time that is left; the end when it is asked for.
   SPDX-License-Identifier: MIT */
#include "terminal.h"

#include "check.h"
#include "files.h"

#define LINES "build/tests/terminal.lines"

/* What is written to stderr while the messages go into a file, at so many equal steps; sent back to where they went. */
static const char *shown(progress *p, int steps, const char *line)
{
    int k;
    if (!freopen(LINES, "wb", stderr)) return "";
    for (k = 1; k <= steps; k++)
        if (p->terminal || progress_due(p, (double)k / steps)) progress_show(p, line);
    progress_end(p);
    fflush(stderr);
    return text_of(LINES);
}

static int count_of(const char *text, char c)
{
    int n = 0;
    for (; *text; text++) n += *text == c;
    return n;
}

static void test_lines(void)
{
    static const char longer[] = "123456789012345678901234567890123456789012345678901234567890123456789012345678901234";
    const char *text;
    progress p;
    progress_begin(&p, 0);
    p.terminal = 0;
    text = shown(&p, 1000, "x");
    CHECK_EQUAL("into a file: a line for every tenth", count_of(text, '\n'), 10);
    CHECK_EQUAL("... without a return", count_of(text, '\r'), 0);
    progress_begin(&p, 0);
    p.terminal = 0;
    CHECK_EQUAL("... of three steps: three", count_of(shown(&p, 3, "x"), '\n'), 3);
    progress_begin(&p, 1);
    p.terminal = 0;
    CHECK_EQUAL("quiet: none", (long)strlen(shown(&p, 1000, "x")), 0);
    progress_begin(&p, 0);
    p.terminal = 1;
    p.width = 40;
    text = shown(&p, 1, longer);
    CHECK_EQUAL("on a terminal of 40 columns: 39 of them, and empty again", (long)strlen(text), 1 + 39 + 1 + 39 + 1);
    CHECK_EQUAL("... in place", count_of(text, '\n'), 0);
    CHECK_TRUE("... what fits of the line", !strncmp(text + 1, longer, 39) && text[40] == '\r');
}

static void test_width(void)
{
    CHECK_EQUAL("COLUMNS is not set", terminal_width(NULL), 80);
    CHECK_EQUAL("... to a number", terminal_width("wide"), 80);
    CHECK_EQUAL("... to one that can be", terminal_width("0"), 80);
    CHECK_EQUAL("... it is", terminal_width("132"), 132);
}

static void test_seconds(void)
{
    CHECK_NEAR("in the first second nothing is known", progress_seconds(0, 0.9), 0, 0);
    CHECK_NEAR("alone on the machine: as CPU time tells", progress_seconds(2, 1.4), 1.4, 0);
    CHECK_NEAR("... which may be ahead of whole seconds", progress_seconds(2, 2.9), 2.9, 0);
    CHECK_NEAR("one of three: by the wall", progress_seconds(30, 10), 30, 0);
    CHECK_NEAR("asleep: by the wall", progress_seconds(3600, 2), 3600, 0);
}

static void test_stop(void)
{
    CHECK_TRUE("nobody asks", !stop_asked());
    stop_listen();
    raise(SIGTERM);
    CHECK_TRUE("SIGTERM asks", stop_asked());
    CHECK_TRUE("... once: the next one ends", signal(SIGTERM, SIG_DFL) == SIG_DFL);
}

int main(void)
{
    test_lines();
    test_width();
    test_seconds();
    test_stop();
    return check_end();
}
