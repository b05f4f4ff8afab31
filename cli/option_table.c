/* SPDX-License-Identifier: MIT
 * The rows behind the list in option_table.h. */
#include "option_table.h"

#include <stddef.h>

const CliOption cli_option_table[] = {
#define CLI_OPTION_ROW(id, short_name, long_name, argument, form, group, help)                     \
    {CLI_OPTION_##id, short_name, long_name, argument, CLI_FORM_##form, CLI_GROUP_##group, help},
    CLI_OPTION_LIST(CLI_OPTION_ROW)
#undef CLI_OPTION_ROW
};

const char *cli_option_group_title(CliOptionGroup group) {
    switch (group) {
    case CLI_GROUP_PICTURE: return "The picture";
    case CLI_GROUP_MACHINE: return "The machine";
    case CLI_GROUP_MESSAGES: return "Messages";
    case CLI_GROUP_COUNT: break;
    }
    return "";
}
