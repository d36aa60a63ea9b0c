/* SPDX-License-Identifier: MIT
 *
 * system_posix.c - files and signals of POSIX.
 */
#define _XOPEN_SOURCE 700 /* realpath, mkstemp */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fail.h"
#include "system.h"

/* A file that is opened while a standard stream is closed takes its place: a picture would hold what was printed. So
 * something takes it that can only be read: then writing fails, and that is reported. */
void start_system(int *argc, char ***argv) {
    (void)argc, (void)argv;
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; stream++)
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) != stream)
            fail("a standard stream is closed, and /dev/null cannot stand in for it");
}

bool is_terminal(void) { return isatty(STDERR_FILENO); }

FILE *open_file(const char *path, const char *mode) { return fopen(path, mode); }

const char path_separator[] = "/";

size_t folder_length(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

char *find_real_path(const char *path) { return realpath(path, NULL); }

bool is_special(const char *path) {
    struct stat found;
    return stat(path, &found) == 0 && !S_ISREG(found.st_mode);
}

static int compare_paths(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

char **list_folder(const char *path, size_t *out_count) {
    DIR *folder = opendir(path);
    if (!folder)
        return NULL;
    size_t capacity = 0, count = 0;
    char **paths = grow(NULL, &capacity, 1, sizeof *paths);
    char *within = join_text(path, strlen(path), path[strlen(path) - 1] == '/' ? "" : path_separator);
    for (const struct dirent *entry; (entry = readdir(folder));) {
        if (entry->d_name[0] == '.')
            continue;
        paths = grow(paths, &capacity, count + 1, sizeof *paths);
        paths[count++] = join_text(within, strlen(within), entry->d_name);
    }
    closedir(folder);
    free(within);
    qsort(paths, count, sizeof *paths, compare_paths);
    *out_count = count;
    return paths;
}

/* rename() would replace a file that may not be written to, and root may write to all. */
static bool is_read_only(const char *target, const struct stat *old) {
    if (!(old->st_mode & 0222))
        errno = EACCES;
    return !(old->st_mode & 0222) || access(target, W_OK) != 0;
}

FILE *open_temporary(const char *target, char *volatile *out_name) {
    struct stat old;
    const bool exists = stat(target, &old) == 0;
    if (exists && is_read_only(target, &old))
        return NULL;
    const mode_t mask = umask(0);
    umask(mask);
    char *name =
        join_text(target, folder_length(target), ".narc-XXXXXX"); /* short: the target's may be as long as can be */
    *out_name = name;
    const int descriptor = mkstemp(name);
    if (descriptor < 0)
        return NULL;
    if (exists && fchown(descriptor, old.st_uid, old.st_gid) != 0 && fchown(descriptor, (uid_t)-1, old.st_gid) != 0)
        errno = 0; /* only root gives files to others */
    fchmod(descriptor, exists ? old.st_mode & 0777 : 0666 & ~mask);
    return fdopen(descriptor, "wb");
}

bool replace_file(const char *from, const char *target) { return rename(from, target) == 0; }

void remove_file(const char *path) { unlink(path); }

static void (*at_end)(void);

static volatile sig_atomic_t hears, interrupted;

static void on_signal(int number) {
    if (number == SIGINT && hears && !interrupted) {
        interrupted = 1;
        signal(number, on_signal);
        return;
    }
    if (at_end)
        at_end();
    signal(number, SIG_DFL);
    raise(number);
}

void hear_interrupts(bool hear) {
    hears = hear;
    if (hear && signal(SIGINT, on_signal) == SIG_IGN)
        signal(SIGINT, SIG_IGN);
}

bool was_interrupted(void) { return interrupted; }

static void handle_signals(void (*handler)(int)) {
    static const int numbers[] = {SIGINT,  SIGTERM, SIGHUP,    SIGPIPE, SIGQUIT, SIGALRM, SIGXCPU,
                                  SIGUSR1, SIGUSR2, SIGVTALRM, SIGPROF, SIGABRT, SIGTRAP};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        if (signal(numbers[i], handler) == SIG_IGN)
            signal(numbers[i], SIG_IGN);
}

void ignore_signals(void) { handle_signals(SIG_IGN); }

void watch_signals(void (*clean_up)(void)) {
    at_end = clean_up;
    handle_signals(on_signal);
    signal(SIGXFSZ, SIG_IGN);
}
