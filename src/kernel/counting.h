/* SPDX-License-Identifier: MIT
 * Kernels that count: for pictures of the work that pixels make. The others have no writable data
 * and no time for it. */
#pragma once

#include "kernel/kernel.h"

/* The kernel, but all rays walk the tree one by one, and what they do is added to this thread's
 * counts. The answers are the same to the last bit, and the counts the same on every machine. */
GiKernel gi_counting_kernel(const GiKernel *kernel);

/* What this thread's rays have done since the last call: nodes, leaves and exact tests together. */
uint64_t gi_counting_take(void);
