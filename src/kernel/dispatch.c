/* SPDX-License-Identifier: MIT */
#include "kernel/kernel.h"

#include "glint/glint.h"
#include "port/machine.h"

#include <string.h>

#ifdef GI_BUILD_AVX512
extern const GiKernel gi_kernel_avx512;
#endif
#ifdef GI_BUILD_AVX2
extern const GiKernel gi_kernel_avx2;
#endif
#ifdef GI_BUILD_SSE2
extern const GiKernel gi_kernel_sse2;
#endif
extern const GiKernel gi_kernel_portable;

const GiKernel *gi_kernel_at(int index) {
#ifdef GI_BUILD_AVX512
    if (gi_machine_has(GI_MACHINE_AVX512) && index-- == 0) return &gi_kernel_avx512;
#endif
#ifdef GI_BUILD_AVX2
    if (gi_machine_has(GI_MACHINE_AVX2) && index-- == 0) return &gi_kernel_avx2;
#endif
#ifdef GI_BUILD_SSE2
    if (gi_machine_has(GI_MACHINE_SSE2) && index-- == 0) return &gi_kernel_sse2;
#endif
    return index == 0 ? &gi_kernel_portable : NULL;
}

const GiKernel *gi_kernel_find(const char *name) {
    const GiKernel *kernel;
    for (int i = 0; (kernel = gi_kernel_at(i)) != NULL; i++) {
        if (name == NULL || strcmp(kernel->name, name) == 0) return kernel;
    }
    return NULL;
}

const char *glint_isa_name(int index) {
    const GiKernel *kernel = index >= 0 ? gi_kernel_at(index) : NULL;
    return kernel != NULL ? kernel->name : NULL;
}
