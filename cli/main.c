/* SPDX-License-Identifier: MIT
 * glint: draws scene files, and answers questions about them. The program sees the library only
 * through its public header, like anybody else's program. */
#include "arguments.h"
#include "help.h"
#include "interrupt.h"
#include "message.h"

int main(int argc, char **argv) {
    CliArguments arguments;
    CliStatus status = cli_arguments_parse(argc, argv, &arguments);
    if (status != CLI_OK) return (int)status;
    if (arguments.answer != CLI_ANSWER_RUN) {
        cli_help_print(&arguments);
        return (int)cli_message_flush_output();
    }
    cli_interrupt_install();
    status = arguments.verb->run(arguments.verb->values, &arguments.operands);
    cli_interrupt_die();
    return (int)status;
}
