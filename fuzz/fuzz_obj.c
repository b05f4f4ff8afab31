/* SPDX-License-Identifier: MIT */
#include "mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    return fuzz(GI_MESH_OBJ, data, size);
}
