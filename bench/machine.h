/* SPDX-License-Identifier: MIT
 * The name of the machine, under which its numbers are kept. */
#pragma once

#include <stddef.h>

/* "Intel(R) Xeon(R) Processor, avx512, 2 cores" */
void machine_describe(char *text, size_t size);

/* "intel-xeon-processor-avx512": safe as the name of a file. */
void machine_file_name(char *text, size_t size);
