/* SPDX-License-Identifier: MIT */
#include "shapes.h"

#include "test.h"

static double size_of(Random *random, double size) {
    return size * exp2(random_real(random, -4, 2));
}

GiVec direction_of(Random *random) {
    GiVec v;
    do {
        v = random_vec(random, -1, 1);
    } while (gi_dot(v, v) < 0.01 || gi_dot(v, v) > 1);
    return v;
}

static void fill_shapes(Fixture *f, Random *random) {
    for (int i = 0; i < SHAPES; i++) {
        GiVec center = gi_add(f->at, random_vec(random, -f->size, f->size));
        f->spheres[i] = (GiSphere){center, size_of(random, f->size)};
        GiVec half =
            gi_vec(size_of(random, f->size), size_of(random, f->size), size_of(random, f->size));
        f->boxes[i] = (GiBox){gi_sub(center, half), gi_add(center, half)};
        f->cones[i] = (GiCone){center, half.x, 0, half.y};
        /* Apexes below, inside and above; also near and far. */
        double tip = half.y * exp2(random_real(random, -2, 4)) * (i % 2 ? 1 : -1);
        f->cones[SHAPES + i] = (GiCone){center, half.x, -half.x / tip, half.y};
        f->discs[i] = (GiDisc){center, gi_normalize(direction_of(random)), half.x};
        f->planes[i] = (GiPlane){center, gi_normalize(direction_of(random))};
    }
    f->discs[0].normal = gi_vec(0, 0, -1);
    f->planes[0].normal = gi_vec(0, 1, 0);
}

static void fill_transforms(Fixture *f, Random *random) {
    for (int i = 0; i < TRANSFORMS; i++) {
        GiVec scale = gi_vec(exp2(random_real(random, -2, 2)), exp2(random_real(random, -2, 2)),
            exp2(random_real(random, -2, 2)));
        if (i % 3 == 1) scale.x = -scale.x;
        if (i % 4 == 1) scale = gi_vec(-scale.x, -scale.y, -scale.z);
        GiAffine a = gi_affine_scale(scale),
                 b = gi_affine_rotate_degrees(random_vec(random, -180, 180));
        GiAffine c = gi_affine_translate(random_vec(random, -3 * f->size, 3 * f->size));
        GiAffine d = gi_affine_rotate_degrees(random_vec(random, -180, 180));
        /* A turn between two unequal scales shears. */
        a = gi_affine_multiply(&b, &a);
        if (i % 2) a = gi_affine_multiply(&a, &d);
        a = gi_affine_multiply(&c, &a);
        f->transforms[i].to_world = a;
        CHECK(gi_affine_invert(&a, &f->transforms[i].to_object));
    }
    for (uint32_t i = 0; i < PLACEMENTS; i++) {
        GiShapeKind kind = (GiShapeKind)(i % 5);
        f->placements[i] = (GiPlacement){gi_shape_ref(kind, i / 5 % SHAPES), i % TRANSFORMS};
        if (kind == GI_SHAPE_CONE && i % 2) f->placements[i].shape.bits += SHAPES;
    }
}

void fixture_init(Fixture *f, uint64_t seed, GiVec at, double size, bool entering_only) {
    Random random = {seed};
    f->at = at;
    f->size = size;
    fill_shapes(f, &random);
    fill_transforms(f, &random);
    f->shapes = (GiShapes){.spheres = f->spheres,
        .boxes = f->boxes,
        .cones = f->cones,
        .discs = f->discs,
        .planes = f->planes,
        .placements = f->placements,
        .transforms = f->transforms,
        .entering_only = entering_only};
}

GiShapeRef shape_at(int i) {
    static const GiShapeKind kinds[] = {GI_SHAPE_SPHERE, GI_SHAPE_BOX, GI_SHAPE_CONE, GI_SHAPE_CONE,
        GI_SHAPE_DISC, GI_SHAPE_PLANE, GI_SHAPE_PLACED, GI_SHAPE_PLACED};
    uint32_t k = (uint32_t)i % 8, index = (uint32_t)i / 8 % SHAPES;
    if (k == 3) index += SHAPES;
    if (k >= 6) index = (uint32_t)i / 8 * 2 % PLACEMENTS + (k - 6);
    return gi_shape_ref(kinds[k], index);
}

bool is_solid(GiShapeKind kind) { return kind < GI_SHAPE_DISC; }

gi_hit_Ray hit_ray(GiVec o, GiVec d) { return gi_hit_ray(o.x, o.y, o.z, d.x, d.y, d.z); }

void complain(Tally *tally, const Fixture *f, GiShapeRef ref, GiVec o, GiVec d, const char *what,
    double a, double b) {
    if (tally->wrong++ >= 4) return;
    test_fail(__FILE__, __LINE__, "%s: %.17g, %.17g; shape %x%s, ray (%a %a %a) + t (%a %a %a)",
        what, a, b, ref.bits, f->shapes.entering_only ? " entering only" : "", o.x, o.y, o.z, d.x,
        d.y, d.z);
}
