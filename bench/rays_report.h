/* SPDX-License-Identifier: MIT
 * The numbers of glint-bench-rays as a table and as CSV. */
#pragma once

#include "rays_contest.h"

#include <stdio.h>

void rays_report_head(void);
/* Returns how many kinds of rays have hits that differ by more than single precision explains, or
 * that differ at all between kernels. */
int rays_report(const RaysResult *result);

/* date: of the measurement. */
void rays_report_csv_head(FILE *file);
void rays_report_csv(const RaysResult *result, const char *date, FILE *file);
