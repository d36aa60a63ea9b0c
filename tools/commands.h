/* SPDX-License-Identifier: MIT
 *
 * commands.h - the commands of narc. Each runs with the arguments behind its name, and returns only when all went well.
 */
#ifndef NARC_TOOL_COMMANDS_H
#define NARC_TOOL_COMMANDS_H

typedef struct command {
    const char *name;
    const char *summary; /* one line */
    void (*run)(int argc, char **argv);
} command;

extern const command fit_command, export_command, view_command, scene_command, collide_command, cast_command,
    info_command;

#endif
