/* SPDX-License-Identifier: MIT
 * glint check: all errors and warnings of scenes, without a picture. */
#include "check_report.h"
#include "interrupt.h"
#include "message.h"
#include "scene_file.h"
#include "value.h"

#include <stdio.h>
#include <string.h>

typedef struct CheckOptions {
    CliCheckReport report;
    GlintDialect dialect;
    int thread_count;
    bool strict, list_rules;
} CheckOptions;

/* ---------------------------------------------------------------- options */

static const char *format_name_at(int index) {
    static const char *const names[] = {"text", "json", "sarif", NULL};
    return names[index];
}

static CliStatus set_format(void *values, const char *value) {
    CheckOptions *options = values;
    int index = 0;
    CliStatus status = cli_value_name("format", value, format_name_at, &index);
    if (status == CLI_OK) options->report.format = (CliCheckFormat)index;
    return status;
}

static const char *rule_name_at(int index) {
    GlintRule rule;
    return glint_rule_at(index, &rule) ? rule.name : NULL;
}

static CliStatus set_allow(void *values, const char *value) {
    CheckOptions *options = values;
    for (const char *name = value;; name++) {
        char word[64];
        size_t size = strcspn(name, ",");
        int index = 0;
        GlintRule rule;
        snprintf(word, sizeof word, "%.*s", (int)size, name);
        CliStatus status = cli_value_name("allow", word, rule_name_at, &index);
        if (status != CLI_OK) return status;
        if (glint_rule_at(index, &rule) && rule.severity == GLINT_SEVERITY_ERROR) {
            return cli_message_usage("--allow takes warnings; '%s' is an error", word);
        }
        options->report.allowed |= UINT64_C(1) << index;
        name += size;
        if (*name == '\0') return CLI_OK;
    }
}

static CliStatus set_strict(void *values, const char *value) {
    CheckOptions *options = values;
    (void)value;
    options->strict = true;
    return CLI_OK;
}

static CliStatus set_notes(void *values, const char *value) {
    CheckOptions *options = values;
    (void)value;
    options->report.notes = true;
    return CLI_OK;
}

static CliStatus set_list_rules(void *values, const char *value) {
    CheckOptions *options = values;
    (void)value;
    options->list_rules = true;
    return CLI_OK;
}

static CliStatus set_dialect(void *values, const char *value) {
    CheckOptions *options = values;
    return cli_value_dialect(value, &options->dialect);
}

static CliStatus set_threads(void *values, const char *value) {
    CheckOptions *options = values;
    return cli_value_threads(value, &options->thread_count);
}

static CliStatus set_quiet(void *values, const char *value) {
    CheckOptions *options = values;
    (void)value;
    options->report.quiet = true;
    return CLI_OK;
}

static const char findings[] = "The findings", machine[] = "The machine", messages[] = "Messages";

static const CliOption option_table[] = {
    {0, "strict", NULL, CLI_FORM_NONE, findings, "end with status 1 for warnings too", set_strict},
    {0, "allow", "RULE", CLI_FORM_REQUIRED, findings, "say nothing of a rule (or of several: A,B)",
        set_allow},
    {0, "notes", NULL, CLI_FORM_NONE, findings, "tell also what may well be meant", set_notes},
    {0, "list-rules", NULL, CLI_FORM_NONE, findings, "list what is looked for", set_list_rules},
    {0, "format", "text|json|sarif", CLI_FORM_REQUIRED, findings,
        "how to tell; json and sarif on standard output", set_format},
    {0, "dialect", "NAME", CLI_FORM_REQUIRED, findings, "follow the rules of a year (see below)",
        set_dialect},
    {'t', "threads", "N", CLI_FORM_REQUIRED, machine, "use N threads (default: one a core)",
        set_threads},
    {'q', "quiet", NULL, CLI_FORM_NONE, messages, "no progress, and no closing line", set_quiet},
};

/* ---------------------------------------------------------------- scenes */

static void on_finding(void *user, const GlintDiagnostic *diagnostic) {
    cli_check_report_add(user, diagnostic);
}

static CliStatus check_scene(CheckOptions *options, CliSceneFile *file) {
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.dialect = options->dialect;
    desc.thread_count = options->thread_count;
    desc.keep_sources = true;
    file->diagnostic = on_finding;
    file->diagnostic_user = &options->report;
    CliStatus status = cli_scene_file_load(file, &desc);
    if (status == CLI_OK) status = cli_scene_file_commit(file);
    if (status != CLI_OK || cli_interrupt_seen()) return status;
    GlintStatus checked = glint_scene_check(file->scene, &file->monitor, &file->error);
    return checked == GLINT_OK ? CLI_OK : cli_scene_file_fail(file, checked, CLI_INPUT);
}

static CliStatus run(void *values, const CliOperands *operands) {
    CheckOptions *options = values;
    CliCheckReport *report = &options->report;
    if (options->list_rules) {
        cli_check_list_rules();
        return cli_message_flush_output();
    }
    CliJobs jobs;
    CliStatus status = cli_jobs_init_plain(&jobs, operands);
    bool progress = !report->quiet && cli_message_on_terminal();
    if (status < CLI_USAGE) {
        cli_check_report_begin(report);
        for (int i = 0; i < jobs.count && !cli_interrupt_seen(); i++) {
            CliSceneFile file;
            cli_scene_file_begin(&file, &jobs.items[i], i, jobs.count, progress);
            status = cli_status_worse(status, check_scene(options, &file));
            report->scene_count++;
            cli_scene_file_end(&file);
        }
        if (!cli_interrupt_seen()) cli_check_report_end(report);
        status = cli_status_worse(status, cli_message_flush_output());
    }
    cli_jobs_reset(&jobs);
    bool refused = options->strict && report->warning_count > 0;
    return refused ? cli_status_worse(status, CLI_INPUT) : status;
}

static CheckOptions defaults = {.dialect = GLINT_DIALECT_AUTO};

const CliVerb cli_verb_check = {.name = "check",
    .operands = "SCENE...",
    .summary = "tell errors and likely mistakes of scenes",
    .about = "Reads scenes and tells all errors, and what is allowed but surely a mistake: a\n"
             "light inside a solid, a camera that sees nothing, a window of another shape\n"
             "than the picture. A SCENE is an XML file, a folder (all *.xml in it), or - for\n"
             "standard input. Errors end with status 1, warnings only with --strict.",
    .notes = NULL,
    .example_text = "check a folder before handing it in",
    .example = "glint check --strict scenes",
    .options = option_table,
    .option_count = CLI_COUNT(option_table),
    .values = &defaults,
    .run = run};
