/* SPDX-License-Identifier: MIT
 * glint upgrade: an old year's scene by the rules of today. */
#include "content.h"
#include "interrupt.h"
#include "message.h"
#include "upgrade_compare.h"
#include "value.h"

#include "glint/glint.h"

#include <stdio.h>
#include <string.h>

typedef struct Options {
    const char *output; /* null: standard output */
    GlintDialect dialect;
    bool check, compare, verbose;
} Options;

static CliStatus set_to(void *values, const char *value) {
    (void)values;
    if (strcmp(value, glint_dialect_name(GLINT_DIALECT_GLINT)) == 0) return CLI_OK;
    return cli_message_usage(
        "--to takes glint, the only rules that are not a year's, not '%s'", value);
}

static CliStatus set_output(void *values, const char *value) {
    ((Options *)values)->output = value;
    return value[0] != '\0' ? CLI_OK : cli_message_usage("--output takes the name of a file");
}

static CliStatus set_dialect(void *values, const char *value) {
    return cli_value_dialect(value, &((Options *)values)->dialect);
}

static CliStatus set_check(void *values, const char *value) {
    (void)value;
    ((Options *)values)->check = true;
    return CLI_OK;
}

static CliStatus set_compare(void *values, const char *value) {
    (void)value;
    ((Options *)values)->compare = true;
    return CLI_OK;
}

static CliStatus set_verbose(void *values, const char *value) {
    (void)value;
    ((Options *)values)->verbose = true;
    return CLI_OK;
}

/* ---------------------------------------------------------------- changes */

typedef struct Changes {
    const char *name;
    bool verbose;
    int counts[3]; /* by GlintChangeKind */
} Changes;

/* "a.xml:12:3: different: ..." */
static void on_change(void *user, const GlintChange *change) {
    static const char *const words[] = {"same", "rounding", "different"};
    Changes *changes = user;
    changes->counts[change->kind]++;
    if (change->kind == GLINT_CHANGE_SAME && !changes->verbose) return;
    fprintf(stderr, "%s:%lld:%lld: %s: %s\n", changes->name, (long long)change->line,
        (long long)change->column, words[change->kind], change->message);
}

static void sum_up(const Changes *changes, GlintDialect dialect) {
    int same = changes->counts[GLINT_CHANGE_SAME], rounded = changes->counts[GLINT_CHANGE_ROUNDING];
    int different = changes->counts[GLINT_CHANGE_DIFFERENT];
    fprintf(stderr, "%s: from the rules of %s; ", changes->name, glint_dialect_name(dialect));
    if (different > 0) {
        fprintf(
            stderr, "the picture may differ in %d %s", different, different == 1 ? "way" : "ways");
    } else if (rounded > 0) {
        fputs("the picture is the same up to rounding", stderr);
    } else {
        fputs("the picture is the same to the last bit", stderr);
    }
    fprintf(stderr, " (%d %s)\n", same + rounded + different,
        same + rounded + different == 1 ? "change" : "changes");
}

/* ---------------------------------------------------------------- one scene */

static CliStatus save(const Options *options, const CliContent *text) {
    if (options->output == NULL || strcmp(options->output, "-") == 0) {
        fwrite(text->data, 1, text->size, stdout);
        return cli_message_flush_output();
    }
    GlintError error;
    if (glint_file_save(options->output, text->data, text->size, &error) == GLINT_OK) return CLI_OK;
    cli_message_error("cannot write '%s': %s", options->output, error.message);
    return CLI_MACHINE;
}

static CliStatus upgrade(const Options *options, const CliJob *job) {
    CliContent old, new = {0};
    CliStatus status = cli_content_load(&old, job);
    if (status == CLI_OK && !cli_interrupt_seen()) {
        Changes changes = {.name = cli_job_name(job), .verbose = options->verbose};
        CliFindings findings = {0};
        GlintUpgradeDesc desc = glint_upgrade_desc_default();
        desc.dialect = options->dialect;
        desc.change = on_change;
        desc.change_user = &changes;
        desc.diagnostic = cli_message_finding;
        desc.diagnostic_user = &findings;
        GlintError error;
        GlintDialect dialect = GLINT_DIALECT_AUTO;
        GlintStatus result = glint_upgrade(old.data, old.size, cli_job_name(job), &desc,
            cli_content_append, &new, &dialect, &error);
        if (result == GLINT_OK) {
            sum_up(&changes, dialect);
            bool differs = changes.counts[GLINT_CHANGE_DIFFERENT] > 0;
            status = !options->check ? save(options, &new) : differs ? CLI_INPUT : CLI_OK;
            if (options->compare) {
                status = cli_status_worse(status, cli_compare_scenes(job, &old, dialect, &new));
            }
        } else {
            status = cli_message_failure(cli_job_name(job), &findings, &error);
        }
    }
    cli_content_reset(&old);
    cli_content_reset(&new);
    return status;
}

static CliStatus run(void *values, const CliOperands *operands) {
    const Options *options = values;
    CliJobs jobs;
    CliStatus status = cli_jobs_init_plain(&jobs, operands);
    if (status == CLI_OK && jobs.count > 1 && !options->check) {
        status = cli_message_usage("one scene at a time can be upgraded; --check takes any number");
    }
    for (int i = 0; status < CLI_USAGE && i < jobs.count && !cli_interrupt_seen(); i++) {
        status = cli_status_worse(status, upgrade(options, &jobs.items[i]));
    }
    cli_jobs_reset(&jobs);
    return status;
}

static const char scene[] = "The scene", messages[] = "Messages";

static const CliOption options[] = {
    {'o', "output", "FILE", CLI_FORM_REQUIRED, scene, "write to FILE (default: standard output)",
        set_output},
    {0, "to", "glint", CLI_FORM_REQUIRED, scene, "the new rules; there are no others", set_to},
    {0, "dialect", "NAME", CLI_FORM_REQUIRED, scene,
        "the year of the scene, where it does not show", set_dialect},
    {0, "check", NULL, CLI_FORM_NONE, messages, "write nothing; exit with 1 if pictures may differ",
        set_check},
    {0, "compare", NULL, CLI_FORM_NONE, messages, "draw both, small, and tell how much they differ",
        set_compare},
    {'v', "verbose", NULL, CLI_FORM_NONE, messages,
        "tell also of changes that leave the picture the same", set_verbose},
};

static Options defaults = {.dialect = GLINT_DIALECT_AUTO};

const CliVerb cli_verb_upgrade = {.name = "upgrade",
    .operands = "SCENE",
    .summary = "rewrite an old scene by today's rules",
    .about = "Rewrites a scene of a year of the course by the rules of glint, so that it\n"
             "draws the same picture. Where those rules do not allow it, standard error tells\n"
             "what may differ, with the line and the reason. Comments and layout stay.",
    .example_text = "a new file, and what is not the same in it",
    .example = "glint upgrade -o new.xml old.xml",
    .options = options,
    .option_count = CLI_COUNT(options),
    .values = &defaults,
    .run = run};
