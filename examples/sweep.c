/* sweep - thousands of runs: a table of tasks in, one result for each out, by any number of workers on any number of
   machines that share a folder (docs/scale.md).

   tasks.csv is a table: a column "program", the others are options of that program, an empty cell is an option that is
   not given.

       program,velocity,diameter,bond
       impact,700,14,
       impact,800,14,none

       build/sweep tasks.csv --list                        what is not done yet
       build/sweep tasks.csv --run                         works on whatever is left; start as many as you like
       build/sweep tasks.csv --task 1                      one of them
       build/sweep --status                                how far all workers together are
       build/sweep tasks.csv --collect --keys pbcp_percent,v_rest_relative_m_s
       build/sweep tasks.csv --slurm | sbatch              as a job array

   A task is known by its content: program, version, options, and what the files hold that they name. Its result is a
   folder, OUT/runs/HASH, that gets its name when it is whole; it is never made twice. A task that a worker has begun is
   claimed; a claim that shows no sign of life for --dead seconds is taken over. What was stopped goes on from its
   checkpoint. Needs a POSIX system, since it starts programs and waits for them; libc and libm only.
   SPDX-License-Identifier: MIT */
#if defined(__unix__) || defined(__APPLE__)
#define _POSIX_C_SOURCE 200809L
#define _XOPEN_SOURCE 700 /* realpath */
#endif
#define MPM_IMPLEMENTATION
#include "mpm_io.h"
#include "sweep.h"
#include "sweep_table.h"
#include "terminal.h"

#ifdef SWEEP_CLAIMS
#include <sys/wait.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

/* ---- a sweep ------------------------------------------------------------------------------- */

#define PROGRAMS 32

/* A program of the table, and what it says of itself. */
typedef struct program {
    const char *name; /* in the table */
    char path[PATH_BYTES], help[20000], version[80];
} program;

/* What is kept with a result. */
enum { TASK_SECONDS, TASK_ATTEMPT, TASK_STATUS, TASK_VALUES };
static const char *const task_value[TASK_VALUES] = {"seconds", "attempt", "exit_status"};

typedef enum state { STATE_OPEN, STATE_ALIVE, STATE_FAILED, STATE_FINISHED } state;
static const char *const state_name[] = {"open", "under way", "failed", "finished"};

typedef struct task {
    const program *program;
    char *key;
    state state; /* as far as this worker knows */
} task;

typedef struct sweep {
    const char *table_path, *folder, *keys, *program_name;
    double dead;
    int64_t only, tries, workers; /* only: this task; < 0: all */
    int list, run, collect, status, slurm, pbs, lsf, again, leave, quiet;
    const char *self;             /* argv[0] */
    table table;
    program programs[PROGRAMS];
    int programs_known;
    int *order;                   /* of the columns: by name */
    task *task;
    int tasks;
    int line;                     /* of the table, while it is read */
} sweep;

/* "error: tasks.csv, line 3: TEXT" */
static int table_complain(const sweep *s, const char *text, const char *value)
{
    fprintf(stderr, "error: %s, line %d: %s '%s'\n", s->table_path, s->line, text, value);
    return 0;
}

/* ---- programs ------------------------------------------------------------------------------ */

/* Seconds, from anywhere. */
static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void doze(double seconds)
{
    struct timespec t;
    t.tv_sec = (time_t)seconds;
    t.tv_nsec = (long)(1e9 * (seconds - (double)t.tv_sec));
    nanosleep(&t, NULL);
}

/* Whether a value is an input: it has a slash and names a file. */
static int is_input(const char *value)
{
    struct stat st;
    return strchr(value, '/') && stat(value, &st) == 0 && S_ISREG(st.st_mode);
}

/* Goes to the folder in which a program runs; its inputs get their whole paths before. */
static int enter(const char *folder, char **argv)
{
    for (argv++; *argv; argv++)
        if (is_input(*argv) && (*argv = realpath(*argv, NULL)) == NULL) return 0;
    return chdir(folder) == 0;
}

/* Starts a program whose output goes to files; in a folder, if one is given. A worker that is killed takes it along,
   where the system has such a thing. */
static pid_t start(const char *folder, char **argv, const char *out, const char *err)
{
    const pid_t child = fork();
    if (child != 0) return child;
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    if ((folder && !enter(folder, argv)) || !freopen("/dev/null", "r", stdin) || !freopen(out, "w", stdout) ||
        !freopen(err, "w", stderr))
        _exit(126);
    execvp(argv[0], argv);
    _exit(127);
}

/* The exit status, 128 and more: ended by a signal. */
static int exit_status(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

static void wait_for(pid_t child, int *status)
{
    while (waitpid(child, status, 0) < 0 && errno == EINTR) continue;
}

/* Runs a command of the system that has nothing to say; 1 if it ends well. */
static int command(const char *name, const char *flag, const char *from, const char *to)
{
    char *argv[5];
    int status = 1;
    pid_t child;
    argv[0] = (char *)name;
    argv[1] = (char *)flag;
    argv[2] = (char *)from;
    argv[3] = (char *)to;
    argv[4] = NULL;
    child = start(NULL, argv, "/dev/null", "/dev/null");
    if (child > 0) wait_for(child, &status);
    return child > 0 && exit_status(status) == 0;
}

/* What a program prints to one option, up to the room. Returns 1 if it ends well. */
static int ask(const program *p, const char *flag, char *text, size_t room)
{
    char *argv[3];
    int ends[2], status = 1;
    size_t n = 0;
    ssize_t got;
    pid_t child;
    text[0] = 0;
    if (pipe(ends) != 0) return 0;
    argv[0] = (char *)p->path;
    argv[1] = (char *)flag;
    argv[2] = NULL;
    child = fork();
    if (child == 0) {
        if (dup2(ends[1], 1) < 0 || close(ends[0]) != 0 || !freopen("/dev/null", "w", stderr)) _exit(126);
        execv(argv[0], argv);
        _exit(127);
    }
    close(ends[1]);
    while (child > 0 && n + 1 < room && (got = read(ends[0], text + n, room - 1 - n)) != 0)
        if (got > 0) n += (size_t)got;
        else if (errno != EINTR) break;
    close(ends[0]);
    text[n] = 0;
    if (child > 0) wait_for(child, &status);
    return child > 0 && exit_status(status) == 0 && n > 0;
}

/* The line of an option in a program's help, or NULL. */
static const char *help_of(const program *p, const char *name)
{
    char wanted[80];
    if (strlen(name) > 60) return NULL;
    snprintf(wanted, sizeof wanted, "\n  --%s ", name);
    return strstr(p->help, wanted);
}

/* Whether the line says that it is a flag. */
static int is_flag(const char *help)
{
    const char *end = help + 1 + strcspn(help + 1, "\n");
    return !strncmp(end - 5, "[off]", 5) || !strncmp(end - 4, "[on]", 4);
}

/* Where a program is: by its path, or beside this one. */
static int program_find(const sweep *s, program *p)
{
    const char *slash = strrchr(s->self, '/');
    char path[PATH_BYTES], *found;
    if (strchr(p->name, '/')) snprintf(path, sizeof path, "%s", p->name);
    else snprintf(path, sizeof path, "%.*s/%s", slash ? (int)(slash - s->self) : 1, slash ? s->self : ".", p->name);
    found = realpath(path, NULL);
    if (found) snprintf(p->path, sizeof p->path, "%s", found);
    free(found);
    return found && access(p->path, X_OK) == 0;
}

/* The program of that name, asked for its options and its version the first time; NULL after a message. */
static const program *program_of(sweep *s, const char *name)
{
    program *p;
    int k = 0;
    while (k < s->programs_known && strcmp(s->programs[k].name, name)) k++;
    if (k < s->programs_known) return &s->programs[k];
    if (k == PROGRAMS) return table_complain(s, "one program too many:", name), NULL;
    p = &s->programs[k];
    p->name = name;
    if (!*name || !program_find(s, p)) return table_complain(s, "there is no program", name), NULL;
    if (!ask(p, "--help", p->help, sizeof p->help) || !ask(p, "--version", p->version, sizeof p->version))
        return table_complain(s, "a program that does not know --help and --version:", name), NULL;
    p->version[strcspn(p->version, "\n")] = 0;
    s->programs_known++;
    return p;
}

/* ---- tasks --------------------------------------------------------------------------------- */

/* Appends a word to a key, with what would blur it as %XX. */
static size_t key_word(char *key, size_t room, size_t used, const char *word)
{
    char code[4];
    for (; *word; word++) {
        const unsigned char c = (unsigned char)*word;
        snprintf(code, sizeof code, c <= ' ' || strchr("\"\\,%", c) ? "%%%02X" : "%c", c);
        used = mpm_append(key, room, used, code);
    }
    return used;
}

/* The hash of an input; tasks that follow each other often share one. "" after a message. */
static const char *input_hash(const sweep *s, const char *value)
{
    static char last[PATH_BYTES], text[HASH_DIGITS];
    uint64_t h = HASH_NONE;
    if (*last && !strcmp(last, value)) return text;
    if (strlen(value) >= sizeof last || !kept_file(value, &h)) return table_complain(s, "cannot read", value), "";
    strcpy(last, value);
    return hash_digits(h, text);
}

/* The value of a column as it counts, NULL if it is not given. */
static const char *task_cell(const sweep *s, int row, int column)
{
    const char *value = table_cell(&s->table, row, column);
    if (!*value || !strcmp(table_cell(&s->table, 0, column), "program")) return NULL;
    return value;
}

/* Refuses an option that a program has not, and what is no flag's value. */
static int task_check(const sweep *s, const program *p, int row)
{
    int k;
    for (k = 0; k < s->table.columns; k++) {
        const char *name = table_cell(&s->table, 0, k), *value = task_cell(s, row, k), *help;
        if (!value) continue;
        help = help_of(p, name);
        if (!help) return table_complain(s, "the program has no option", name);
        if (is_flag(help) && word_place("on|off", value) < 0) return table_complain(s, "neither on nor off:", value);
    }
    return 1;
}

/* The whole description of a task, to be freed; NULL after a message. */
static char *task_key(const sweep *s, const program *p, int row)
{
    const char *slash = strrchr(p->name, '/');
    size_t room = 100 + 3 * (strlen(p->name) + strlen(p->version)), used = 0;
    char *key;
    int k;
    for (k = 0; k < s->table.columns; k++)
        room += strlen(table_cell(&s->table, 0, k)) + 3 * strlen(table_cell(&s->table, row, k)) + 40;
    if ((key = (char *)malloc(room)) == NULL) return complain("no memory for the tasks"), NULL;
    used = key_word(key, room, used, slash ? slash + 1 : p->name);
    used = mpm_append(key, room, used, ", ");
    used = key_word(key, room, used, p->version);
    for (k = 0; k < s->table.columns; k++) {
        const int column = s->order[k], input = task_cell(s, row, column) && is_input(task_cell(s, row, column));
        const char *value = task_cell(s, row, column), *name = table_cell(&s->table, 0, column);
        if (!value || (is_flag(help_of(p, name)) && !strcmp(value, "off"))) continue;
        if (input && !*(value = input_hash(s, value))) return free(key), NULL;
        used = mpm_append(key, room, used, ", ");
        used = mpm_append(key, room, used, name);
        used = mpm_append(key, room, used, input ? " file " : " ");
        used = key_word(key, room, used, value);
    }
    return key;
}

/* The columns by name, so that their order in the table does not count; refuses what this program sets itself. */
static int sort_columns(sweep *s)
{
    const table *t = &s->table;
    int k, j;
    s->order = (int *)malloc((size_t)t->columns * sizeof *s->order);
    if (!s->order) return complain("no memory for the tasks");
    s->line = t->line[0];
    for (k = 0; k < t->columns; k++) {
        const char *name = table_cell(t, 0, k);
        if (!*name || name[strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789-")] || *name == '-')
            return table_complain(s, "a column's name is no option's:", name);
        if (word_place("out|quiet|resume|help|version", name) >= 0)
            return table_complain(s, "a column that is not the table's to set:", name);
        if (table_column(t, name) < k) return table_complain(s, "two columns of the name", name);
        for (j = k; j > 0 && strcmp(table_cell(t, 0, s->order[j - 1]), name) > 0; j--) s->order[j] = s->order[j - 1];
        s->order[j] = k;
    }
    return 1;
}

/* Reads the table and describes its tasks. */
static int tasks_read(sweep *s)
{
    int k, column;
    if (!table_read(&s->table, s->table_path) || !sort_columns(s)) return 0;
    column = table_column(&s->table, "program");
    if (column < 0 && !*s->program_name) return table_complain(s, "neither --program nor a column", "program");
    s->task = (task *)calloc((size_t)s->table.rows, sizeof *s->task);
    if (!s->task) return complain("no memory for the tasks");
    for (k = 0; k < s->table.rows - 1; k++) {
        task *t = &s->task[k];
        s->line = s->table.line[k + 1];
        t->program = program_of(s, column < 0 ? s->program_name : table_cell(&s->table, k + 1, column));
        if (!t->program || !task_check(s, t->program, k + 1)) return 0;
        if ((t->key = task_key(s, t->program, k + 1)) == NULL) return 0;
        s->tasks++;
    }
    return 1;
}

static void sweep_free(sweep *s)
{
    int k;
    for (k = 0; k < s->tasks; k++) free(s->task[k].key);
    free(s->task);
    free(s->order);
    table_free(&s->table);
}

/* ---- results ------------------------------------------------------------------------------- */

/* The checksum of what a program left behind in a folder: its summary, and what it printed. */
static uint64_t outputs_hash(const char *folder)
{
    char path[PATH_BYTES];
    uint64_t h = HASH_NONE;
    kept_file(file_in(folder, "summary.json", path, sizeof path), &h);
    kept_file(file_in(folder, "stdout.txt", path, sizeof path), &h);
    return h;
}

/* The record of a task among the finished or the failed ones. Returns 1 if it is there, and whole. */
static int record_read(const sweep *s, const char *where, const char *key, double *value)
{
    char folder[PATH_BYTES], path[PATH_BYTES], *text;
    int good;
    kept_path(s->folder, where, key, "", folder, sizeof folder);
    text = table_text(file_in(folder, "task.json", path, sizeof path));
    good = text && kept_take(text, outputs_hash(folder), key, task_value, value, TASK_VALUES);
    free(text);
    return good;
}

/* How a task stands. */
static state state_of(const sweep *s, const char *key, claim *c)
{
    double value[TASK_VALUES];
    if (record_read(s, "runs", key, value)) return STATE_FINISHED;
    if (!s->again && record_read(s, "failed", key, value)) return STATE_FAILED;
    *c = claim_look(s->folder, key, s->dead);
    if (c->alive) return STATE_ALIVE;
    return c->number >= s->tries && !s->again ? STATE_FAILED : STATE_OPEN;
}

/* Looks at all tasks that are not known to be finished. */
static void states_look(sweep *s)
{
    claim c;
    int k;
    for (k = 0; k < s->tasks; k++)
        if (s->task[k].state != STATE_FINISHED) s->task[k].state = state_of(s, s->task[k].key, &c);
}

static int states_count(const sweep *s, state wanted)
{
    int k, n = 0;
    for (k = 0; k < s->tasks; k++) n += s->task[k].state == wanted;
    return n;
}

/* The folder in which attempt n of a task works. */
static const char *work_path(const sweep *s, const char *key, int n, char *path, size_t room)
{
    char ending[20];
    snprintf(ending, sizeof ending, ".%d", n);
    return kept_path(s->folder, "attempts", key, ending, path, room);
}

/* Renames the work of a task to its result. An answer that got lost on its way, as NFS can lose one, is none: the names
   count. */
static int settle(const sweep *s, const char *where, const char *key, const char *work)
{
    char target[PATH_BYTES];
    double value[TASK_VALUES];
    if (rename(work, kept_path(s->folder, where, key, "", target, sizeof target)) == 0) return 1;
    return access(work, F_OK) != 0 && record_read(s, where, key, value);
}

/* Gives the work of a task its final name, unless it has a result by now. Returns 1; 0 after a message; -1 if the work
   is gone: another has taken over. */
static int publish(const sweep *s, const char *key, const char *work, const double *value)
{
    const char *where = value[TASK_STATUS] > 0 ? "failed" : "runs";
    char target[PATH_BYTES], path[PATH_BYTES];
    double other[TASK_VALUES];
    mpm_fault fault;
    file_in(work, "task.json", path, sizeof path);
    if (!kept_write(path, outputs_hash(work), key, task_value, value, TASK_VALUES, &fault))
        return access(work, F_OK) != 0 ? -1 : report(&fault, path);
    if (settle(s, where, key, work)) return 1;
    if (record_read(s, "runs", key, other)) return command("rm", "-rf", work, NULL); /* another was faster */
    if (access(work, F_OK) != 0) return -1;
    kept_path(s->folder, where, key, "", target, sizeof target); /* damaged, or failed before */
    if (command("rm", "-rf", target, NULL) && settle(s, where, key, work)) return 1;
    fprintf(stderr, "error: %s cannot be renamed to %s\n", work, target);
    return 0;
}

/* ---- a worker ------------------------------------------------------------------------------ */

/* The command line of a task: to be freed with what `owned` points to. */
static char **task_arguments(const sweep *s, int number, int resume, char **owned)
{
    const program *p = s->task[number].program;
    const size_t columns = (size_t)s->table.columns;
    char **argv = (char **)malloc((2 * columns + 6) * sizeof *argv), *names = (char *)malloc(columns * 64);
    int n = 0, k;
    *owned = names;
    if (!argv || !names) return free(argv), NULL;
    argv[n++] = (char *)p->path;
    for (k = 0; k < s->table.columns; k++) {
        const char *name = table_cell(&s->table, 0, k), *value = task_cell(s, number + 1, k);
        if (!value || (is_flag(help_of(p, name)) && !strcmp(value, "off"))) continue;
        snprintf(names + 64 * k, 64, "--%s", name);
        argv[n++] = names + 64 * k;
        if (!is_flag(help_of(p, name))) argv[n++] = (char *)value;
    }
    if (help_of(p, "out")) {
        argv[n++] = (char *)"--out";
        argv[n++] = (char *)".";
    }
    if (help_of(p, "quiet")) argv[n++] = (char *)"--quiet";
    if (resume) argv[n++] = (char *)"--resume";
    argv[n] = NULL;
    return argv;
}

/* Takes over the folder of an attempt that ended early, if there is something to go on from, whole or not at all: as a
   copy, since who was taken for dead may still write there. Returns 1 if the program finds it by itself (the finished
   runs of a study), 2 if it must be told (a checkpoint), 0 if there is nothing. */
static int work_copy(const task *t, const char *old, const char *work)
{
    char path[PATH_BYTES], copy[PATH_BYTES + 8];
    const int told = help_of(t->program, "resume") &&
                     access(file_in(old, "checkpoint.bin", path, sizeof path), F_OK) == 0;
    if (!told && access(file_in(old, "runs", path, sizeof path), F_OK) != 0) return 0;
    snprintf(copy, sizeof copy, "%s.copy", work);
    if (!command("cp", "-R", old, copy) || (rename(copy, work) != 0 && access(work, F_OK) != 0)) return 0;
    return 1 + told;
}

/* Removes what an attempt left: under another name, so that it is gone at once for who was taken for dead. */
static void work_drop(const char *old)
{
    char away[PATH_BYTES + 8], copy[PATH_BYTES + 8];
    snprintf(away, sizeof away, "%s.old", old);
    snprintf(copy, sizeof copy, "%s.copy", old);
    if (rename(old, away) == 0 || access(away, F_OK) == 0 || access(copy, F_OK) == 0) command("rm", "-rf", away, copy);
}

/* Makes the folder of an attempt; what the ones before left goes. Returns 1, or 2 with a checkpoint; 0 after a
   message. */
static int work_begin(const sweep *s, const task *t, int attempt, const char *work)
{
    char old[PATH_BYTES];
    mpm_fault fault;
    int k, found = 0;
    for (k = attempt - 1; k > 0; k--) {
        work_path(s, t->key, k, old, sizeof old);
        if (!found) found = work_copy(t, old, work);
        work_drop(old);
    }
    if (mpm_io_make_directory(work, &fault) < 0) return report(&fault, work);
    return found == 2 ? 2 : 1;
}

/* Asks a program to end, in earnest after 20 seconds. */
static void end_child(pid_t child, int *status)
{
    const double begun = seconds_now();
    kill(child, SIGTERM);
    while (waitpid(child, status, WNOHANG) == 0) {
        if (seconds_now() - begun > 20) kill(child, SIGKILL);
        doze(0.05);
    }
}

/* Waits for a program, and shows that this worker lives. Returns 1 when it has ended by itself, 0 when the task was
   another's by then, -1 when this worker was asked to stop. */
static int attend(pid_t child, const claim *c, double dead, int *status)
{
    double beat = seconds_now(), nap = 0.001;
    while (waitpid(child, status, WNOHANG) == 0) {
        int lost = 0;
        if (seconds_now() - beat > dead / 6) {
            lost = !claim_beat(c);
            beat = seconds_now();
        }
        if (lost || stop_asked()) {
            end_child(child, status);
            return lost ? 0 : -1;
        }
        doze(nap);
        if (nap < 0.2) nap *= 2;
    }
    return 1;
}

/* The first line that a program wrote to its standard error. */
static void print_reason(const sweep *s, const char *key)
{
    char folder[PATH_BYTES], path[PATH_BYTES], line[200] = "";
    FILE *f;
    kept_path(s->folder, "failed", key, "", folder, sizeof folder);
    f = fopen(file_in(folder, "stderr.txt", path, sizeof path), "r");
    if (f && fgets(line, sizeof line, f)) line[strcspn(line, "\n")] = 0;
    if (f) fclose(f);
    fprintf(stderr, "%s (%s)\n", line, folder);
}

/* What a task came to, in words and as its state. */
static state task_end(const sweep *s, int number, const double *value)
{
    const int status = (int)value[TASK_STATUS];
    if (status == 0) {
        if (!s->quiet) printf("task %d: %.1f s\n", number, value[TASK_SECONDS]);
        fflush(stdout);
        return STATE_FINISHED;
    }
    fprintf(stderr, "task %d: exit status %d: ", number, status);
    print_reason(s, s->task[number].key);
    return STATE_FAILED;
}

/* Runs a task that is claimed. Returns 1 when it has a result, which is in `value`; 0 after a message; -1 when it was
   given up: by a signal to it or to this worker, or since another has it. */
static int task_carry_out(const sweep *s, int number, const claim *c, double *value)
{
    const task *t = &s->task[number];
    const double begun = seconds_now();
    char work[PATH_BYTES], **argv, *owned;
    int status = 0, ended = 0, ready;
    pid_t child;
    ready = work_begin(s, t, c->number, work_path(s, t->key, c->number, work, sizeof work));
    argv = ready ? task_arguments(s, number, ready == 2, &owned) : NULL;
    if (!argv) return complain("a task cannot be begun");
    child = start(work, argv, "stdout.txt", "stderr.txt");
    if (child > 0) ended = attend(child, c, s->dead, &status);
    free(argv);
    free(owned);
    if (child < 0) return complain("no process for a task");
    value[TASK_SECONDS] = seconds_now() - begun;
    value[TASK_ATTEMPT] = c->number;
    value[TASK_STATUS] = exit_status(status);
    if ((ended < 1 || stop_asked()) && exit_status(status) != 0) return -1;
    if (exit_status(status) < 128 && exit_status(status) != STOPPED) return publish(s, t->key, work, value);
    fprintf(stderr, "task %d: stopped in attempt %d, exit status %d\n", number, c->number, exit_status(status));
    return -1;
}

/* Does a task if nobody does it, and notes how it stands then. Returns 1, or 0 after a message. */
static int task_work(sweep *s, int number)
{
    task *t = &s->task[number];
    double value[TASK_VALUES];
    claim c;
    int taken, done;
    t->state = state_of(s, t->key, &c);
    if (t->state != STATE_OPEN) return 1;
    t->state = STATE_ALIVE;
    taken = claim_take(&c);
    if (taken < 0) return fprintf(stderr, "error: %s/claims cannot be written\n", s->folder), 0;
    if (!taken) return 1;
    if (record_read(s, "runs", t->key, value)) return t->state = STATE_FINISHED, 1; /* before we had it */
    done = task_carry_out(s, number, &c, value);
    if (done > 0) t->state = task_end(s, number, value);
    if (t->state != STATE_FINISHED) claim_release(&c); /* a finished one keeps it: NFS may show the result late */
    return done != 0;
}

/* One pass over what is left. Returns how many tasks are others' or were given up; -1 after a message. */
static int pass(sweep *s, int first, int last)
{
    int k, left = 0;
    for (k = first; k < last && !stop_asked(); k++) {
        if (s->task[k].state >= STATE_FAILED) continue;
        if (!task_work(s, k)) return -1;
        left += s->task[k].state == STATE_ALIVE;
    }
    return left;
}

/* The plan: number and description of every task, for who looks on. Written when it is another one. */
static int plan_write(const sweep *s)
{
    char path[PATH_BYTES];
    mpm_io_csv csv;
    mpm_fault fault;
    table old;
    int k, same = 1;
    file_in(s->folder, "plan.csv", path, sizeof path);
    memset(&old, 0, sizeof old);
    if (access(path, F_OK) == 0 && table_read(&old, path) && old.rows == s->tasks + 1 && old.columns == 2)
        for (k = 0; k < s->tasks && same; k++) same = !strcmp(table_cell(&old, k + 1, 1), s->task[k].key);
    else same = 0;
    table_free(&old);
    if (same) return 1;
    mpm_io_csv_begin(&csv, path, "task,description", NULL, &fault);
    for (k = 0; k < s->tasks; k++) {
        mpm_io_csv_integer(&csv, k);
        mpm_io_csv_text(&csv, s->task[k].key);
    }
    return mpm_io_csv_end(&csv, &fault) >= 0 || report(&fault, path);
}

/* The folders that results go through. */
static int folders_make(const sweep *s)
{
    static const char *const name[] = {"claims", "attempts", "runs", "failed"};
    char path[PATH_BYTES];
    mpm_fault fault;
    int k;
    for (k = 0; k < 4; k++)
        if (mpm_io_make_directory(file_in(s->folder, name[k], path, sizeof path), &fault) < 0)
            return report(&fault, path);
    return 1;
}

/* Works on one task or on all, until each has a result. Returns what main returns. */
static int work(sweep *s)
{
    const int first = s->only < 0 ? 0 : (int)s->only, last = s->only < 0 ? s->tasks : first + 1;
    int left, k, failed = 0, open = 0;
    if (!folders_make(s) || !plan_write(s)) return 1;
    stop_listen();
    while ((left = pass(s, first, last)) > 0 && !s->leave && !stop_asked()) doze(s->dead < 6 ? s->dead / 6 : 1);
    if (left < 0) return 1;
    for (k = first; k < last; k++) {
        failed += s->task[k].state == STATE_FAILED;
        open += s->task[k].state < STATE_FAILED;
    }
    if (failed) fprintf(stderr, "%d of %d tasks failed; --again tries them once more\n", failed, last - first);
    if (open) fprintf(stderr, "%d of %d tasks are left: run again to go on\n", open, last - first);
    return failed ? 1 : open ? STOPPED : 0;
}

/* ---- what is printed and collected --------------------------------------------------------- */

/* The tasks that have no result, one a line: number, program, options. */
static void list(sweep *s)
{
    int k, c;
    states_look(s);
    for (k = 0; k < s->tasks; k++) {
        if (s->task[k].state == STATE_FINISHED) continue;
        printf("%d  %s", k, s->task[k].program->name);
        for (c = 0; c < s->table.columns; c++) {
            if (!task_cell(s, k + 1, c)) continue;
            printf(" --%s ", table_cell(&s->table, 0, c));
            print_argument(task_cell(s, k + 1, c));
        }
        printf("%s\n", s->task[k].state == STATE_FAILED ? "  (failed)" : "");
    }
}

/* "1:02:03" */
static const char *clock_text(double seconds, char text[40])
{
    const long whole = (long)(seconds + 0.5);
    snprintf(text, 40, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    return text;
}

/* How far all workers are, from the folder alone. */
static int status(sweep *s)
{
    char path[PATH_BYTES], left[40];
    double value[TASK_VALUES], sum = 0;
    int k, finished, alive, workers;
    claim c;
    if (!table_read(&s->table, file_in(s->folder, "plan.csv", path, sizeof path))) return 1;
    s->task = (task *)calloc((size_t)s->table.rows, sizeof *s->task);
    if (!s->task || s->table.columns != 2) return !complain("no memory, or another program's plan.csv");
    s->tasks = s->table.rows - 1;
    for (k = 0; k < s->tasks; k++) {
        const char *key = table_cell(&s->table, k + 1, 1);
        s->task[k].state = state_of(s, key, &c);
        if (s->task[k].state == STATE_FINISHED && record_read(s, "runs", key, value)) sum += value[TASK_SECONDS];
    }
    finished = states_count(s, STATE_FINISHED);
    alive = states_count(s, STATE_ALIVE);
    workers = alive > 0 ? alive : 1;
    printf("%d tasks: %d finished, %d failed, %d under way, %d open\n", s->tasks, finished,
           states_count(s, STATE_FAILED), alive, states_count(s, STATE_OPEN));
    sum = finished > 0 ? sum / finished : 0;
    clock_text(sum * (states_count(s, STATE_OPEN) + 0.5 * alive) / workers, left);
    if (finished > 0)
        printf("%.3g s a task; left, with %d %s: %s\n", sum, workers, workers > 1 ? "workers" : "worker", left);
    s->tasks = 0; /* the keys are the table's */
    return 0;
}

/* What stands behind a key in a summary, or behind "key = " in what was printed; "" if nothing does. */
static const char *result_text(const char *summary, const char *printed, const char *key, char *text, size_t room)
{
    char wanted[100];
    const char *at = summary ? json_value(summary, key) : NULL;
    size_t n;
    text[0] = 0;
    snprintf(wanted, sizeof wanted, "%s = ", key);
    if (!at && printed) {
        at = strstr(printed, wanted);
        while (at && at != printed && at[-1] != '\n') at = strstr(at + 1, wanted);
        if (at) at += strlen(wanted);
    }
    if (!at) return text;
    if (*at == '"') n = strcspn(++at, "\"");
    else n = strcspn(at, ",}\r\n");
    snprintf(text, room, "%.*s", (int)n, at);
    return text;
}

/* The wanted keys of a task's result, behind its cells. Counts what was found. */
static void collect_keys(const sweep *s, const task *t, mpm_io_csv *csv, int *found)
{
    char folder[PATH_BYTES], path[PATH_BYTES], key[72], text[200], *summary, *printed;
    const char *at;
    size_t n;
    kept_path(s->folder, "runs", t->key, "", folder, sizeof folder);
    summary = t->state == STATE_FINISHED ? table_text(file_in(folder, "summary.json", path, sizeof path)) : NULL;
    printed = t->state == STATE_FINISHED ? table_text(file_in(folder, "stdout.txt", path, sizeof path)) : NULL;
    for (at = s->keys; *at; at += n + (at[n] == ','), found++) {
        n = strcspn(at, ",");
        snprintf(key, sizeof key, "%.*s", (int)n, at);
        mpm_io_csv_text(csv, result_text(summary, printed, key, text, sizeof text));
        *found += *text != 0;
    }
    free(summary);
    free(printed);
}

/* The head of the collection, to be freed: the table's columns, the state, the keys. */
static char *collect_columns(const sweep *s)
{
    size_t room = strlen(s->keys) + 20, used = 0;
    char *text;
    int k;
    for (k = 0; k < s->table.columns; k++) room += strlen(table_cell(&s->table, 0, k)) + 1;
    if ((text = (char *)malloc(room)) == NULL) return NULL;
    for (k = 0; k < s->table.columns; k++) {
        used = mpm_append(text, room, used, table_cell(&s->table, 0, k));
        used = mpm_append(text, room, used, ",");
    }
    used = mpm_append(text, room, used, *s->keys ? "state," : "state");
    mpm_append(text, room, used, s->keys);
    return text;
}

#define KEYS 100

/* Refuses a key that no result has. */
static int collect_check(const sweep *s, const int *found)
{
    const char *at = s->keys;
    int k;
    for (k = 0; *at; k++) {
        const size_t n = strcspn(at, ",");
        if (found[k] == 0) return fprintf(stderr, "error: --keys %.*s: no result has it\n", (int)n, at), 0;
        at += n + (at[n] == ',');
    }
    return 1;
}

/* One table of all tasks, with what was asked for of their results. Returns what main returns. */
static int collect(sweep *s)
{
    char path[PATH_BYTES], *columns = collect_columns(s);
    int found[KEYS] = {0}, k, c, finished;
    mpm_io_csv csv;
    mpm_fault fault;
    if (!columns) return !complain("no memory for the collection");
    states_look(s);
    finished = states_count(s, STATE_FINISHED);
    mpm_io_csv_begin(&csv, file_in(s->folder, "results.csv", path, sizeof path), columns, NULL, &fault);
    free(columns);
    for (k = 0; k < s->tasks; k++) {
        for (c = 0; c < s->table.columns; c++) mpm_io_csv_text(&csv, table_cell(&s->table, k + 1, c));
        mpm_io_csv_text(&csv, state_name[s->task[k].state]);
        collect_keys(s, &s->task[k], &csv, found);
    }
    if (finished > 0 && !collect_check(s, found)) return mpm_io_csv_drop(&csv), 1;
    if (mpm_io_csv_end(&csv, &fault) < 0) return !report(&fault, path);
    if (!s->quiet) printf("%s: %d of %d tasks finished\n", path, finished, s->tasks);
    return finished == s->tasks ? 0 : STOPPED;
}

/* ---- scripts for schedulers ---------------------------------------------------------------- */

/* "build/sweep tasks.csv --out OUT" with what else a worker must know. */
static void print_self(const sweep *s)
{
    print_argument(s->self);
    printf(" ");
    print_argument(s->table_path);
    printf(" --out ");
    print_argument(s->folder);
    if (*s->program_name) printf(" --program "), print_argument(s->program_name);
    printf(" --dead %.15g --tries %lld", s->dead, (long long)s->tries);
}

/* What a job of the array does: one task, or with --workers whatever is left. */
static void print_job(const sweep *s, const char *folder, const char *index, const char *shift)
{
    printf("cd ");
    print_argument(folder);
    printf(" || exit 1\nexec ");
    print_self(s);
    if (s->workers > 0) printf(" --run\n");
    else printf(" --task $((%s%s))\n", index, shift);
}

static void print_submit(const sweep *s, const char *flag, const char *with)
{
    printf("#!/bin/sh\n# submit: ");
    print_self(s);
    if (s->workers > 0) printf(" --workers %lld", (long long)s->workers);
    printf(" %s | %s\n", flag, with);
}

/* Prints the script of a job array. Returns what main returns. */
static int script(const sweep *s)
{
    const long long jobs = s->workers > 0 ? (long long)s->workers : s->tasks;
    char folder[PATH_BYTES];
    if (!getcwd(folder, sizeof folder) || !folders_make(s)) return !complain("a path that is too long");
    if (jobs > 1000)
        fprintf(stderr, "an array of %lld jobs: many schedulers allow 1000; --workers N makes N of them\n", jobs);
    if (s->slurm) {
        print_submit(s, "--slurm", "sbatch");
        printf("#SBATCH --job-name=sweep --array=0-%lld\n#SBATCH --ntasks=1 --cpus-per-task=1\n", jobs - 1);
        printf("#SBATCH --time=1:00:00 --requeue --open-mode=append --signal=B:TERM@60\n");
        printf("#SBATCH --output=\"%s/job_%%A_%%a.txt\"\n", s->folder);
        print_job(s, folder, "SLURM_ARRAY_TASK_ID", "");
    } else if (s->pbs) {
        print_submit(s, "--pbs", "qsub");
        printf("# not tried\n#PBS -N sweep\n#PBS -J 0-%lld\n", jobs > 1 ? jobs - 1 : 1);
        printf("#PBS -l select=1:ncpus=1,walltime=1:00:00\n#PBS -r y\n#PBS -j oe\n");
        print_job(s, folder, "PBS_ARRAY_INDEX", "");
    } else {
        print_submit(s, "--lsf", "bsub");
        printf("# not tried\n#BSUB -J \"sweep[1-%lld]\"\n#BSUB -n 1\n#BSUB -W 1:00\n", jobs);
        printf("#BSUB -r\n#BSUB -o sweep_%%J_%%I.txt\n");
        print_job(s, folder, "LSB_JOBINDEX", " - 1");
    }
    return 0;
}

/* ---- main ---------------------------------------------------------------------------------- */

static int options(sweep *s, option *o)
{
    int n = 0;
    option_add(o, &n, "list", OPTION_FLAG, &s->list, "print the tasks that have no result");
    option_add(o, &n, "run", OPTION_FLAG, &s->run, "work on whatever is left");
    option_add(o, &n, "task", OPTION_INTEGER, &s->only, "work on this task only, from 0; < 0: none in particular");
    option_add(o, &n, "collect", OPTION_FLAG, &s->collect, "write results.csv: the table, and --keys of each summary");
    option_add(o, &n, "status", OPTION_FLAG, &s->status, "how far all workers are; needs no table");
    option_add(o, &n, "slurm", OPTION_FLAG, &s->slurm, "print the script of a job array for sbatch");
    option_add(o, &n, "pbs", OPTION_FLAG, &s->pbs, "the same for qsub; not tried");
    option_add(o, &n, "lsf", OPTION_FLAG, &s->lsf, "the same for bsub; not tried");
    option_add(o, &n, "keys", OPTION_TEXT, &s->keys, "what --collect takes of summary.json, KEY,KEY,...");
    option_add(o, &n, "program", OPTION_TEXT, &s->program_name, "of a table without that column");
    option_add(o, &n, "dead", OPTION_REAL, &s->dead, "seconds without a sign of life after which a task is taken over");
    option_add(o, &n, "tries", OPTION_INTEGER, &s->tries, "a task that took so many workers along has failed");
    option_add(o, &n, "again", OPTION_FLAG, &s->again, "try what failed once more");
    option_add(o, &n, "leave", OPTION_FLAG, &s->leave, "do not wait for tasks that others have under way");
    option_add(o, &n, "workers", OPTION_INTEGER, &s->workers,
               "jobs in the array, each of which works on whatever is left; 0: a job for each task");
    option_add(o, &n, "out", OPTION_TEXT, &s->folder, "folder for the results, seen by all workers");
    option_add(o, &n, "quiet", OPTION_FLAG, &s->quiet, "no line for each task");
    return n;
}

/* Refuses what makes no sense before anything is read. */
static int check(const sweep *s)
{
    const int errands = s->list + s->run + (s->only >= 0) + s->collect + s->status + s->slurm + s->pbs + s->lsf;
    const char *p;
    int keys = *s->keys != 0;
    for (p = s->keys; *p; p++) keys += *p == ',';
    if (errands != 1)
        return complain("wanted: one of --run, --task, --list, --status, --collect, --slurm, --pbs, --lsf");
    if (!s->status && !s->table_path) return complain("wanted: a table of tasks, as the first argument");
    if (!(s->dead >= 3 && s->dead < 1e6)) return fprintf(stderr, "error: --dead %g: must be 3 s or more\n", s->dead), 0;
    if (s->tries < 1) return fprintf(stderr, "error: --tries %lld: must be 1 or more\n", (long long)s->tries), 0;
    if (s->workers < 0 || s->workers > 1000000)
        return fprintf(stderr, "error: --workers %lld: must be 0 .. 1000000\n", (long long)s->workers), 0;
    if (keys > KEYS) return fprintf(stderr, "error: --keys: %d of them, at most %d\n", keys, KEYS), 0;
    if (!*s->folder) return complain("--out needs a folder");
    return 1;
}

static int errand(sweep *s)
{
    if (s->status) return status(s);
    if (!tasks_read(s)) return 1;
    if (s->only >= s->tasks) {
        fprintf(stderr, "error: --task %lld: there are %d, from 0\n", (long long)s->only, s->tasks);
        return 1;
    }
    if (s->list) return list(s), 0;
    if (s->collect) return collect(s);
    return s->run || s->only >= 0 ? work(s) : script(s);
}

static int carry_out(int argc, char **argv)
{
    static sweep s;
    option o[20];
    const int named = argc > 1 && strncmp(argv[1], "-", 1);
    int n, parsed, result;
    signal(SIGCHLD, SIG_DFL); /* who started this may ignore it: then nobody can wait for a program */
    s.self = argv[0];
    s.folder = "build/sweep-out";
    s.keys = s.program_name = "";
    s.dead = 120;
    s.only = -1;
    s.tries = 10;
    if (named) {
        s.table_path = argv[1];
        argv[1] = argv[0];
    }
    n = options(&s, o);
    parsed = options_parse(argc - named, argv + named, "Many runs: TABLE.csv before the options names the tasks, a row "
                           "each.\nColumns: program, and options of it; an empty cell is an option not given.", o, n);
    if (parsed) return parsed < 0;
    result = check(&s) ? errand(&s) : 1;
    sweep_free(&s);
    return result;
}
#else
static int carry_out(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    return !complain("sweep needs a POSIX system");
}
#endif

int main(int argc, char **argv) { return program_end(carry_out(argc, argv)); }
