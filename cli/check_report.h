/* SPDX-License-Identifier: MIT
 * What `glint check` has found, in words for people, or as JSON or SARIF for programs. */
#pragma once

#include "glint/glint.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum CliCheckFormat { CLI_CHECK_TEXT, CLI_CHECK_JSON, CLI_CHECK_SARIF } CliCheckFormat;

typedef struct CliCheckReport {
    CliCheckFormat format;
    bool notes;       /* are told too */
    bool quiet;       /* no closing line */
    uint64_t allowed; /* a bit for each rule that is not told */
    int scene_count, error_count, warning_count, note_count;
    int written; /* findings, all together */
} CliCheckReport;

/* The index of a rule by its name; that of "scene" when there is none. */
int cli_check_rule_index(const char *name);

void cli_check_report_begin(CliCheckReport *report);

/* Tells and counts a finding, unless its rule is allowed or it is a note that nobody wants. */
void cli_check_report_add(CliCheckReport *report, const GlintDiagnostic *diagnostic);

void cli_check_report_end(const CliCheckReport *report);

/* Every rule, one a line. */
void cli_check_list_rules(void);
