/* SPDX-License-Identifier: MIT
 * why_page.html, cut in two where its data goes; made by embed.py. */
#pragma once

#include <stddef.h>

extern const char cli_why_page_head[], cli_why_page_tail[];
extern const size_t cli_why_page_head_size, cli_why_page_tail_size;
