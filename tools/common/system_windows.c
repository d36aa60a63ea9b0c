/* SPDX-License-Identifier: MIT
 *
 * system_windows.c - files and consoles of Windows, whose names are UTF-16.
 */
#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>
/* After what it stands on. */
#include <windows.h>

#include <shellapi.h>

#include "fail.h"
#include "system.h"

/* Both give what is to be freed. */
static wchar_t *widen(const char *text) {
    const int size = MultiByteToWideChar(CP_UTF8, 0, text, -1, NULL, 0);
    wchar_t *wide = allocate((size_t)size, sizeof *wide);
    MultiByteToWideChar(CP_UTF8, 0, text, -1, wide, size);
    return wide;
}

static char *narrow(const wchar_t *wide) {
    const int size = WideCharToMultiByte(CP_UTF8, 0, wide, -1, NULL, 0, NULL, NULL);
    char *text = allocate((size_t)size, 1);
    WideCharToMultiByte(CP_UTF8, 0, wide, -1, text, size, NULL, NULL);
    return text;
}

static UINT code_page;

static void restore_console(void) { SetConsoleOutputCP(code_page); }

/* Lines end as they do elsewhere. */
void start_system(int *argc, char ***argv) {
    for (int stream = 0; stream <= 2; stream++)
        _setmode(stream, _O_BINARY);
    code_page = GetConsoleOutputCP();
    if (code_page && SetConsoleOutputCP(CP_UTF8))
        atexit(restore_console);
    wchar_t **wide = CommandLineToArgvW(GetCommandLineW(), argc);
    if (!wide)
        fail("the command line cannot be read");
    *argv = allocate((size_t)*argc + 1, sizeof **argv);
    for (int i = 0; i < *argc; i++)
        (*argv)[i] = narrow(wide[i]);
    (*argv)[*argc] = NULL;
    LocalFree(wide);
}

bool is_terminal(void) {
    const HANDLE console = GetStdHandle(STD_ERROR_HANDLE);
    DWORD mode;
    return GetConsoleMode(console, &mode) && SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

FILE *open_file(const char *path, const char *mode) {
    wchar_t *wide = widen(path), *wide_mode = widen(mode);
    FILE *file = _wfopen(wide, wide_mode);
    const DWORD attributes = file ? 0 : GetFileAttributesW(wide);
    if (attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_DIRECTORY))
        errno = EISDIR;
    free(wide);
    free(wide_mode);
    return file;
}

const char path_separator[] = "\\";

size_t folder_length(const char *path) {
    size_t length = strlen(path);
    while (length && !strchr("/\\:", path[length - 1]))
        length--;
    return length;
}

static void set_errno(void) {
    const DWORD error = GetLastError();
    errno = error == ERROR_FILE_NOT_FOUND || error == ERROR_PATH_NOT_FOUND || error == ERROR_INVALID_NAME ? ENOENT
            : error == ERROR_ACCESS_DENIED || error == ERROR_SHARING_VIOLATION                            ? EACCES
            : error == ERROR_WRITE_PROTECT                                                                ? EROFS
            : error == ERROR_FILENAME_EXCED_RANGE                                                         ? ENAMETOOLONG
            : error == ERROR_FILE_EXISTS || error == ERROR_ALREADY_EXISTS                                 ? EEXIST
            : error == ERROR_DISK_FULL || error == ERROR_HANDLE_DISK_FULL                                 ? ENOSPC
                                                                                                          : EIO;
}

/* A file, device or folder that is there, to be asked about. */
static HANDLE open_handle(const char *path) {
    wchar_t *wide = widen(path);
    const HANDLE handle = CreateFileW(wide, 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL,
                                      OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, NULL);
    free(wide);
    return handle;
}

char *find_real_path(const char *path) {
    char *found = NULL;
    const HANDLE handle = open_handle(path);
    const DWORD size = handle == INVALID_HANDLE_VALUE ? 0 : GetFinalPathNameByHandleW(handle, NULL, 0, 0);
    if (size) {
        wchar_t *wide = allocate((size_t)size + 1, sizeof *wide);
        if (GetFinalPathNameByHandleW(handle, wide, size + 1, 0))
            found = narrow(wide);
        free(wide);
    }
    if (!found)
        set_errno();
    if (handle != INVALID_HANDLE_VALUE)
        CloseHandle(handle);
    return found;
}

bool is_special(const char *path) {
    const HANDLE handle = open_handle(path);
    BY_HANDLE_FILE_INFORMATION found;
    if (handle == INVALID_HANDLE_VALUE)
        return false;
    const bool special = GetFileType(handle) != FILE_TYPE_DISK || !GetFileInformationByHandle(handle, &found) ||
                         (found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
    CloseHandle(handle);
    return special;
}

static int compare_paths(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

char **list_folder(const char *path, size_t *out_count) {
    const size_t length = strlen(path);
    char *within = join_text(path, length, folder_length(path) == length ? "" : path_separator),
         *any = join_text(within, strlen(within), "*");
    wchar_t *wide = widen(any);
    WIN32_FIND_DATAW found;
    const HANDLE search = FindFirstFileW(wide, &found);
    size_t capacity = 0, count = 0;
    char **paths = search == INVALID_HANDLE_VALUE ? NULL : grow(NULL, &capacity, 1, sizeof *paths);
    for (BOOL more = paths != NULL; more; more = FindNextFileW(search, &found)) {
        if (found.cFileName[0] == L'.')
            continue;
        char *name = narrow(found.cFileName);
        paths = grow(paths, &capacity, count + 1, sizeof *paths);
        paths[count++] = join_text(within, strlen(within), name);
        free(name);
    }
    if (paths) {
        FindClose(search);
        qsort(paths, count, sizeof *paths, compare_paths);
        *out_count = count;
    }
    free(within);
    free(any);
    free(wide);
    return paths;
}

/* Other programs, and this one, may remove the file while it is open. */
FILE *open_temporary(const char *target, char *volatile *out_name) {
    wchar_t *wide = widen(target);
    const DWORD attributes = GetFileAttributesW(wide);
    free(wide);
    if (attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_READONLY)) {
        errno = EACCES;
        return NULL;
    }
    const size_t length = folder_length(target);
    char *name = join_text(target, length, ".narc-000000");
    *out_name = name;
    HANDLE handle = INVALID_HANDLE_VALUE;
    for (unsigned long number = GetCurrentProcessId(); handle == INVALID_HANDLE_VALUE; number++) {
        sprintf(name + length, ".narc-%06lx", number & 0xffffff);
        wide = widen(name);
        handle = CreateFileW(wide, GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_DELETE, NULL, CREATE_NEW,
                             FILE_ATTRIBUTE_NORMAL, NULL);
        free(wide);
        if (handle == INVALID_HANDLE_VALUE && GetLastError() != ERROR_FILE_EXISTS) {
            set_errno();
            return NULL;
        }
    }
    return _fdopen(_open_osfhandle((intptr_t)handle, _O_BINARY), "wb");
}

bool replace_file(const char *from, const char *target) {
    wchar_t *wide_from = widen(from), *wide_target = widen(target);
    const bool done = MoveFileExW(wide_from, wide_target, MOVEFILE_REPLACE_EXISTING);
    if (!done)
        set_errno();
    free(wide_from);
    free(wide_target);
    return done;
}

void remove_file(const char *path) {
    wchar_t *wide = widen(path);
    DeleteFileW(wide);
    free(wide);
}

static void (*at_end)(void);
static volatile bool ignored;

static volatile LONG hears, interrupted;

static BOOL WINAPI on_event(DWORD event) {
    if (ignored)
        return TRUE;
    if (event == CTRL_C_EVENT && hears && !interrupted) {
        interrupted = 1;
        return TRUE;
    }
    if (at_end)
        at_end();
    return FALSE; /* and the process ends */
}

void hear_interrupts(bool hear) {
    hears = hear;
    if (hear && !at_end)
        SetConsoleCtrlHandler(on_event, TRUE);
}

bool was_interrupted(void) { return interrupted; }

void ignore_signals(void) { ignored = true; }

void watch_signals(void (*clean_up)(void)) {
    at_end = clean_up;
    SetConsoleCtrlHandler(on_event, TRUE);
}
