/* SPDX-License-Identifier: MIT
 * A verdict for people is a few lines; for programs JSON Lines, one object a picture. Keys are only
 * ever added. */
#include "grade_report.h"

#include "json.h"

#include <stdio.h>

enum { TEXT_LIMIT = 2048 };

static const char *bool_name(bool value) { return value ? "true" : "false"; }

void cli_grade_print_text(const CliGradeReport *report) {
    const GlintGrade *grade = report->grade;
    const GlintComparison *comparison = &grade->comparison;
    char text[TEXT_LIMIT];
    glint_grade_format(grade, text, sizeof text);
    printf("%s: %s\n", report->picture, text);
    printf("  differ   %.2f %% of the pixels by more than %d of 255: %s (at most %g %%)\n",
        comparison->percent, report->tolerance, report->passed ? "passed" : "failed",
        report->max_percent);
    printf("  apart    %.2f of 255 in the mean, %d at most; FLIP %.4f\n", comparison->mean,
        comparison->max, comparison->flip);
    if (grade->verdict == GLINT_VERDICT_SAME) return;
    printf("  tried    %d %s", grade->tried, grade->tried == 1 ? "mistake" : "mistakes");
    if (grade->pairs_tried > 0) printf(" and %d pairs", grade->pairs_tried);
    puts(grade->from_scene ? "" : ", of finished pictures only: the reference is a picture");
}

static void print_hypotheses(const GlintGrade *grade) {
    printf("\"rivals\": %d, \"hypotheses\": [", grade->rivals);
    for (int i = 0; i < grade->hypothesis_count; i++) {
        const GlintHypothesis *hypothesis = &grade->hypotheses[i];
        char text[TEXT_LIMIT];
        glint_mistakes_format(&hypothesis->mistakes, text, sizeof text);
        printf("%s{\"mistakes\": ", i > 0 ? ", " : "");
        cli_json_print_text(text);
        glint_hypothesis_format(hypothesis, text, sizeof text);
        printf(", \"text\": ");
        cli_json_print_text(text);
        printf(", \"explains\": %.6f}", hypothesis->explains);
    }
    printf("]");
}

void cli_grade_print_json(const CliGradeReport *report) {
    const GlintGrade *grade = report->grade;
    const GlintComparison *comparison = &grade->comparison;
    const GlintMistakes none = {0};
    bool named = grade->verdict == GLINT_VERDICT_EXPLAINED ||
                 (grade->verdict == GLINT_VERDICT_ROUNDING && grade->hypothesis_count > 0);
    char text[TEXT_LIMIT];
    printf("{\"picture\": ");
    cli_json_print_text(report->picture);
    printf(", \"reference\": ");
    cli_json_print_text(report->reference);
    printf(", \"passed\": %s, \"verdict\": \"%s\", \"mistakes\": ", bool_name(report->passed),
        glint_verdict_name(grade->verdict));
    glint_mistakes_format(named ? &grade->hypotheses[0].mistakes : &none, text, sizeof text);
    cli_json_print_text(text);
    printf(", \"text\": ");
    glint_grade_format(grade, text, sizeof text);
    cli_json_print_text(text);
    printf(", \"percent\": %.6f, \"max_percent\": %.9g, \"tolerance\": %d", comparison->percent,
        report->max_percent, report->tolerance);
    printf(", \"mean\": %.6f, \"max\": %d, \"relative\": %.6f, \"flip\": %.6f", comparison->mean,
        comparison->max, comparison->relative, comparison->flip);
    printf(", \"size\": [%d, %d], \"right_size\": [%d, %d], \"from_scene\": %s, \"tried\": %d, "
           "\"pairs_tried\": %d, ",
        grade->reference.width, grade->reference.height, grade->width, grade->height,
        bool_name(grade->from_scene), grade->tried, grade->pairs_tried);
    print_hypotheses(grade);
    printf("}\n");
}
