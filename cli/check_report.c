/* SPDX-License-Identifier: MIT
 * Findings are written as they come; nothing is kept.
 *
 * SARIF: Static Analysis Results Interchange Format, version 2.1.0, OASIS 2020. */
#include "check_report.h"

#include "json.h"
#include "message.h"

#include <stdio.h>
#include <string.h>

int cli_check_rule_index(const char *name) {
    int scene = 0;
    GlintRule rule;
    for (int i = 0; glint_rule_at(i, &rule); i++) {
        if (name != NULL && strcmp(rule.name, name) == 0) return i;
        if (strcmp(rule.name, "scene") == 0) scene = i;
    }
    return scene;
}

/* The name of a finding's rule, and its index. */
static const char *rule_of(const GlintDiagnostic *diagnostic, int *index) {
    GlintRule rule = {.name = "scene"};
    *index = cli_check_rule_index(diagnostic->rule);
    glint_rule_at(*index, &rule);
    return rule.name;
}

static const char *severity_name(GlintSeverity severity) {
    static const char *const names[] = {[GLINT_SEVERITY_ERROR] = "error",
        [GLINT_SEVERITY_WARNING] = "warning",
        [GLINT_SEVERITY_NOTE] = "note"};
    return names[severity];
}

void cli_check_list_rules(void) {
    GlintRule rule;
    for (int i = 0; glint_rule_at(i, &rule); i++) {
        printf("%-8s %-28s %s\n", severity_name(rule.severity), rule.name, rule.summary);
    }
}

/* ---------------------------------------------------------------- JSON */

static void print_member(const char *key, const char *text) {
    printf("\"%s\": ", key);
    cli_json_print_text(text);
}

static void begin_json(void) { printf("{\"findings\": ["); }

static void add_json(const CliCheckReport *report, const GlintDiagnostic *diagnostic) {
    printf("%s\n  {", report->written > 0 ? "," : "");
    int index;
    print_member("rule", rule_of(diagnostic, &index));
    printf(", ");
    print_member("severity", severity_name(diagnostic->severity));
    printf(", ");
    print_member("path", diagnostic->path);
    if (diagnostic->line > 0) {
        printf(", \"line\": %lld, \"column\": %lld, \"length\": %d", (long long)diagnostic->line,
            (long long)diagnostic->column, diagnostic->caret_length);
    }
    printf(", ");
    print_member("message", diagnostic->message);
    if (diagnostic->hint != NULL) {
        printf(", ");
        print_member("hint", diagnostic->hint);
    }
    printf("}");
}

static void end_json(const CliCheckReport *report) {
    printf("%s], \"scenes\": %d, \"errors\": %d, \"warnings\": %d, \"notes\": %d}\n",
        report->written > 0 ? "\n" : "", report->scene_count, report->error_count,
        report->warning_count, report->note_count);
}

/* ---------------------------------------------------------------- SARIF */

static void print_text_object(const char *key, const char *text) {
    printf("\"%s\": {", key);
    print_member("text", text);
    printf("}");
}

static void begin_sarif(void) {
    printf("{\n"
           "  \"$schema\": \"https://json.schemastore.org/sarif-2.1.0.json\",\n"
           "  \"version\": \"2.1.0\",\n"
           "  \"runs\": [{\n"
           "    \"columnKind\": \"unicodeCodePoints\",\n"
           "    \"tool\": {\"driver\": {\"name\": \"glint\", \"version\": \"%s\", \"rules\": [",
        glint_version_text());
    GlintRule rule;
    for (int i = 0; glint_rule_at(i, &rule); i++) {
        printf("%s\n      {", i > 0 ? "," : "");
        print_member("id", rule.name);
        printf(", ");
        print_text_object("shortDescription", rule.summary);
        printf(",\n        ");
        print_text_object("help", rule.help);
        printf(",\n        \"defaultConfiguration\": {\"level\": \"%s\"}}",
            severity_name(rule.severity));
    }
    printf("]}},\n    \"results\": [");
}

/* A path as a URI: what cannot stand in one is written as its bytes (RFC 3986). */
static void print_uri(const char *path) {
    putchar('"');
    for (const unsigned char *byte = (const unsigned char *)path; *byte != '\0'; byte++) {
        bool letter = (*byte | 32) >= 'a' && (*byte | 32) <= 'z';
        bool digit = *byte >= '0' && *byte <= '9';
        if (letter || digit || strchr("-._~/", *byte) != NULL) {
            putchar(*byte);
        } else {
            printf("%%%02X", *byte);
        }
    }
    putchar('"');
}

static void add_sarif(const CliCheckReport *report, const GlintDiagnostic *diagnostic) {
    int index;
    const char *rule = rule_of(diagnostic, &index);
    char text[2048];
    snprintf(text, sizeof text, "%s%s%s", diagnostic->message, diagnostic->hint != NULL ? "; " : "",
        diagnostic->hint != NULL ? diagnostic->hint : "");
    printf("%s\n      {", report->written > 0 ? "," : "");
    print_member("ruleId", rule);
    printf(", \"ruleIndex\": %d, \"level\": \"%s\",\n       ", index,
        severity_name(diagnostic->severity));
    print_text_object("message", text);
    printf(",\n       \"locations\": [{\"physicalLocation\": {\"artifactLocation\": {\"uri\": ");
    print_uri(diagnostic->path);
    printf("}");
    if (diagnostic->line > 0) {
        long long line = (long long)diagnostic->line, column = (long long)diagnostic->column;
        printf(", \"region\": {\"startLine\": %lld, \"startColumn\": %lld, \"endColumn\": %lld}",
            line, column, column + diagnostic->caret_length);
    }
    printf("}}]}");
}

static void end_sarif(const CliCheckReport *report) {
    printf("%s]\n  }]\n}\n", report->written > 0 ? "\n    " : "");
}

/* ---------------------------------------------------------------- text */

static void print_count(int count, const char *noun) {
    fprintf(stderr, "%d %s%s", count, noun, count == 1 ? "" : "s");
}

static void end_text(const CliCheckReport *report) {
    if (report->quiet) return;
    print_count(report->scene_count, "scene");
    fputs(": ", stderr);
    print_count(report->error_count, "error");
    fputs(", ", stderr);
    print_count(report->warning_count, "warning");
    if (report->notes) {
        fputs(", ", stderr);
        print_count(report->note_count, "note");
    }
    fputc('\n', stderr);
}

/* ---------------------------------------------------------------- the whole */

void cli_check_report_begin(CliCheckReport *report) {
    if (report->format == CLI_CHECK_JSON) begin_json();
    if (report->format == CLI_CHECK_SARIF) begin_sarif();
}

void cli_check_report_add(CliCheckReport *report, const GlintDiagnostic *diagnostic) {
    bool error = diagnostic->severity == GLINT_SEVERITY_ERROR;
    bool note = diagnostic->severity == GLINT_SEVERITY_NOTE;
    if (note && !report->notes) return;
    if (!error && report->allowed >> cli_check_rule_index(diagnostic->rule) & 1) return;
    switch (report->format) {
    case CLI_CHECK_TEXT: cli_message_diagnostic(diagnostic); break;
    case CLI_CHECK_JSON: add_json(report, diagnostic); break;
    case CLI_CHECK_SARIF: add_sarif(report, diagnostic); break;
    }
    report->written++;
    report->error_count += error;
    report->note_count += note;
    report->warning_count += !error && !note;
}

void cli_check_report_end(const CliCheckReport *report) {
    switch (report->format) {
    case CLI_CHECK_TEXT: end_text(report); break;
    case CLI_CHECK_JSON: end_json(report); break;
    case CLI_CHECK_SARIF: end_sarif(report); break;
    }
}
