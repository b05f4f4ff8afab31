/* SPDX-License-Identifier: MIT
 * glint schema: what editors need to complete and check scenes. */
#include "message.h"
#include "schema.h"
#include "value.h"
#include "verb.h"

typedef struct Options {
    int format; /* of format_name_at */
    GlintDialect dialect;
} Options;

static const char *format_name_at(int index) {
    static const char *const names[] = {"rng", "xsd", NULL};
    return names[index];
}

static CliStatus set_format(void *values, const char *value) {
    return cli_value_name("format", value, format_name_at, &((Options *)values)->format);
}

static CliStatus set_dialect(void *values, const char *value) {
    return cli_value_dialect(value, &((Options *)values)->dialect);
}

static CliStatus run(void *values, const CliOperands *operands) {
    const Options *options = values;
    if (operands->count > 0) {
        return cli_message_usage(
            "schema takes no '%s': it writes to standard output", operands->items[0]);
    }
    if (options->format == 0) {
        cli_schema_print_rng(options->dialect);
    } else {
        cli_schema_print_xsd(options->dialect);
    }
    return cli_message_flush_output();
}

static const char schema[] = "The schema";

static const CliOption options[] = {
    {0, "format", "rng|xsd", CLI_FORM_REQUIRED, schema,
        "RELAX NG (default), or XML Schema, which says less", set_format},
    {0, "dialect", "NAME", CLI_FORM_REQUIRED, schema,
        "only what a year has (default: what any has)", set_dialect},
};

static Options defaults;

const CliVerb cli_verb_schema = {.name = "schema",
    .operands = "",
    .summary = "write a schema of scenes, for editors",
    .about = "Writes a schema of scenes to standard output, with which an editor completes\n"
             "names, shows what they mean and marks mistakes.",
    .example_text = "check a scene with the schema",
    .example = "glint schema > glint.rng && xmllint --noout --relaxng glint.rng a.xml",
    .options = options,
    .option_count = CLI_COUNT(options),
    .values = &defaults,
    .run = run};
