/* SPDX-License-Identifier: MIT
 * A point light on points that share a Lambertian or Blinn-Phong shader: the formulas of
 * shade/shade.h, operation by operation in the same order, so that the bits are the same. Part of
 * kernel.c. */
#pragma once

typedef struct Wide {
    R x, y, z;
} Wide;

static inline Wide wide_add(Wide a, Wide b) { return (Wide){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline R wide_dot(Wide a, Wide b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Wide wide_scale(Wide a, R s) { return (Wide){a.x * s, a.y * s, a.z * s}; }

/* As gi_along. */
static inline Wide wide_along(Wide o, Wide d, R t) {
    return (Wide){o.x + d.x * t, o.y + d.y * t, o.z + d.z * t};
}

static inline R wide_largest(Wide a) { return R_MAX(R_ABS(a.x), R_MAX(R_ABS(a.y), R_ABS(a.z))); }

/* As gi_normalize: what is too short or too long is scaled first. */
static inline Wide wide_normalize(Wide a) {
    R square = wide_dot(a, a);
    M regular = R_LESS(R_OF(1e-280), square) & R_LESS(square, R_OF(1e280));
    if (m_bits(regular) != m_bits(M_OF(true))) {
        R largest = wide_largest(a);
        M scaled = M_NOT(regular) & R_LESS(R_OF(0), largest);
        R divisor = R_SELECT(scaled, largest, R_OF(1));
        a = (Wide){a.x / divisor, a.y / divisor, a.z / divisor};
        square = R_SELECT(scaled, wide_dot(a, a), square);
        square = R_SELECT(R_EQUAL(square, R_OF(0)), R_OF(1), square); /* zero stays zero */
    }
    return wide_scale(a, R_OF(1) / R_SQRT(square));
}

/* As whole_power of math/elementary.c. */
static inline R wide_power(R base, unsigned n) {
    R power = n & 1 ? base : R_OF(1);
    while (n >>= 1) {
        base = base * base;
        if (n & 1) power = power * base;
    }
    return power;
}

static inline R wide_positive(R x) { return R_MAX(x, R_OF(0)); }

/* The part of the light that the surface sends toward the viewer, for each colour. */
static inline Wide wide_reflect(const GiGloss *gloss, Wide n, Wide v, Wide l) {
    R nl = wide_dot(n, l), cosine = wide_positive(nl);
    R diffuse = R_OF(gloss->diffuse_factor) * cosine;
    Wide color = {R_OF(gloss->diffuse.x) * diffuse, R_OF(gloss->diffuse.y) * diffuse,
        R_OF(gloss->diffuse.z) * diffuse};
    if (gloss->phong) {
        Wide h = wide_normalize((Wide){l.x + v.x, l.y + v.y, l.z + v.z});
        R highlight = wide_power(wide_positive(wide_dot(n, h)), gloss->exponent);
        if (gloss->cosine) highlight = highlight * cosine;
        color.x = color.x + R_OF(gloss->specular.x) * highlight;
        color.y = color.y + R_OF(gloss->specular.y) * highlight;
        color.z = color.z + R_OF(gloss->specular.z) * highlight;
    }
    return color;
}

/* The way from points to the light: unit direction, square and inverse of the distance. */
typedef struct Way {
    Wide l;
    R square, inverse;
} Way;

static inline Way way_to(const GiPointLight *light, const GiPoints *points, int i) {
    if (light->parallel) {
        Wide l = {R_OF(light->position.x), R_OF(light->position.y), R_OF(light->position.z)};
        return (Way){l, R_OF(1), R_OF(1)};
    }
    Wide d = {R_OF(light->position.x) - r_load(points->px + i),
        R_OF(light->position.y) - r_load(points->py + i),
        R_OF(light->position.z) - r_load(points->pz + i)};
    R square = wide_dot(d, d);
    R inverse = R_OF(1) / R_SQRT(square);
    return (Way){wide_scale(d, inverse), square, inverse};
}

/* All but the beginning waits for a root and a quotient, so these are begun one vector ahead: more
 * than a vector's operations no processor has waiting. The last vector reaches beyond `end`, into
 * points whose turn comes later. */
static void GI_KERNEL(light)(const GiPoints *points, int begin, int end, const GiPointLight *light,
    const GiGloss *gloss, GiLit *lit) {
    int count = lit->count;
    Way next = way_to(light, points, begin);
    for (int i = begin; i < end; i += GI_DOUBLES) {
        Way way = next;
        next = way_to(light, points, i + GI_DOUBLES); /* for the last: of points that are not lit */
        Wide n = {r_load(points->nx + i), r_load(points->ny + i), r_load(points->nz + i)};
        Wide v = {r_load(points->vx + i), r_load(points->vy + i), r_load(points->vz + i)};
        Wide l = way.l;
        Wide color = wide_reflect(gloss, n, v, l);
        if (light->falls) {
            R fall = R_OF(1) / way.square;
            color = (Wide){(R_OF(light->intensity.x) * fall) * color.x,
                (R_OF(light->intensity.y) * fall) * color.y,
                (R_OF(light->intensity.z) * fall) * color.z};
        } else {
            color = (Wide){R_OF(light->intensity.x) * color.x, R_OF(light->intensity.y) * color.y,
                R_OF(light->intensity.z) * color.z};
        }
        /* Not on the light itself, and nothing where nothing is added. */
        R zero = R_OF(0);
        M dark = R_EQUAL(color.x, zero) & R_EQUAL(color.y, zero) & R_EQUAL(color.z, zero);
        M good = R_LESS(zero, way.square) & M_NOT(dark);
        R nl = wide_dot(n, l);
        if (gloss->front_only) good = good & R_LESS_EQUAL(zero, wide_dot(n, v));
        if (gloss->phong && gloss->needs_light) good = good & R_LESS(zero, nl);
        unsigned bits = m_bits(good);
        int left = end - i;
        if (left < GI_DOUBLES) bits &= (1u << left) - 1;
        R error = r_load(points->error + i), away = gloss->away > 0 ? R_OF(gloss->away) : error;
        M clear = R_LESS(r_from_floats(points->clear + i), nl) & R_LESS_EQUAL(error, away);
        u_store(lit->skip + i,
            u_select(m_bits(clear), u_load(points->own + i), u_load(points->skip + i)));
        u_append_indices(lit->point + count, bits, (uint32_t)i);
        r_store(lit->red + i, color.x);
        r_store(lit->green + i, color.y);
        r_store(lit->blue + i, color.z);
        r_store(lit->t_min + i, away * way.inverse);
        memset(lit->arrives + i, 0, GI_DOUBLES);
        if (light->parallel) {
            const GiVec *center = &light->center;
            Wide from = {r_load(points->px + i) - R_OF(center->x),
                r_load(points->py + i) - R_OF(center->y), r_load(points->pz + i) - R_OF(center->z)};
            l = wide_along(l, from, R_OF(-light->part));
        }
        r_append_floats(lit->x + count, l.x, bits);
        r_append_floats(lit->y + count, l.y, bits);
        r_append_floats(lit->z + count, l.z, bits);
        count += bit_count(bits);
    }
    lit->count = count;
}
