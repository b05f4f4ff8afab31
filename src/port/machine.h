/* SPDX-License-Identifier: MIT
 * What the machine is: memory, cores, clock, instruction sets. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* Bytes that this process may use: physical memory, or less when a resource limit or a control
 * group says so. */
size_t gi_machine_memory(void);

/* Asks for large pages under memory that was just allocated and will be filled from its beginning:
 * touching it then takes far fewer page faults. It is a wish only, and none where the memory is not
 * large. Not for what grows by and by: each move would be slower. */
void gi_machine_large_pages(void *memory, size_t size);

/* Cores this process may run on; at least 1. */
int gi_machine_core_count(void);

/* Seconds since some fixed moment; never runs backwards. */
double gi_machine_seconds(void);

typedef enum GiMachineFeature {
    GI_MACHINE_SSE2,
    GI_MACHINE_AVX2,
    GI_MACHINE_AVX512
} GiMachineFeature;

/* Whether processor and operating system support it. AVX2 stands for the Haswell set (with FMA, BMI
 * and POPCNT), AVX512 for F, CD, BW, DQ and VL on top of that. */
bool gi_machine_has(GiMachineFeature feature);
