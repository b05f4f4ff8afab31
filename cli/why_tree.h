/* SPDX-License-Identifier: MIT
 * The ray tree of a sample as text, and what can be concluded from it. */
#pragma once

#include "why.h"

/* Every ray with what it met, indented by its depth. */
void cli_why_print_tree(const CliWhy *why, const GlintExplainSample *sample);

/* "In short: ...": what the sample's colour comes from, and for what is missing, why. */
void cli_why_print_short(const CliWhy *why, const GlintExplainSample *sample);

/* Lines "hint: ..." for a light that does not arrive. */
void cli_why_print_light_hints(const CliWhy *why, const GlintExplainSample *sample,
    const GlintExplainLight *light, int indent);

/* A line of text, indented. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void cli_why_line(const CliWhy *why, int indent, const char *format, ...);

/* Numbers as in a scene file, to six digits; up to four of them live at a time. */
const char *cli_why_vec(const double v[3]);

/* The same of a factor: one number where all three are alike. */
const char *cli_why_part(const double v[3]);

/* All three components are alike, and this. */
bool cli_why_is(const double v[3], double value);
