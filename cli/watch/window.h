/* SPDX-License-Identifier: MIT
 * A scene that is being watched, shown in a window. */
#pragma once

#include "status.h"
#include "watch/session.h"
#include "watch/window_module.h"

typedef struct CliWindowDesc {
    CliSessionDesc session; /* wake and user are set here */
    bool once;              /* ends when the picture is finished, or the scene has errors */
} CliWindowDesc;

/* Finds and loads the module. Null, with a sentence in message, when it is missing or broken. It
 * stays loaded. */
const CliWindowModule *cli_window_find_module(char *message, size_t size);

/* Shows the scene until the user or a signal ends it. *opened is false when there is no screen,
 * with a sentence in message; nothing has happened then. */
CliStatus cli_window_run(const CliWindowModule *module, const CliWindowDesc *desc, bool *opened,
    char *message, size_t size);
