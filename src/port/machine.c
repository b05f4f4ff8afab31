/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* sched_getaffinity, madvise */
#include "port/machine.h"

#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

/* A number of bytes in the first line of a small file, or SIZE_MAX ("max", no such file). */
static size_t read_limit(const char *path) {
    FILE *file = fopen(path, "re");
    if (file == NULL) return SIZE_MAX;
    unsigned long long value;
    size_t limit = fscanf(file, "%llu", &value) == 1 && value < SIZE_MAX ? (size_t)value : SIZE_MAX;
    fclose(file);
    return limit;
}

size_t gi_machine_memory(void) {
    long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    size_t size = pages > 0 && page_size > 0 ? (size_t)pages * (size_t)page_size : SIZE_MAX / 2;
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur < size) size = (size_t)limit.rlim_cur;
    size_t group = read_limit("/sys/fs/cgroup/memory.max");
    return group < size ? group : size;
}

void gi_machine_large_pages(void *memory, size_t size) {
#ifdef MADV_HUGEPAGE
    const size_t worth = 4 << 20;
    if (memory == NULL || size < worth) return;
    uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE);
    /* The first and the last page too, lest the mapping be cut in pieces that cannot be resized. */
    uintptr_t begin = (uintptr_t)memory / page * page;
    uintptr_t end = ((uintptr_t)memory + size + page - 1) / page * page;
    madvise((void *)begin, end - begin, MADV_HUGEPAGE);
#else
    (void)memory, (void)size;
#endif
}

int gi_machine_core_count(void) {
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0) {
        int count = CPU_COUNT(&set);
        if (count > 0) return count;
    }
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count > 0 ? (int)count : 1;
}

double gi_machine_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The C library has asked the processor already. To ask again takes 80 us in a virtual machine,
 * which the host has to answer for. */
#if (defined(__x86_64__) || defined(__i386__)) && defined(__has_include)
#if __has_include(<sys/platform/x86.h>)
#include <sys/platform/x86.h>

/* CPU_FEATURE_ACTIVE, whose 1 << 31 (AVX512VL) is no int. */
static bool active(unsigned feature) {
    const struct cpuid_feature *leaf = __x86_get_cpuid_feature_leaf(feature / 128);
    return leaf->active_array[feature % 128 / 32] >> feature % 32 & 1;
}
#define HAS(name, NAME) active(x86_cpu_##NAME)
#elif defined(__GNUC__)
#define HAS(name, NAME) __builtin_cpu_supports(name)
#endif
#endif

bool gi_machine_has(GiMachineFeature feature) {
#ifdef HAS
    switch (feature) {
    case GI_MACHINE_SSE2: return HAS("sse2", SSE2);
    case GI_MACHINE_AVX2:
        return HAS("avx2", AVX2) && HAS("fma", FMA) && HAS("bmi", BMI1) && HAS("bmi2", BMI2) &&
               HAS("popcnt", POPCNT);
    case GI_MACHINE_AVX512:
        return gi_machine_has(GI_MACHINE_AVX2) && HAS("avx512f", AVX512F) &&
               HAS("avx512cd", AVX512CD) && HAS("avx512bw", AVX512BW) &&
               HAS("avx512dq", AVX512DQ) && HAS("avx512vl", AVX512VL);
    }
#endif
    (void)feature;
    return false;
}
