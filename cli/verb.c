/* SPDX-License-Identifier: MIT
 * The list of verbs, and what all of them share. */
#include "verb.h"

#include <string.h>

static const CliVerb *const verbs[] = {
#define CLI_VERB_ROW(name) &cli_verb_##name,
    CLI_VERB_LIST(CLI_VERB_ROW)
#undef CLI_VERB_ROW
};

const CliOption cli_common_options[CLI_COMMON_OPTION_COUNT] = {
    {'h', "help", "man|markdown", CLI_FORM_HIDDEN, "Messages", "show this help", NULL},
    {'V', "version", NULL, CLI_FORM_NONE, "Messages", "show the version", NULL},
};

const CliVerb *cli_verb_at(int index) { return index < CLI_COUNT(verbs) ? verbs[index] : NULL; }

const CliVerb *cli_verb_find(const char *name) {
    for (int i = 0; i < CLI_COUNT(verbs); i++) {
        if (strcmp(verbs[i]->name, name) == 0) return verbs[i];
    }
    return NULL;
}

const CliOption *cli_verb_option_at(const CliVerb *verb, int index) {
    if (index < verb->option_count) return &verb->options[index];
    index -= verb->option_count;
    return index < CLI_COMMON_OPTION_COUNT ? &cli_common_options[index] : NULL;
}
