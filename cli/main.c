/* SPDX-License-Identifier: MIT
 * glint: draws scene files. The program sees the library only through its public header, like
 * anybody else's program. */
#include "help.h"
#include "interrupt.h"
#include "message.h"
#include "options.h"
#include "render_command.h"

#include <stdio.h>

static CliStatus run(const CliOptions *options) {
    switch (options->action) {
    case CLI_ACTION_RENDER: return cli_render(options);
    case CLI_ACTION_HELP: cli_help_print(options->help); break;
    case CLI_ACTION_VERSION: printf("glint %s\n", glint_version_text()); break;
    case CLI_ACTION_LIST_ISA:
        for (int i = 0; glint_isa_name(i) != NULL; i++) puts(glint_isa_name(i));
        break;
    }
    return cli_message_flush_output();
}

int main(int argc, char **argv) {
    CliOptions options;
    CliStatus status = cli_options_parse(argc, argv, &options);
    if (status != CLI_OK) return (int)status;
    cli_interrupt_install();
    status = run(&options);
    cli_interrupt_die();
    return (int)status;
}
