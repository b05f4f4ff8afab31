/* SPDX-License-Identifier: MIT
 * Which mistakes explain a picture: tries them all, one at a time and in pairs, and weighs what
 * they leave unexplained. What draws the pictures with mistakes is the caller's. */
#pragma once

#include "base/memory.h"
#include "mistake/mistake.h"

enum { GI_GRADE_LIGHT_LIMIT = 64 };

/* Up to so many percent of the pixels may differ for no other reason than rounding at edges. */
#define GI_GRADE_ISOLATED 0.1

/* A part of a picture. */
typedef struct GiGradeWindow {
    int x, y, width, height;
} GiGradeWindow;

typedef struct GiGradeTask {
    GiMemory *memory;
    int width, height;
    const float *mine, *right; /* the picture to explain, and the right one */
    int tolerance;
    bool from_scene;                   /* false: of the mistakes of a scene only SHIFTED is tried */
    bool pairs;                        /* try two at a time when one does not do */
    bool many_pairs;                   /* all of them, since drawing costs little */
    int light_count;                   /* lights beyond GI_GRADE_LIGHT_LIMIT are not tried */
    bool placed[GI_GRADE_LIGHT_LIMIT]; /* the light has a place, and casts shadows */
    /* Draws the window with mistakes of the scene (never those of a finished picture) into pixels,
     * which are those of the window alone. *differs false: they change nothing in this scene, and
     * nothing was drawn. */
    GlintStatus (*draw)(void *user, const GlintMistakes *mistakes, const GiGradeWindow *window,
        float *pixels, bool *differs, GlintError *error);
    /* Draws, without mistakes, what the light makes alone; from 1. */
    GlintStatus (*draw_light)(void *user, int light, float *pixels, GlintError *error);
    void (*progress)(void *user, double fraction);
    void *user;
} GiGradeTask;

/* Fills verdict, hypotheses, rivals and tried; comparison must be there already. Errors: MEMORY and
 * those of draw. */
GlintStatus gi_grade_search(const GiGradeTask *task, GlintGrade *grade, GlintError *error);

/* ---- among the files of this room */

/* How far a picture is from mine: the sum over pixels of what the largest difference of a channel
 * is beyond the tolerance. Of every step-th pixel across and down. */
double gi_grade_left(const GiGradeTask *task, const uint8_t *mine, const float *pixels,
    const GlintMistakes *mistakes, int tolerance, int step);

/* The same where only the window was drawn, without mistakes of the finished picture. */
double gi_grade_left_in(const GiGradeTask *task, const uint8_t *mine, const float *pixels,
    const GiGradeWindow *window, int tolerance);

/* The factor that brings pixels closest to mine; 1 when there is nothing to tell it by. */
double gi_grade_factor(const GiGradeTask *task, const uint8_t *mine, const float *pixels, int step);

/* Whether mine is the right picture with the light of some lights taken from some pixels, scattered
 * as rounding scatters them: what is then left, or a negative number when it is not so. */
GlintStatus gi_grade_acne(
    const GiGradeTask *task, const uint8_t *mine, double *left, GlintError *error);

/* Sets verdict and rivals by the hypotheses, which are sorted. */
void gi_grade_judge(GlintGrade *grade);
