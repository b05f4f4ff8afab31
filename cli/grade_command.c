/* SPDX-License-Identifier: MIT
 * One picture against what it should be. As with diff, 1 says that they differ, and 2 that they
 * could not be compared. */
#include "grade_report.h"
#include "interrupt.h"
#include "message.h"
#include "progress.h"
#include "value.h"
#include "verb.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct GradeOptions {
    const char *difference; /* null: not wanted */
    bool json, quiet, single;
    double max_percent;
    int tolerance, width, height, samples;
    GlintDialect dialect;
    int thread_count;
    const char *isa;
} GradeOptions;

/* ---------------------------------------------------------------- options */

static CliStatus set_diff(void *values, const char *value) {
    GradeOptions *options = values;
    GlintError error;
    options->difference = value;
    if (glint_image_check_path(value, &error) == GLINT_OK) return CLI_OK;
    return cli_message_usage("--diff '%s': %s", value, error.message);
}

static const char *format_name_at(int index) {
    static const char *const names[] = {"text", "json", NULL};
    return names[index];
}

static CliStatus set_format(void *values, const char *value) {
    GradeOptions *options = values;
    int index = 0;
    CliStatus status = cli_value_name("format", value, format_name_at, &index);
    options->json = index == 1;
    return status;
}

static CliStatus set_max_pct(void *values, const char *value) {
    GradeOptions *options = values;
    char *end;
    options->max_percent = strtod(value, &end);
    bool good =
        end != value && *end == '\0' && options->max_percent >= 0 && options->max_percent <= 100;
    return good ? CLI_OK
                : cli_message_usage("--max-pct takes a number from 0 to 100, not '%s'", value);
}

static CliStatus set_tolerance(void *values, const char *value) {
    GradeOptions *options = values;
    return cli_value_number("tolerance", value, 0, 255, &options->tolerance);
}

static CliStatus set_size(void *values, const char *value) {
    GradeOptions *options = values;
    return cli_value_size("size", value, &options->width, &options->height);
}

static CliStatus set_samples(void *values, const char *value) {
    enum { SAMPLES_LIMIT = 65536 };
    GradeOptions *options = values;
    return cli_value_number("samples", value, 1, SAMPLES_LIMIT, &options->samples);
}

static CliStatus set_single(void *values, const char *value) {
    GradeOptions *options = values;
    (void)value;
    options->single = true;
    return CLI_OK;
}

static CliStatus set_dialect(void *values, const char *value) {
    GradeOptions *options = values;
    return cli_value_dialect(value, &options->dialect);
}

static CliStatus set_threads(void *values, const char *value) {
    GradeOptions *options = values;
    return cli_value_threads(value, &options->thread_count);
}

static CliStatus set_isa(void *values, const char *value) {
    GradeOptions *options = values;
    return cli_value_isa(value, &options->isa);
}

static CliStatus set_quiet(void *values, const char *value) {
    GradeOptions *options = values;
    (void)value;
    options->quiet = true;
    return CLI_OK;
}

static const char comparing[] = "Comparing", asked[] = "What was asked for",
                  machine[] = "The machine", messages[] = "Messages";

static const CliOption option_table[] = {
    {0, "max-pct", "P", CLI_FORM_REQUIRED, comparing,
        "pass when at most P % of the pixels differ (1)", set_max_pct},
    {0, "tolerance", "T", CLI_FORM_REQUIRED, comparing,
        "a pixel differs when a value is off by more (2)", set_tolerance},
    {0, "single", NULL, CLI_FORM_NONE, comparing, "try one mistake at a time, no pairs",
        set_single},
    {0, "diff", "FILE", CLI_FORM_REQUIRED, comparing, "write a picture of the differences, times 8",
        set_diff},
    {0, "size", "WxH", CLI_FORM_REQUIRED, asked, "the size, where it is not the scene's", set_size},
    {0, "samples", "N", CLI_FORM_REQUIRED, asked, "the samples a pixel, likewise", set_samples},
    {0, "dialect", "NAME", CLI_FORM_REQUIRED, asked, "the year whose rules the scene follows",
        set_dialect},
    {'t', "threads", "N", CLI_FORM_REQUIRED, machine, "draw with N threads (default: one a core)",
        set_threads},
    {0, "isa", "NAME", CLI_FORM_REQUIRED, machine, "use this instruction set, not the fastest",
        set_isa},
    {0, "format", "text|json", CLI_FORM_REQUIRED, messages, "for people, or for programs",
        set_format},
    {'q', "quiet", NULL, CLI_FORM_NONE, messages, "no progress, and nothing about what passed",
        set_quiet},
};

/* ---------------------------------------------------------------- grading */

typedef struct Grading {
    const GradeOptions *options;
    const char *picture, *reference;
    CliProgress progress;
    bool told; /* findings in the scene have been shown */
} Grading;

static void on_progress(void *user, GlintPhase phase, double fraction) {
    Grading *grading = user;
    cli_progress_update(&grading->progress, phase, fraction);
}

static bool on_cancelled(void *user) {
    (void)user;
    return cli_interrupt_seen();
}

static void on_diagnostic(void *user, const GlintDiagnostic *diagnostic) {
    Grading *grading = user;
    cli_progress_clear(&grading->progress);
    cli_message_diagnostic(diagnostic);
    grading->told |= diagnostic->severity == GLINT_SEVERITY_ERROR;
}

/* What could not be compared is neither right nor wrong. */
static CliStatus fail(Grading *grading, GlintStatus status, const GlintError *error) {
    cli_progress_clear(&grading->progress);
    if (status == GLINT_CANCELLED || cli_interrupt_seen()) return CLI_OK;
    if (!grading->told) {
        const char *text = error->message[0] != '\0' ? error->message : glint_status_text(status);
        if (error->path[0] != '\0') {
            cli_message_error("%s: %s", error->path, text);
        } else {
            cli_message_error("%s", text);
        }
    }
    return status == GLINT_ERROR_MEMORY || status == GLINT_ERROR_THREAD ? CLI_MACHINE : CLI_USAGE;
}

static GlintStatus save_difference(
    const Grading *grading, const float *difference, const GlintGrade *grade, GlintError *error) {
    const GlintImage image = {grade->reference.width, grade->reference.height, difference};
    GlintSaveDesc desc = glint_save_desc_default();
    desc.title = grading->picture;
    desc.thread_count = grading->options->thread_count;
    return glint_image_save(&image, grading->options->difference, &desc, error);
}

static CliStatus report(const Grading *grading, const GlintGrade *grade) {
    const GradeOptions *options = grading->options;
    CliGradeReport shown = {.picture = grading->picture,
        .reference = grading->reference,
        .grade = grade,
        .max_percent = options->max_percent,
        .tolerance = options->tolerance};
    shown.passed = !grade->size_differs && grade->comparison.percent <= options->max_percent;
    if (options->json) {
        cli_grade_print_json(&shown);
    } else if (!options->quiet || !shown.passed) {
        cli_grade_print_text(&shown);
    }
    return cli_status_worse(shown.passed ? CLI_OK : CLI_INPUT, cli_message_flush_output());
}

static GlintGradeDesc grade_desc(Grading *grading, const GlintMonitor *monitor) {
    const GradeOptions *options = grading->options;
    GlintGradeDesc desc = glint_grade_desc_default();
    desc.scene.dialect = options->dialect;
    desc.scene.thread_count = options->thread_count;
    desc.scene.isa = options->isa;
    desc.scene.diagnostic = on_diagnostic;
    desc.scene.diagnostic_user = grading;
    desc.compare.tolerance = options->tolerance;
    desc.width = options->width;
    desc.height = options->height;
    desc.samples = options->samples;
    desc.pairs = !options->single;
    desc.monitor = monitor;
    return desc;
}

static CliStatus grade(Grading *grading) {
    GlintError error = {.status = GLINT_OK};
    GlintImage image;
    GlintStatus status = glint_image_load(grading->picture, &image, &error);
    if (status != GLINT_OK) return fail(grading, status, &error);
    const GlintMonitor monitor = {on_progress, on_cancelled, grading};
    GlintGradeDesc desc = grade_desc(grading, &monitor);
    GlintGrade result = {0};
    CliStatus outcome = CLI_OK;
    float *difference = NULL;
    if (grading->options->difference != NULL) {
        size_t count = 3 * (size_t)image.width * (size_t)image.height;
        desc.compare.difference = difference = malloc(count * sizeof *difference);
        if (difference == NULL) status = GLINT_ERROR_MEMORY;
    }
    if (status == GLINT_OK) {
        status = glint_grade(&image, grading->reference, &desc, &result, &error);
    }
    if (status != GLINT_OK) {
        outcome = fail(grading, status, &error);
    } else {
        cli_progress_clear(&grading->progress);
        outcome = report(grading, &result);
        if (difference != NULL) status = save_difference(grading, difference, &result, &error);
        if (status != GLINT_OK) {
            fail(grading, status, &error);
            outcome = CLI_MACHINE;
        }
    }
    free(difference);
    glint_image_free(&result.reference);
    glint_image_free(&image);
    return outcome;
}

static CliStatus run(void *values, const CliOperands *operands) {
    const GradeOptions *options = values;
    if (operands->count != 2) {
        return cli_message_usage(
            "grade takes a picture and what it should be, a scene or a picture");
    }
    Grading grading = {
        .options = options, .picture = operands->items[0], .reference = operands->items[1]};
    bool progress = !options->quiet && cli_message_on_terminal();
    cli_progress_begin(&grading.progress, progress, grading.picture, 0, 1);
    return grade(&grading);
}

static GradeOptions defaults = {.max_percent = 1, .tolerance = 2, .dialect = GLINT_DIALECT_AUTO};

const CliVerb cli_verb_grade = {.name = "grade",
    .operands = "PICTURE REFERENCE",
    .summary = "say how a picture differs from what it should be, and why",
    .about = "Compares a PICTURE (PNG, JPEG, PFM or EXR) with what it should be, a scene or\n"
             "another picture, and finds out which typical mistake explains the difference,\n"
             "or which two. Of a scene it draws what each mistake would have made.",
    .notes = "Here that means: 0 when at most P % of the pixels differ, 1 when more do or the\n"
             "sizes differ, 2 when the two cannot be compared, 3 when the machine fails.\n"
             "The mistakes are those of `glint render --break list`.",
    .example_text = "grade a student's picture of a scene",
    .example = "glint grade mine.png scenes/solids.xml",
    .options = option_table,
    .option_count = CLI_COUNT(option_table),
    .values = &defaults,
    .run = run};
