/* 62_studies - the study programs (made by make before the tests) on coarse grids: one number of each is
   checked, an interrupted study goes on without repeating a run, bad input is refused.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "study.h"
#include "check.h"
#include "files.h"

#define FOLDER "build/tests/studies"

/* A grid so coarse that a run takes a tenth of a second. */
#define COARSE "--functions gimp --cell 2 --spacing 1 --substrate-diameter 24 --substrate-height 6 --margin 0.5 "

static char output[20000];

/* Exit status of build/<command>: 0, or not. Its output is in `output`. */
static int run(const char *command)
{
    char line[800];
    int status;
    snprintf(line, sizeof line, "build/%s >" FOLDER ".out 2>&1", command);
    status = system(line) != 0;
    contents(FOLDER ".out", output, sizeof output);
    return status;
}

static void refused(const char *command, const char *value)
{
    CHECK_EQUAL(command, run(command), 1);
    CHECK_TRUE("... with a message naming it", strstr(output, value) != NULL);
}

static void critical(void)
{
    const char *search = "critical_velocity --method thesis " COARSE "--time 40 --gc 1000 --gdot 2e5 --rule stays "
                         "--low 500 --high 900 --scan 100 --step 50 --quiet --out " FOLDER "/critical ";
    const char *summary = FOLDER "/critical/summary.json";
    char command[600];
    double first;
    system("rm -rf " FOLDER);
    snprintf(command, sizeof command, "%s --limit 2", search);
    CHECK_EQUAL("a search stopped after two runs says so", run(command), 1);
    CHECK_TRUE("... in words", strstr(output, "run again") != NULL);
    CHECK_TRUE("... and writes no answer", isnan(number_in(summary, "critical_velocity_m_s")));
    CHECK_EQUAL("it goes on", run(search), 0);
    CHECK_EQUAL("... without repeating the two", number_in(summary, "runs") - number_in(summary, "runs_made_now"), 2);
    first = number_in(summary, "critical_velocity_m_s");
    CHECK_TRUE("the bracket is as narrow as asked", first - number_in(summary, "not_bonded_below_m_s") <= 50);
    CHECK_TRUE("the weak metal bonds between 700 and 900 m/s", first > 700 && first <= 900);
    CHECK_EQUAL("once more", run(search), 0);
    CHECK_EQUAL("... nothing is run again", number_in(summary, "runs_made_now"), 0);
    CHECK_EQUAL("... and the answer is the same", number_in(summary, "critical_velocity_m_s"), first);
    snprintf(command, sizeof command, "%s --gdot 1e5", search);
    CHECK_EQUAL("a weaker rate", run(command), 0);
    CHECK_TRUE("... is another case", number_in(summary, "runs_made_now") > 4);
    CHECK_TRUE("... that bonds at a lower velocity", number_in(summary, "critical_velocity_m_s") < first);
    snprintf(command, sizeof command, "%s --offsets 2 --high 1100", search);
    CHECK_EQUAL("two grid offsets", run(command), 0);
    CHECK_EQUAL("... both of which bond", number_in(summary, "offsets_without_bond"), 0);
    CHECK_TRUE("... not at the same velocity", number_in(summary, "lowest_m_s") < number_in(summary, "highest_m_s"));
    CHECK_NEAR("... with the median between", number_in(summary, "critical_velocity_m_s"),
               (number_in(summary, "lowest_m_s") + number_in(summary, "highest_m_s")) / 2, 1e-9);
    snprintf(command, sizeof command, "%s --grids 2", search);
    CHECK_EQUAL("a coarser grid", run(command), 0);
    CHECK_TRUE("... is searched too", number_in(summary, "runs_made_now") > 4);
    CHECK_EQUAL("... the answer stays", number_in(summary, "critical_velocity_m_s"), first);
    CHECK_NEAR("... its distance is among what is uncertain", number_in(summary, "uncertainty_of_grid_m_s"),
               fabs(first - number_in(summary, "coarser_grid_m_s")), 1e-9);
    CHECK_TRUE("... with the bracket", number_in(summary, "uncertainty_m_s") >
               number_in(summary, "uncertainty_of_grid_m_s"));
    snprintf(command, sizeof command, "%s --bond none", search);
    CHECK_EQUAL("without bonding", run(command), 0);
    CHECK_EQUAL("... no velocity bonds", number_in(summary, "offsets_without_bond"), 1);
    CHECK_EQUAL("no velocity bonds; the range ends between two that are tested",
                run("critical_velocity --method thesis " COARSE "--time 2 --bond none --low 500 --high 680 --scan 100 "
                    "--out " FOLDER "/none"), 0);
    CHECK_TRUE("... says up to which", strstr(output, "median none up to 600 m/s") != NULL);
    CHECK_TRUE("... and no infinity", !strstr(output, "inf"));
    refused("critical_velocity --rule often", "often");
    refused("critical_velocity --offsets 0", "offsets 0");
    refused("critical_velocity --grids 3", "grids 3");
    refused("critical_velocity --low -5", "-5");
    refused("critical_velocity --high 100", "high 100");
    refused("critical_velocity --step 0", "step 0");
    refused("critical_velocity --scan 1e-5 --step 1e-6", "scan 1e-05");
    refused("critical_velocity --time -5", "time -5");
    refused("critical_velocity --scan nan", "nan");
    refused("critical_velocity --material mud", "mud");
    refused("critical_velocity --velocity 810", "--velocity");
    refused("critical_velocity " COARSE "--time 1 --low 800 --high 800 --out /proc/none", "/proc/none");
}

/* From a guess outwards, and from one position's answer to the next: fewer runs than the whole range. */
static void near(void)
{
    const char *search = "critical_velocity --cell 2 --adhesion-critical 1000 --step 13 --quiet --out " FOLDER "/near ";
    const char *summary = FOLDER "/near/summary.json";
    char command[600];
    double first;
    CHECK_EQUAL("a search with contact on surfaces", run(search), 0);
    first = number_in(summary, "critical_velocity_m_s");
    printf("# coarse, on surfaces: %.0f (%.0f - %.0f) m/s in %.0f runs\n", first, number_in(summary, "lowest_m_s"),
           number_in(summary, "highest_m_s"), number_in(summary, "runs"));
    CHECK_EQUAL("... bonds at four positions", number_in(summary, "offsets_without_bond"), 0);
    CHECK_TRUE("... in fewer runs than one scan each", number_in(summary, "runs") < 4 * 9);
    CHECK_TRUE("... within the range", first > 600 && first < 1000);
    snprintf(command, sizeof command, "%s --low %.0f --high %.0f", search, first - 120, first + 60);
    CHECK_EQUAL("from a guess below the answer", run(command), 0);
    CHECK_NEAR("... the same one", number_in(summary, "critical_velocity_m_s"), first, 26);
    snprintf(command, sizeof command, "%s --low %.0f --high %.0f", search, first - 60, first + 200);
    CHECK_EQUAL("from a guess above it", run(command), 0);
    CHECK_NEAR("... the same one", number_in(summary, "critical_velocity_m_s"), first, 26);
    snprintf(command, sizeof command, "%s --bond none --offsets 1 --low 700 --high 900", search);
    CHECK_EQUAL("nothing bonds", run(command), 0);
    CHECK_EQUAL("... up to the range's end", number_in(summary, "offsets_without_bond"), 1);
    refused("impact --method guess", "guess");
}

/* The sweep over the two parameters of the bond on surfaces: its corners are of both classes. */
static void calibration_on_surfaces(void)
{
    const char *sweep = "calibrate --method surface --cell 2 --spacing 1 --columns 5 --rows 5 --gc-low 300 --gc-high "
                        "4000 --quiet --out " FOLDER "/surfaces";
    char command[300];
    snprintf(command, sizeof command, "%s --list", sweep);
    CHECK_EQUAL("a sweep of the bond on surfaces", run(command), 0);
    CHECK_TRUE("... names its parameters", strstr(output, "\n4  14 um at 810 m/s, G_c 4000, W0 10\n") != NULL);
    snprintf(command, sizeof command, "%s --task 20", sweep);
    CHECK_EQUAL("... the strongest bond", run(command), 0);
    snprintf(command, sizeof command, "%s --task 4", sweep);
    CHECK_EQUAL("... the weakest", run(command), 0);
    snprintf(command, sizeof command, "%s --collect", sweep);
    CHECK_EQUAL("... collected", run(command), 0);
    contents(FOLDER "/surfaces/tasks.csv", output, sizeof output);
    CHECK_TRUE("... are told", strstr(output, "adhesion_critical_J_m2,adhesion_J_m2") && lines_of(output) == 3);
    CHECK_TRUE("... the strongest holds", strstr(output, "\n20,14,810,300,150,") && strstr(output, ",1\n") != NULL);
    CHECK_TRUE("... the weakest does not", strstr(output, "\n4,14,810,4000,10,") && strstr(output, ",0\n") != NULL);
    refused("calibrate --method surface --bond none", "--bond interface");
    refused("calibrate --method surface --adhesion-low 0", "adhesion-low 0");
    refused("calibrate --method surface --gdot-low 1", "--gdot-low");
}

static void calibration(void)
{
    const char *sweep =
        "calibrate " COARSE "--time 12 --columns 6 --rows 5 --diameter-2 16 --gc-low 200 --gc-high 4000 "
        "--pbcp-1 10 --pbcp-2 10 --restitution-1 1 --restitution-2 1 --quiet --out " FOLDER "/calibrate ";
    const char *summary = FOLDER "/calibrate/summary.json";
    char command[700];
    int tasks;
    snprintf(command, sizeof command, "%s --list", sweep);
    CHECK_EQUAL("a sweep lists its first tasks", run(command), 0);
    tasks = lines_of(output);
    CHECK_EQUAL("... 15 of each size", tasks, 30);
    snprintf(command, sizeof command, "%s --collect", sweep);
    CHECK_EQUAL("nothing to collect yet", run(command), 1);
    snprintf(command, sizeof command, "%s --task 0 --limit 0", sweep);
    CHECK_EQUAL("one task, and no run allowed", run(command), 1);
    CHECK_TRUE("... says so", !strncmp(output, "stopped after 0 new runs", 24));
    snprintf(command, sizeof command, "%s --task 0", sweep);
    CHECK_EQUAL("one task alone", run(command), 0);
    snprintf(command, sizeof command, "%s --collect", sweep);
    CHECK_EQUAL("... can be collected", run(command), 0);
    CHECK_TRUE("... no fit", strstr(text_of(summary), "\"fit\": \"fewer than six runs\"") != NULL);
    CHECK_TRUE("... a picture of one size", contents(FOLDER "/calibrate/classes.png", output, sizeof output) > 1000);
    snprintf(command, sizeof command, "%s --list", sweep);
    run(command);
    CHECK_EQUAL("... leaves the list", lines_of(output), tasks - 1);
    CHECK_TRUE("... by its number", strncmp(output, "0  ", 3) != 0);
    snprintf(command, sizeof command, "%s --limit 3", sweep);
    CHECK_EQUAL("stopped after three", run(command), 1);
    CHECK_EQUAL("it goes on", run(sweep), 0);
    snprintf(command, sizeof command, "%s --list", sweep);
    run(command);
    CHECK_EQUAL("... to the end", lines_of(output), 0);
    CHECK_TRUE("some bonded", number_in(summary, "bonded") > 0);
    CHECK_TRUE("... and some did not", number_in(summary, "bonded") < number_in(summary, "tests"));
    CHECK_TRUE("the boundary parts them, but for a few", number_in(summary, "tests_on_the_wrong_side") <= 3);
    CHECK_TRUE("a picture", contents(FOLDER "/calibrate/classes.png", output, sizeof output) > 1000);
    refused("calibrate --columns 4", "columns 4");
    refused("calibrate --columns 0", "columns 0");
    refused("calibrate --rows 1000000000000000000", "more than 4000");
    refused("calibrate --rows 4000", "columns 25");
    refused("calibrate --gc-low 0", "gc-low 0");
    refused("calibrate --gdot-high 10", "gdot-high 10");
    refused("calibrate --scale cubic", "cubic");
    refused("calibrate --ridge -1", "ridge -1");
    refused("calibrate --bond strain", "--bond strain: the sweep");
    refused("calibrate --bond none", "--bond none: the sweep");
    refused("calibrate --task 9999", "9999");
    refused("calibrate --velocity-2 0", "velocity-2 0");
}

static void particles(void)
{
    const char *grid = "--cell 2 --spacing 1 --substrate-diameter 24 --substrate-height 6 --margin 0.5 --quiet "
                       "--frames 1 --out " FOLDER;
    char command[600], text[4000];
    snprintf(command, sizeof command, "two_particles %s/two --time 16 --height 22 --offset 3", grid);
    CHECK_EQUAL("a second particle", run(command), 0);
    CHECK_NEAR("mass", number_in(FOLDER "/two/summary.json", "mass_error"), 0, 1e-14);
    CHECK_EQUAL("both are in the report", lines_in(FOLDER "/two/particles.csv"), 3);
    CHECK_TRUE("the first touched the substrate, the second the first",
               contents(FOLDER "/two/pairs.csv", text, sizeof text) && strstr(text, "\n0,2,") &&
                   strstr(text, "\n0,1,"));
    CHECK_TRUE("a picture", contents(FOLDER "/two/frame_0000.png", text, sizeof text) > 1000);
    snprintf(command, sizeof command, "many_particles %s/many --count 3 --spread 20 --height 30 --seed 7 --time 2",
             grid);
    CHECK_EQUAL("three particles", run(command), 0);
    CHECK_EQUAL("... counted", number_in(FOLDER "/many/summary.json", "particles"), 3);
    CHECK_TRUE("... of which two arrive later", number_in(FOLDER "/many/summary.json", "arriving") >= 2);
    contents(FOLDER "/many/particles.csv", text, sizeof text);
    system("rm -rf " FOLDER "/many");
    CHECK_EQUAL("the same seed", run(command), 0);
    contents(FOLDER "/many/particles.csv", output, sizeof output);
    CHECK_TRUE("... gives the same report", !strcmp(text, output));
    snprintf(command, sizeof command, "two_particles --method surface %s/rings --geometry axisymmetric --time 16 "
             "--height 21.2 --adhesion-critical 100", grid);
    CHECK_EQUAL("two particles on surfaces, one behind the other", run(command), 0);
    CHECK_TRUE("... the second touched the first, the first the substrate",
               contents(FOLDER "/rings/pairs.csv", text, sizeof text) && strstr(text, "\n0,1,") &&
                   strstr(text, "\n0,2,") && !strstr(text, "\n1,2,"));
    CHECK_NEAR("... energy", number_in(FOLDER "/rings/summary.json", "energy_unaccounted"), 0, 0.01);
    CHECK_TRUE("... their surfaces in ParaView", contents(FOLDER "/rings/surface_0000.vtu", text, sizeof text) > 1000);
    CHECK_TRUE("... a share of what touched is bonded", number_in(FOLDER "/rings/summary.json", "pbcp_percent") > 1);
    snprintf(command, sizeof command, "many_particles --method surface %s/few --count 2 --spread 20 --time 0.4", grid);
    CHECK_EQUAL("some on surfaces", run(command), 0);
    CHECK_EQUAL("... counted", number_in(FOLDER "/few/summary.json", "particles"), 2);
    refused("two_particles --method surface --bond energy", "--bond interface");
    refused("two_particles --height 10", "overlap");
    refused("two_particles --geometry axisymmetric --offset 2", "3d");
    refused("two_particles --offset inf", "inf");
    refused("two_particles --symmetry quarter --offset 3", "quarter");
    refused("many_particles --count 0", "count 0");
    refused("many_particles --count 501", "501");
    refused("many_particles --count 400 --spread 20 --height 30", "no room");
    refused("many_particles --velocity 0", "velocity 0");
}

/* The page keeps what others wrote; a part that was cut off goes on. */
static void reproduction(void)
{
    const char *site = "reproduction --quiet --only site --limit 1 --out " FOLDER "/again --data " FOLDER
                       "/data --page " FOLDER "/page.md";
    char text[4000];
    const char *before = "before\n<!-- made by build/reproduction: begin -->\nold\n"
                         "<!-- made by build/reproduction: end -->\nbehind\n";
    int made;
    write_file(FOLDER "/page.md", before, strlen(before));
    CHECK_EQUAL("a reproduction stopped after one run", run(site), 1);
    CHECK_TRUE("... leaves the page", contents(FOLDER "/page.md", text, sizeof text) && strstr(text, "\nold\n"));
    run(site);
    system("ls " FOLDER "/again/runs | wc -l >" FOLDER ".out");
    contents(FOLDER ".out", text, sizeof text);
    made = (int)strtol(text, NULL, 10);
    CHECK_EQUAL("the next one makes the second run", made, 2);
    CHECK_EQUAL("no part at all",
                run("reproduction --quiet --only none --data " FOLDER "/data --page " FOLDER "/page.md"), 0);
    contents(FOLDER "/page.md", text, sizeof text);
    CHECK_TRUE("... replaces what stood between the marks", !strstr(text, "\nold\n") && strstr(text, "--budget quick"));
    CHECK_TRUE("... and keeps the rest", !strncmp(text, "before\n<!--", 11) && strstr(text, "end -->\nbehind\n"));
    refused("reproduction --budget lavish", "lavish");
    refused("reproduction --only crit,crti", "crti");
    refused("reproduction --only none --data /proc/none", "/proc/none");
}

/* Runs are known by their options: a member without one would mix different cases up. */
static void members(void)
{
    static const char *const programs[4] = {"critical_velocity", "calibrate", "two_particles", "many_particles"};
    impact_case c = impact_case_default();
    option o[IMPACT_OPTIONS];
    size_t bytes[3] = {0, 0, 0};
    int k, n = impact_options(&c, o);
    for (k = 0; k < n; k++) bytes[o[k].type == OPTION_FLAG ? 0 : 1] += o[k].type == OPTION_FLAG  ? sizeof(int)
                                                                 : o[k].type == OPTION_REAL ? sizeof(double)
                                                                                            : sizeof(char *);
    bytes[0] = (bytes[0] + sizeof(double) - 1) / sizeof(double) * sizeof(double); /* padded together */
    CHECK_EQUAL("every member of a case is an option", bytes[0] + bytes[1], sizeof c);
    for (k = 0; k < 4; k++) {
        char command[60];
        const char *at = output;
        int options = 0;
        snprintf(command, sizeof command, "%s --help", programs[k]);
        CHECK_EQUAL(command, run(command), 0);
        while ((at = strstr(at, "\n  --")) != NULL) at++, options++;
        CHECK_TRUE("... with its own options within the room for them", options > n && options <= IMPACT_OPTIONS);
    }
}

/* A kept run of which a byte is missing or changed is none, whichever it is. */
static void stores(void)
{
    study s = study_of(FOLDER "/store");
    const impact_case c = study_case_default();
    double value[STUDY_VALUES], back[STUDY_VALUES];
    char message[400], path[PATH_BYTES], text[12000], *key = study_key(&c, 0);
    size_t n, at;
    int k, wrong = 0;
    for (k = 0; k < STUDY_VALUES; k++) value[k] = k == 3 ? NAN : 0.1 + k / 7.0;
    study_path(&s, key, path, sizeof path);
    remove(path);
    CHECK_EQUAL("no run is kept", study_look(&s, &c, back), 0);
    CHECK_EQUAL("one is", study_keep(&s, &c, value, message, sizeof message), 1);
    CHECK_EQUAL("... and found", study_look(&s, &c, back), 1);
    CHECK_TRUE("... bit for bit", isnan(back[3]) && !memcmp(&back[4], &value[4], (STUDY_VALUES - 4) * sizeof *value));
    n = contents(path, text, sizeof text);
    for (at = 0; at + 2 < n; at++) { /* not the closing "}" and line */
        write_file(path, text, at);
        wrong += study_look(&s, &c, back) > 0 && at + 4 < n;
        text[at] = (char)(text[at] ^ 1);
        write_file(path, text, n);
        if (study_look(&s, &c, back) > 0)
            for (k = 0; k < STUDY_VALUES; k++) wrong += k != 3 && memcmp(&back[k], &value[k], sizeof *value) != 0;
        text[at] = (char)(text[at] ^ 1);
    }
    CHECK_EQUAL("damaged runs that are taken with other values", wrong, 0);
    remove(path);
    free(key);
}

/* Names and options of any length are whole, or refused. */
static void lengths(void)
{
    static char folder[5000], path[PATH_BYTES];
    const char *value = folder;
    char number[OPTION_NUMBER];
    option o[1];
    int n = 0;
    memset(folder, 'x', sizeof folder - 1);
    option_add(o, &n, "out", OPTION_TEXT, &value, "");
    CHECK_EQUAL("an option of 4999 characters", strlen(option_text(&o[0], number)), 4999);
    CHECK_EQUAL("a path too long is none", strlen(file_in(folder, "impact.png", path, sizeof path)), 0);
    folder[PATH_BYTES - 12] = 0;
    CHECK_EQUAL("the longest is whole", strlen(file_in(folder, "impact.png", path, sizeof path)), PATH_BYTES - 1);
    folder[PATH_BYTES - 12] = 'x';
    folder[PATH_BYTES - 11] = 0;
    CHECK_EQUAL("... and one more is refused", strlen(file_in(folder, "impact.png", path, sizeof path)), 0);
}

int main(void)
{
    members();
    stores();
    lengths();
    critical();
    near();
    calibration_on_surfaces();
    calibration();
    particles();
    reproduction();
    return check_end();
}
