/* SPDX-License-Identifier: MIT
 * How much noise is left at the same number of samples, with Sobol points and with plain random
 * numbers. The figures are the same on every machine, like all pictures. */
#pragma once

/* Prints the table; results (a folder, or null) gets it as noise.csv, pictures (or null) soft
 * shadows both ways. Scenes are kept in the folder cache. */
void noise_run(const char *cache, const char *results, const char *pictures);
