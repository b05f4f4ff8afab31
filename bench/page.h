/* SPDX-License-Identifier: MIT
 * docs/performance.md, made of all that the folder of results holds. */
#pragma once

/* Reads every CSV of report_csv in the folder and writes the page. */
void page_write(const char *results, const char *path);
