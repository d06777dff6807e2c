// A disk that fails, preloaded into a program: it counts every change of what lies below a folder, and one of them fails as it is told.
//
// FAILING_DISK is "folder:report:at:error:manner". The change with the number `at` fails with the system's error `error`; manner `once`,
// `on` (all later ones as well), or `torn` (it writes half of its bytes before it fails, and all later ones fail as well). Then the name
// of the change and its path are written to the file `report`.
//
// Only what Rust's standard library calls on Linux is here. It is in C because `open` takes a variable list of arguments, which stable Rust
// can call and not define.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

static char folder[PATH_MAX], report[PATH_MAX], manner[8];
static long fails_at;
static int error_number;
static atomic_long changes;

__attribute__((constructor)) static void read_orders(void) {
    const char *orders = getenv("FAILING_DISK");
    if (orders == NULL ||
        sscanf(orders, "%4095[^:]:%4095[^:]:%ld:%d:%7s", folder, report, &fails_at, &error_number, manner) != 5) {
        folder[0] = '\0';
    }
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static void tell(const char *what, const char *path) {
    int file = NEXT(open)(report, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    if (file < 0) {
        return;
    }
    char line[PATH_MAX + 32];
    int length = snprintf(line, sizeof line, "%s %s\n", what, path);
    if (length > 0 && NEXT(write)(file, line, (size_t)length) < 0) {
        // Nobody can be told then.
    }
    NEXT(close)(file);
}

static int is_below(const char *path) {
    size_t length = strlen(folder);
    return length > 0 && strncmp(path, folder, length) == 0 && (path[length] == '/' || path[length] == '\0');
}

// Whether this change fails.
static int fails(const char *what, const char *path) {
    if (path == NULL || !is_below(path)) {
        return 0;
    }
    long number = atomic_fetch_add(&changes, 1) + 1;
    if (number < fails_at || (number > fails_at && strcmp(manner, "once") == 0)) {
        return 0;
    }
    if (number == fails_at) {
        tell(what, path);
    }
    errno = error_number;
    return 1;
}

static int fails_file(const char *what, int file) {
    if (folder[0] == '\0') {
        return 0;
    }
    char link[64], path[PATH_MAX];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0) {
        return 0;
    }
    path[length] = '\0';
    return fails(what, path);
}

static int is_change(int flags) { return (flags & (O_CREAT | O_TRUNC)) != 0; }

static mode_t mode_of(int flags, va_list arguments) {
    return (flags & (O_CREAT | O_TMPFILE)) != 0 ? (mode_t)va_arg(arguments, int) : 0;
}

#define OPEN(name)                                                                                                     \
    int name(const char *path, int flags, ...) {                                                                       \
        va_list arguments;                                                                                             \
        va_start(arguments, flags);                                                                                    \
        mode_t mode = mode_of(flags, arguments);                                                                       \
        va_end(arguments);                                                                                             \
        return is_change(flags) && fails("open", path) ? -1 : NEXT(name)(path, flags, mode);                           \
    }

OPEN(open)
OPEN(open64)

ssize_t write(int file, const void *bytes, size_t count) {
    if (fails_file("write", file)) {
        int error = errno;
        if (strcmp(manner, "torn") == 0 && count > 1 && NEXT(write)(file, bytes, count / 2) < 0) {
            // Torn at its beginning, then.
        }
        errno = error;
        return -1;
    }
    return NEXT(write)(file, bytes, count);
}

ssize_t writev(int file, const struct iovec *parts, int count) {
    return fails_file("writev", file) ? -1 : NEXT(writev)(file, parts, count);
}

int fsync(int file) { return fails_file("fsync", file) ? -1 : NEXT(fsync)(file); }

int fdatasync(int file) { return fails_file("fdatasync", file) ? -1 : NEXT(fdatasync)(file); }

int ftruncate64(int file, off64_t length) {
    return fails_file("ftruncate", file) ? -1 : NEXT(ftruncate64)(file, length);
}

int rename(const char *from, const char *to) { return fails("rename", to) ? -1 : NEXT(rename)(from, to); }

int mkdir(const char *path, mode_t mode) { return fails("mkdir", path) ? -1 : NEXT(mkdir)(path, mode); }

int unlink(const char *path) { return fails("unlink", path) ? -1 : NEXT(unlink)(path); }

int rmdir(const char *path) { return fails("rmdir", path) ? -1 : NEXT(rmdir)(path); }
