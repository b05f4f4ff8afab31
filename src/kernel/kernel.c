/* SPDX-License-Identifier: MIT
 * The kernels of one instruction set. Compiled once for each, with -DGI_ISA=avx2 and the like;
 * everything here is static but the table at the end, whose name tells the instruction set, so
 * that no function of a later processor can be linked into code for an earlier one. */
#include "kernel/kernel.h"

#include "math/angle.h"
#include "shape/hit.h"
#include "kernel/count.h"
#include "kernel/wide.h"
#include "kernel/wide_eight.h"
#include "kernel/wide_packet.h"

#include <string.h>

#define GI_KERNEL(name) GI_PASTE(GI_PASTE(gi_##name, _), GI_ISA)

#define GI_HIT(name) gi_wide_##name
#include "shape/hit_template.h"
#undef GI_HIT

#include "kernel/single.h"
#include "kernel/many.h"
#include "kernel/frustum.h"
#include "kernel/decide.h"
#include "kernel/certain.h"
#include "kernel/triangle.h"
#include "kernel/solid.h"
#include "kernel/inside.h"
#include "kernel/bundle.h"
#include "kernel/light.h"
#include "kernel/area.h"
#include "kernel/stream.h"
#include "kernel/gamma.h"
#include "kernel/regroup_order.h"

extern const GiKernel GI_KERNEL(kernel);

const GiKernel GI_KERNEL(kernel) = {
    GI_TEXT(GI_ISA),
    GI_KERNEL(closest),
    GI_KERNEL(any),
    GI_KERNEL(many_closest),
    GI_KERNEL(many_any),
    GI_KERNEL(bundle_closest),
    GI_KERNEL(bundle_any),
    GI_KERNEL(bundle_parallel),
    GI_KERNEL(view),
    GI_KERNEL(group),
    GI_KERNEL(points),
    GI_KERNEL(light),
    GI_KERNEL(area),
    GI_KERNEL(shadows),
    GI_KERNEL(add),
    GI_KERNEL(colors),
    GI_KERNEL(encode),
    GI_KERNEL(regroup),
};
