/* SPDX-License-Identifier: MIT
 *
 * main.c - the narc command: finds the command that is asked for and runs it.
 */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "fail.h"
#include "narc.h"
#include "output.h"
#include "progress.h"
#include "system.h"
#include "text.h"

/* The text that --help prints for each command, help/NAME.txt, as NAME_help. */
#include "help.inc"

static const struct {
    const command *command;
    const char *help;
} commands[] = {{&fit_command, fit_help},     {&export_command, export_help},   {&view_command, view_help},
                {&scene_command, scene_help}, {&collide_command, collide_help}, {&cast_command, cast_help},
                {&info_command, info_help}};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static void print_help(void) {
    printf("usage: narc COMMAND [ARGUMENTS]\n\n"
           "Batched collision of 2D convex shapes made of circular arcs.\n\n");
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        printf("  narc %-8s %s\n", commands[i].command->name, commands[i].command->summary);
    printf("\n"
           "  --help      this text; behind a command, the command's\n"
           "  --version   the version\n"
           "\n"
           "Errors are one line on standard error, with exit status 2; then no output file appears or\n"
           "changes.\n");
}

static bool is_help(const char *argument) { return strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0; }

static void run_command(size_t chosen, int argc, char **argv) {
    for (int i = 0; i < argc && strcmp(argv[i], "--") != 0; i++) {
        if (is_help(argv[i])) {
            fputs(commands[chosen].help, stdout);
            return;
        }
    }
    commands[chosen].command->run(argc, argv);
}

static size_t find_command(const char *name) {
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(name, commands[i].command->name) == 0)
            return i;
    fail("%s '%s'; see narc --help", name[0] == '-' ? "unknown option" : "unknown command",
         narc_make_excerpt(name).text);
}

int main(int argc, char **argv) {
    start_system(&argc, &argv);
    start_progress();
    if (argc < 2)
        fail("a command is missing; see narc --help");
    if (is_help(argv[1]))
        print_help();
    else if (strcmp(argv[1], "--version") == 0)
        printf("narc %s\n", narc_version());
    else
        run_command(find_command(argv[1]), argc - 2, argv + 2);
    finish_report(stdout);
    return count_reports() ? PARTIAL_STATUS : 0;
}
