/* SPDX-License-Identifier: MIT
 * What `glint grade` found, for people and for programs. */
#pragma once

#include "glint/glint.h"

typedef struct CliGradeReport {
    const char *picture, *reference; /* as on the command line */
    const GlintGrade *grade;
    double max_percent; /* what --max-pct allows */
    int tolerance;
    bool passed;
} CliGradeReport;

/* A few lines on standard output. */
void cli_grade_print_text(const CliGradeReport *report);

/* One object on one line of standard output. */
void cli_grade_print_json(const CliGradeReport *report);
