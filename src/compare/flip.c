/* SPDX-License-Identifier: MIT
 * LDR-FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A
 * Difference Evaluator for Alternating Images". What an eye that looks from one picture to the
 * other notices: colours after the blur of its contrast sensitivity, and edges and points that are
 * in one picture only, which let a difference of colour count for more.
 *
 * All filters are sums of products of functions of one dimension: rows first, then columns.
 * Pictures go on beyond their borders as the pixel at the border. Planes are floats, sums are
 * doubles; the elementary functions are ours, so that the numbers are the same everywhere. */
#include "compare/compare.h"

#include "math/elementary.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979324

enum { RADIUS_LIMIT = 512, KERNEL_SIZE = 2 * RADIUS_LIMIT + 1 };

typedef struct Kernel {
    int radius;
    double weight[KERNEL_SIZE]; /* of -radius to radius */
} Kernel;

/* A picture that is looked at, and room for filters. */
typedef struct Eye {
    int width, height;
    double pixels_per_degree;
    size_t count;
    float *achromatic, *red_green, *blue_yellow; /* Y, Cx, Cz of the picture */
    float *rows, *term;
    Kernel a, b;
} Eye;

/* ---------------------------------------------------------------- colour */

typedef struct Triple {
    double x, y, z;
} Triple;

static double decode_srgb(double c) {
    return c <= 0.04045 ? c / 12.92 : gi_pow((c + 0.055) / 1.055, 2.4);
}

/* Linear sRGB to XYZ and back, with the white of D65 (IEC 61966-2-1; the exact fractions that its
 * primaries give). */
static Triple xyz_of_rgb(Triple c) {
    return (Triple){
        10135552.0 / 24577794 * c.x + 8788810.0 / 24577794 * c.y + 4435075.0 / 24577794 * c.z,
        2613072.0 / 12288897 * c.x + 8788810.0 / 12288897 * c.y + 887015.0 / 12288897 * c.z,
        1425312.0 / 73733382 * c.x + 8788810.0 / 73733382 * c.y + 70074185.0 / 73733382 * c.z};
}

static Triple rgb_of_xyz(Triple c) {
    return (Triple){3.2410032329763583 * c.x - 1.5373989694887853 * c.y - 0.4986158819963628 * c.z,
        -0.9692242522025163 * c.x + 1.8759299836951757 * c.y + 0.0415542263400847 * c.z,
        0.0556394198519754 * c.x - 0.2040112061239039 * c.y + 1.0571489771875333 * c.z};
}

static Triple white(void) { return xyz_of_rgb((Triple){1, 1, 1}); }

/* The linear opponent space YCxCz. */
static Triple opponent_of_xyz(Triple c) {
    Triple w = white();
    double x = c.x / w.x, y = c.y / w.y, z = c.z / w.z;
    return (Triple){116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

static Triple xyz_of_opponent(Triple c) {
    Triple w = white();
    double y = (c.x + 16) / 116;
    return (Triple){(y + c.y / 500) * w.x, y * w.y, (y - c.z / 200) * w.z};
}

/* CIE L*a*b*. */
static double lab_curve(double t) {
    const double d = 6.0 / 29;
    return t > d * d * d ? gi_pow(t, 1.0 / 3) : t / (3 * d * d) + 4.0 / 29;
}

static double clamp(double x) { return x > 0 ? (x < 1 ? x : 1) : 0; }

/* Of linear colours; colourful less where it is dark (Hunt 1952). */
static Triple hunt_lab_of_rgb(Triple c) {
    Triple w = white(), p = xyz_of_rgb((Triple){clamp(c.x), clamp(c.y), clamp(c.z)});
    double x = lab_curve(p.x / w.x), y = lab_curve(p.y / w.y), z = lab_curve(p.z / w.z);
    double l = 116 * y - 16;
    return (Triple){l, 0.01 * l * 500 * (x - y), 0.01 * l * 200 * (y - z)};
}

/* Abasi, Amani Tehran, Fairchild 2020. */
static double hyab(Triple a, Triple b) {
    double u = a.y - b.y, v = a.z - b.z;
    return fabs(a.x - b.x) + sqrt(u * u + v * v);
}

/* ---------------------------------------------------------------- filters */

static int clamp_index(int i, int count) { return i < 0 ? 0 : i < count ? i : count - 1; }

/* from, along rows, to `to`. */
static void filter_rows(const Eye *eye, const Kernel *kernel, const float *from, float *to) {
    int width = eye->width, r = kernel->radius;
    for (int y = 0; y < eye->height; y++, from += width, to += width) {
        for (int x = 0; x < width; x++) {
            double sum = 0;
            if (x >= r && x + r < width) {
                for (int k = -r; k <= r; k++) sum += kernel->weight[r + k] * (double)from[x + k];
            } else {
                for (int k = -r; k <= r; k++) {
                    sum += kernel->weight[r + k] * (double)from[clamp_index(x + k, width)];
                }
            }
            to[x] = (float)sum;
        }
    }
}

static void filter_columns(const Eye *eye, const Kernel *kernel, const float *from, float *to) {
    int width = eye->width, height = eye->height, r = kernel->radius;
    double sums[256];
    for (int y = 0; y < height; y++) {
        for (int first = 0; first < width; first += 256) {
            int count = width - first < 256 ? width - first : 256;
            memset(sums, 0, sizeof sums);
            for (int k = -r; k <= r; k++) {
                const float *row =
                    from + (size_t)clamp_index(y + k, height) * (size_t)width + first;
                for (int x = 0; x < count; x++) sums[x] += kernel->weight[r + k] * (double)row[x];
            }
            float *out = to + (size_t)y * (size_t)width + first;
            for (int x = 0; x < count; x++) out[x] = (float)sums[x];
        }
    }
}

static void filter(
    Eye *eye, const Kernel *across, const Kernel *down, const float *from, float *to) {
    filter_rows(eye, across, from, eye->rows);
    filter_columns(eye, down, eye->rows, to);
}

static double sum_of(const Kernel *kernel) {
    double sum = 0;
    for (int i = 0; i <= 2 * kernel->radius; i++) sum += kernel->weight[i];
    return sum;
}

/* ---------------------------------------------------------------- contrast sensitivity */

/* In the plane a1 sqrt(pi/b1) exp(-pi^2 d^2 / b1), d in degrees; twice for blue and yellow. */
typedef struct Sensitivity {
    double a1, b1, a2, b2;
} Sensitivity;

static const Sensitivity achromatic = {1, 0.0047, 0, 0}, red_green = {1, 0.0053, 0, 0},
                         blue_yellow = {34.1, 0.04, 13.5, 0.025};

static void set_gauss(Kernel *kernel, double b, int radius, double pixels_per_degree) {
    kernel->radius = radius;
    for (int i = -radius; i <= radius; i++) {
        double d = i / pixels_per_degree;
        kernel->weight[radius + i] = gi_exp(-PI * PI * d * d / b);
    }
}

/* Blurs the plane in place. */
static void blur(Eye *eye, const Sensitivity *s, float *values) {
    const double widest = 0.04;
    double reach = ceil(3 * sqrt(widest / (2 * PI * PI)) * eye->pixels_per_degree);
    int radius = reach < RADIUS_LIMIT ? (int)reach : RADIUS_LIMIT;
    set_gauss(&eye->a, s->b1, radius, eye->pixels_per_degree);
    double sum_a = sum_of(&eye->a), weight_a = s->a1 * sqrt(PI / s->b1),
           total = weight_a * sum_a * sum_a;
    double weight_b = 0;
    if (s->a2 > 0) {
        set_gauss(&eye->b, s->b2, radius, eye->pixels_per_degree);
        double sum_b = sum_of(&eye->b);
        weight_b = s->a2 * sqrt(PI / s->b2);
        total += weight_b * sum_b * sum_b;
        filter(eye, &eye->b, &eye->b, values, eye->term);
    }
    filter_rows(eye, &eye->a, values, eye->rows);
    filter_columns(eye, &eye->a, eye->rows, values);
    for (size_t i = 0; i < eye->count; i++) {
        double value = weight_a * (double)values[i];
        if (s->a2 > 0) value += weight_b * (double)eye->term[i];
        values[i] = (float)(value / total);
    }
}

/* ---------------------------------------------------------------- features */

/* Positive weights sum up to one, negative ones to minus one. */
static void balance(Kernel *kernel) {
    double up = 0, down = 0;
    for (int i = 0; i <= 2 * kernel->radius; i++) {
        if (kernel->weight[i] > 0) {
            up += kernel->weight[i];
        } else {
            down -= kernel->weight[i];
        }
    }
    for (int i = 0; i <= 2 * kernel->radius; i++) {
        double divisor = kernel->weight[i] > 0 ? up : down;
        if (divisor > 0) kernel->weight[i] /= divisor;
    }
}

/* A Gauss function across the feature's line, its first (edges) or second (points) derivative along
 * the other. */
static void set_feature(Eye *eye, bool points) {
    const double feature_width = 0.082;
    double deviation = 0.5 * feature_width * eye->pixels_per_degree;
    double reach = ceil(3 * deviation);
    int radius = reach < RADIUS_LIMIT ? (int)reach : RADIUS_LIMIT;
    eye->a.radius = eye->b.radius = radius;
    for (int i = -radius; i <= radius; i++) {
        double d = i / deviation, gauss = gi_exp(-d * d / 2);
        eye->a.weight[radius + i] = gauss;
        eye->b.weight[radius + i] = points ? (d * d - 1) * gauss : -d * gauss;
    }
    double sum = sum_of(&eye->a);
    for (int i = 0; i <= 2 * radius; i++) eye->a.weight[i] /= sum;
    balance(&eye->b);
}

/* How much of an edge or a point is at each pixel of Y: into `to`. */
static void find_features(Eye *eye, bool points, const float *luminance, float *to) {
    set_feature(eye, points);
    filter(eye, &eye->b, &eye->a, luminance, eye->term);
    filter(eye, &eye->a, &eye->b, luminance, to);
    for (size_t i = 0; i < eye->count; i++) {
        double x = (double)eye->term[i], y = (double)to[i];
        to[i] = (float)sqrt(x * x + y * y);
    }
}

/* ---------------------------------------------------------------- a picture, two pictures */

static void fill_opponent(Eye *eye, const uint8_t *rgb) {
    double linear[256];
    for (int i = 0; i < 256; i++) linear[i] = decode_srgb(i / 255.0);
    for (size_t i = 0; i < eye->count; i++, rgb += 3) {
        Triple c =
            opponent_of_xyz(xyz_of_rgb((Triple){linear[rgb[0]], linear[rgb[1]], linear[rgb[2]]}));
        eye->achromatic[i] = (float)c.x;
        eye->red_green[i] = (float)c.y;
        eye->blue_yellow[i] = (float)c.z;
    }
}

/* lab: 3 a pixel. edges, points: 1. */
static void look(Eye *eye, const uint8_t *rgb, float *lab, float *edges, float *points) {
    fill_opponent(eye, rgb);
    float *luminance = lab; /* until it is needed */
    for (size_t i = 0; i < eye->count; i++) {
        luminance[i] = (eye->achromatic[i] + 16) / 116;
    }
    find_features(eye, false, luminance, edges);
    find_features(eye, true, luminance, points);
    blur(eye, &achromatic, eye->achromatic);
    blur(eye, &red_green, eye->red_green);
    blur(eye, &blue_yellow, eye->blue_yellow);
    for (size_t i = 0; i < eye->count; i++) {
        Triple c = {
            (double)eye->achromatic[i], (double)eye->red_green[i], (double)eye->blue_yellow[i]};
        c = hunt_lab_of_rgb(rgb_of_xyz(xyz_of_opponent(c)));
        lab[3 * i] = (float)c.x, lab[3 * i + 1] = (float)c.y, lab[3 * i + 2] = (float)c.z;
    }
}

/* The largest differences are squeezed, so that all fit between 0 and 1. */
static double color_error(Triple a, Triple b, double most) {
    const double exponent = 0.7, knee = 0.4, knee_value = 0.95;
    double error = gi_pow(hyab(a, b), exponent), limit = knee * most;
    if (error < limit) return error * knee_value / limit;
    return knee_value + (error - limit) / (most - limit) * (1 - knee_value);
}

static double largest_color_error(void) {
    Triple green = hunt_lab_of_rgb((Triple){0, 1, 0}), blue = hunt_lab_of_rgb((Triple){0, 0, 1});
    return gi_pow(hyab(green, blue), 0.7);
}

static Triple triple_at(const float *v) {
    return (Triple){(double)v[0], (double)v[1], (double)v[2]};
}

/* lab, edges and points of both pictures: of the second they follow those of the first. */
static void combine(
    const Eye *eye, const float *lab, const float *edges, const float *points, float *map) {
    double most = largest_color_error();
    size_t n = eye->count;
    for (size_t i = 0; i < n; i++) {
        double color = color_error(triple_at(lab + 3 * i), triple_at(lab + 3 * (n + i)), most);
        double edge = fabs((double)edges[i] - (double)edges[n + i]);
        double point = fabs((double)points[i] - (double)points[n + i]);
        double feature = sqrt((edge > point ? edge : point) / sqrt(2));
        /* 0 to the power 0 is no difference here. */
        map[i] = color > 0 ? (float)gi_pow(color, 1 - clamp(feature)) : 0;
    }
}

bool gi_flip(GiMemory *memory, int width, int height, const uint8_t *reference, const uint8_t *test,
    double pixels_per_degree, float *map) {
    size_t n = (size_t)width * (size_t)height;
    enum { OWN_PLANES = 5, SHARED_PLANES = 10 };
    size_t size = (OWN_PLANES + SHARED_PLANES) * n * sizeof(float);
    float *planes = gi_memory_allocate(memory, size);
    Eye *eye = gi_memory_allocate(memory, sizeof *eye);
    bool good = planes != NULL && eye != NULL;
    if (good) {
        *eye = (Eye){.width = width,
            .height = height,
            .pixels_per_degree = pixels_per_degree,
            .count = n,
            .achromatic = planes,
            .red_green = planes + n,
            .blue_yellow = planes + 2 * n,
            .rows = planes + 3 * n,
            .term = planes + 4 * n};
        float *lab = planes + 5 * n, *edges = planes + 11 * n, *points = planes + 13 * n;
        look(eye, reference, lab, edges, points);
        look(eye, test, lab + 3 * n, edges + n, points + n);
        combine(eye, lab, edges, points, map);
    }
    gi_memory_free(memory, planes, size);
    gi_memory_free(memory, eye, sizeof *eye);
    return good;
}
