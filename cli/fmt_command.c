/* SPDX-License-Identifier: MIT
 * glint fmt: scenes in their canonical layout. A file is written only when it changes. */
#include "content.h"
#include "diff.h"
#include "interrupt.h"
#include "message.h"

#include "glint/glint.h"

#include <stdio.h>

typedef struct Options {
    bool check, diff;
} Options;

static CliStatus set_check(void *values, const char *value) {
    (void)value;
    ((Options *)values)->check = true;
    return CLI_OK;
}

static CliStatus set_diff(void *values, const char *value) {
    (void)value;
    ((Options *)values)->diff = true;
    return CLI_OK;
}

/* ---------------------------------------------------------------- one scene */

static CliStatus save(const CliJob *job, const CliContent *text) {
    if (cli_job_reads_standard_input(job)) {
        fwrite(text->data, 1, text->size, stdout);
        return CLI_OK;
    }
    GlintError error;
    if (glint_file_save(job->scene, text->data, text->size, &error) == GLINT_OK) {
        puts(job->scene);
        return CLI_OK;
    }
    cli_message_error("cannot write '%s': %s", job->scene, error.message);
    return CLI_MACHINE;
}

/* What to do about a scene and its layout: show it, tell of it, or write it. */
static CliStatus answer(
    const Options *options, const CliJob *job, const CliContent *old, const CliContent *new) {
    bool changes = !cli_content_equal(old, new);
    CliStatus status = CLI_OK;
    if (options->diff) status = cli_diff_print(cli_job_name(job), old, new);
    if (options->check && changes) {
        if (!options->diff) puts(cli_job_name(job));
        status = cli_status_worse(status, CLI_INPUT);
    }
    if (options->check || options->diff) return status;
    return changes || cli_job_reads_standard_input(job) ? save(job, new) : CLI_OK;
}

static CliStatus format(const Options *options, const CliJob *job) {
    CliContent old, new = {0};
    CliStatus status = cli_content_load(&old, job);
    if (status == CLI_OK && !cli_interrupt_seen()) {
        CliFindings findings = {0};
        GlintFormatDesc desc = glint_format_desc_default();
        desc.diagnostic = cli_message_finding;
        desc.diagnostic_user = &findings;
        GlintError error;
        GlintStatus result = glint_format(
            old.data, old.size, cli_job_name(job), &desc, cli_content_append, &new, &error);
        status = result == GLINT_OK ? answer(options, job, &old, &new)
                                    : cli_message_failure(cli_job_name(job), &findings, &error);
    }
    cli_content_reset(&old);
    cli_content_reset(&new);
    return status;
}

static CliStatus run(void *values, const CliOperands *operands) {
    CliJobs jobs;
    CliStatus status = cli_jobs_init_plain(&jobs, operands);
    for (int i = 0; status < CLI_USAGE && i < jobs.count && !cli_interrupt_seen(); i++) {
        status = cli_status_worse(status, format(values, &jobs.items[i]));
    }
    cli_jobs_reset(&jobs);
    return cli_status_worse(status, cli_message_flush_output());
}

static const char layout[] = "The layout";

static const CliOption options[] = {
    {0, "check", NULL, CLI_FORM_NONE, layout, "write nothing; name what would change, exit with 1",
        set_check},
    {0, "diff", NULL, CLI_FORM_NONE, layout, "write nothing; show what would change", set_diff},
};

static Options defaults;

const CliVerb cli_verb_fmt = {.name = "fmt",
    .operands = "SCENE...",
    .summary = "lay scenes out in one style",
    .about = "Lays scenes out: a child a line, two blanks deeper than its parent. What a\n"
             "scene means, its comments and its numbers stay as they are. A file that\n"
             "changes is replaced and named; one with errors is left alone. A SCENE is an\n"
             "XML file, a folder (all *.xml in it), or - for standard input, which goes to\n"
             "standard output.",
    .example_text = "see what would change, then change it",
    .example = "glint fmt --diff scenes/solids.xml && glint fmt scenes/solids.xml",
    .options = options,
    .option_count = CLI_COUNT(options),
    .values = &defaults,
    .run = run};
