/* SPDX-License-Identifier: MIT
 * Runs the rules and hands out what they found. */
#include "check/inside.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const GlintRule rules[] = {
#define RULE_ROW(id, name, severity, summary, help)                                                \
    {name, GLINT_SEVERITY_##severity, summary, help},
    GI_RULE_LIST(RULE_ROW)
#undef RULE_ROW
};

bool glint_rule_at(int index, GlintRule *rule) {
    if (index < 0 || index >= GI_CHECK_COUNT) return false;
    *rule = rules[index];
    return true;
}

/* ---------------------------------------------------------------- findings */

void gi_check_add(GiCheck *check, GiRule rule, int64_t offset, const char *format, ...) {
    if (check->counts[rule]++ >= GI_CHECK_LIMIT) return;
    size_t number = check->findings.count;
    if (!gi_array_reserve(check->memory, &check->findings, 1)) {
        check->status = GLINT_ERROR_MEMORY;
        return;
    }
    GiCheckFinding *finding = &check->findings.data[check->findings.count++];
    *finding = (GiCheckFinding){.rule = rule, .offset = offset, .number = number};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(finding->message, sizeof finding->message, format, arguments);
    va_end(arguments);
}

int64_t gi_check_place(const GiCheck *check, GlintObjectKind kind, uint32_t index1) {
    return gi_sources_offset(check->input->sources, kind, index1);
}

const char *gi_check_name(
    const GiCheck *check, GlintObjectKind kind, uint32_t index1, char buffer[GI_CHECK_NAME]) {
    GlintSource source;
    if (gi_sources_find(check->input->sources, kind, index1, &source)) {
        snprintf(buffer, GI_CHECK_NAME, "of line %lld", (long long)source.line);
    } else {
        snprintf(buffer, GI_CHECK_NAME, "number %u", index1);
    }
    return buffer;
}

bool gi_check_stopped(GiCheck *check) {
    const GlintMonitor *monitor = check->input->monitor;
    if (check->status != GLINT_OK) return true;
    if (monitor != NULL && monitor->cancelled != NULL && monitor->cancelled(monitor->user)) {
        check->status = GLINT_CANCELLED;
    }
    return check->status != GLINT_OK;
}

/* ---------------------------------------------------------------- handing out */

static int compare_findings(const void *a, const void *b) {
    const GiCheckFinding *left = a, *right = b;
    if (left->offset != right->offset) return left->offset < right->offset ? -1 : 1;
    if (left->rule != right->rule) return left->rule < right->rule ? -1 : 1;
    return left->number < right->number ? -1 : 1;
}

static void emit(const GiCheck *check, GiCheckFinding *finding) {
    const GiCheckInput *input = check->input;
    GiSources *sources = input->sources;
    char excerpt[GI_EXCERPT_SIZE];
    GlintDiagnostic diagnostic = {.severity = rules[finding->rule].severity,
        .path = sources->path.data != NULL ? sources->path.data : "",
        .message = finding->message,
        .caret_length = 1,
        .rule = rules[finding->rule].name};
    char *hint = strchr(finding->message, '\n');
    if (hint != NULL) {
        *hint = '\0';
        diagnostic.hint = hint + 1;
    }
    if (finding->offset >= 0) gi_sources_point_at(sources, finding->offset, excerpt, &diagnostic);
    input->diagnostic(input->diagnostic_user, &diagnostic);
}

static void hand_out(GiCheck *check) {
    size_t count = check->findings.count;
    if (check->input->diagnostic == NULL || count == 0) return;
    qsort(check->findings.data, count, sizeof *check->findings.data, compare_findings);
    for (size_t i = 0; i < count; i++) emit(check, &check->findings.data[i]);
    for (int rule = 0; rule < GI_CHECK_COUNT; rule++) {
        if (check->counts[rule] <= GI_CHECK_LIMIT) continue;
        size_t more = check->counts[rule] - GI_CHECK_LIMIT;
        GiCheckFinding rest = {.rule = (GiRule)rule, .offset = -1};
        snprintf(rest.message, sizeof rest.message, "%zu more of the kind in this file", more);
        emit(check, &rest);
    }
}

/* ---------------------------------------------------------------- the whole */

/* Shaders of surfaces, and what lies under the glaze of these. A substrate comes before the shader
 * that has it, so that one way back finds all. */
static bool find_used_shaders(GiCheck *check) {
    const GiScene *scene = check->scene;
    size_t count = scene->shaders.count;
    check->shader_used = gi_memory_allocate(check->memory, count * sizeof *check->shader_used);
    if (check->shader_used == NULL) return false;
    memset(check->shader_used, 0, count * sizeof *check->shader_used);
    for (int kind = 0; kind < GI_SHAPE_RECTANGLE; kind++) {
        for (size_t i = 0; i < scene->info[kind].count; i++) {
            check->shader_used[scene->info[kind].data[i].shader] = true;
        }
    }
    for (size_t i = 0; i < scene->mesh_surfaces.count; i++) {
        check->shader_used[scene->mesh_surfaces.data[i].info.shader] = true;
    }
    for (size_t i = count; i-- > 0;) {
        uint32_t substrate = scene->shaders.data[i].substrate;
        if (check->shader_used[i] && substrate != GI_NONE) check->shader_used[substrate] = true;
    }
    return true;
}

static void run_rules(GiCheck *check) {
    static void (*const groups[])(GiCheck * check) = {gi_check_view, gi_check_lights,
        gi_check_shaders, gi_check_surfaces, gi_check_meshes, gi_check_dialect};
    enum { SURVEY_SIDE = 128 };
    if (!find_used_shaders(check) || !gi_census(check, check->world->trace.tree, &check->census)) {
        check->status = GLINT_ERROR_MEMORY;
        return;
    }
    if (!gi_survey_draw(check, SURVEY_SIDE, 0, &check->survey)) return;
    for (size_t i = 0; i < sizeof groups / sizeof *groups && !gi_check_stopped(check); i++) {
        groups[i](check);
    }
}

GlintStatus gi_check(const GiCheckInput *input, GlintError *error) {
    const GiScene *scene = input->world->scene;
    GiCheck check = {
        .input = input, .world = input->world, .scene = scene, .memory = scene->memory};
    check.root = input->sources->path.data != NULL ? input->sources->root : -1;
    run_rules(&check);
    if (check.status == GLINT_OK) hand_out(&check);
    gi_array_free(check.memory, &check.findings);
    gi_array_free(check.memory, &check.census);
    gi_survey_free(&check, &check.survey);
    gi_memory_free(
        check.memory, check.shader_used, scene->shaders.count * sizeof *check.shader_used);
    if (check.status == GLINT_OK) return GLINT_OK;
    return gi_error_set(error, check.status, "%s", glint_status_text(check.status));
}
