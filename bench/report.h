/* SPDX-License-Identifier: MIT
 * The numbers for people (standard output) and for programs (CSV). */
#pragma once

#include "contest.h"
#include "picture.h"

#include <stdio.h>

/* The table of one scene, how many times as fast as the others Glint is, and as the other Glint in
 * each phase. */
void report_scene(const Contest *contest);

/* One line a scene: the ratios at a glance. */
void report_summary(const Contest *contests, int count);

/* A row for each scene, program and number of threads, and one for the encoder; date: of today. */
void report_csv(
    const Contest *contests, int count, const EncodeResult *encode, const char *date, FILE *file);
