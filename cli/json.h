/* SPDX-License-Identifier: MIT
 * JSON on standard output. */
#pragma once

/* The text in quotes. Bytes that are no UTF-8 become the sign for such. */
void cli_json_print_text(const char *text);
