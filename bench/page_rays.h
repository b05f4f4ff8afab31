/* SPDX-License-Identifier: MIT
 * What docs/performance.md says about rays alone. */
#pragma once

#include "table.h"

#include <stdio.h>

/* The section; nothing where the table is empty. */
void page_rays(FILE *file, const Table *rays);

/* A line for each kind of rays that Embree traces faster, and where its tree is built faster or
 * smaller; returns how many. */
int page_rays_losses(FILE *file, const Table *rays);
