/* SPDX-License-Identifier: MIT
 * A face is the square -1 <= u, v <= 1 at distance 1 from the middle of the cube. A piece du dv of
 * it has the solid angle du dv / (1 + u^2 + v^2)^(3/2): with the cube of the distance, one power
 * for the slant. The sampler takes this at the middle of a texel for the choice of texels, where an
 * approximation only costs a little noise, and at the point itself for the density, where it must
 * be exact. */
#include "light/environment.h"

#include "base/error.h"
#include "image/pfm_read.h"
#include "port/file.h"

#include <string.h>

enum { FACE_COUNT = 6 };

/* A face: the axis it crosses, the side, and the column and row of its square in the cross. */
typedef enum Axis { AXIS_X, AXIS_Y, AXIS_Z } Axis;

static const struct {
    Axis axis;
    int side, column, row;
} faces[FACE_COUNT] = {
    {AXIS_X, 1, 2, 2},
    {AXIS_X, -1, 0, 2},
    {AXIS_Y, 1, 1, 3},
    {AXIS_Y, -1, 1, 1},
    {AXIS_Z, 1, 1, 0},
    {AXIS_Z, -1, 1, 2},
};

typedef struct Place {
    int face;
    double u, v;
} Place;

static Place place_of(GiVec d) {
    double x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
    if (x > y && x > z) return (Place){d.x > 0 ? 0 : 1, d.z / d.x, d.y / x};
    if (y > z) return (Place){d.y > 0 ? 2 : 3, d.x / y, d.z / d.y};
    return (Place){d.z > 0 ? 4 : 5, d.x / z, -d.y / d.z};
}

/* The opposite; not of unit length. */
static GiVec direction_of(Place place) {
    double side = faces[place.face].side, u = place.u, v = place.v;
    switch (faces[place.face].axis) {
    case AXIS_X: return gi_vec(side, v, u * side);
    case AXIS_Y: return gi_vec(u, side, v * side);
    case AXIS_Z: break;
    }
    return gi_vec(u, -v * side, side);
}

/* From -1 ... 1 to the index of a texel. */
static int index_of(double u, int face) {
    int index = (int)(face * (u + 1) / 2);
    return index < face ? index : face - 1;
}

static const float *texel(const GiEnvironment *environment, int face, int column, int row) {
    size_t side = (size_t)environment->face;
    size_t x = (size_t)faces[face].column * side + (size_t)column;
    size_t y = (size_t)faces[face].row * side + (size_t)row;
    return environment->pixels + 3 * (3 * side * y + x);
}

static GiVec radiance_of(const GiEnvironment *environment, const float *rgb) {
    return gi_scale(gi_vec((double)rgb[0], (double)rgb[1], (double)rgb[2]), environment->scale);
}

GiVec gi_environment_radiance(const GiEnvironment *environment, GiVec direction) {
    Place place = place_of(direction);
    int column = index_of(place.u, environment->face), row = index_of(place.v, environment->face);
    return radiance_of(environment, texel(environment, place.face, column, row));
}

/* ---------------------------------------------------------------- reading */

static bool is_finite(const GiEnvironment *environment) {
    for (int face = 0; face < FACE_COUNT; face++) {
        for (int row = 0; row < environment->face; row++) {
            const float *rgb = texel(environment, face, 0, row);
            for (int i = 0; i < 3 * environment->face; i++) {
                if (!isfinite(rgb[i])) return false;
            }
        }
    }
    return true;
}

static GlintStatus check(GiEnvironment *environment, const GiPfm *pfm, GlintError *error) {
    if (pfm->width % 3 != 0 || pfm->width / 3 * 4 != pfm->height) {
        return gi_error_set(error, GLINT_ERROR_FILE,
            "a cube map is a cross of 3 x 4 squares, which %d x %d pixels cannot be", pfm->width,
            pfm->height);
    }
    environment->face = pfm->width / 3;
    environment->pixels = pfm->pixels;
    if (is_finite(environment)) return GLINT_OK;
    return gi_error_set(error, GLINT_ERROR_FILE, "the cube map has a value that is not finite");
}

GlintStatus gi_environment_load(GiEnvironment *environment, GiMemory *memory, const char *path,
    double scale, GlintError *error) {
    GiFileReader file;
    GiPfm pfm;
    GlintError reason = {.status = GLINT_OK};
    *environment = (GiEnvironment){.face = 0};
    GlintStatus status = gi_file_read_open(&file, path, error);
    if (status != GLINT_OK) return status;
    status = gi_pfm_read(&pfm, memory, gi_file_read, &file, file.size, &reason);
    GlintStatus file_status = gi_file_read_status(&file, error);
    gi_file_read_close(&file);
    if (file_status != GLINT_OK) return file_status; /* it knows better what went wrong */
    if (status == GLINT_OK) {
        status = check(environment, &pfm, &reason);
        environment->scale = scale;
        if (status != GLINT_OK) {
            gi_pfm_free(&pfm, memory);
            *environment = (GiEnvironment){.face = 0};
        }
    }
    return status == GLINT_OK ? status
                              : gi_error_set_path(error, status, path, "%s", reason.message);
}

void gi_environment_free(GiEnvironment *environment, GiMemory *memory) {
    size_t side = (size_t)environment->face;
    gi_memory_free(memory, environment->pixels, 12 * side * side * 3 * sizeof(float));
    *environment = (GiEnvironment){.face = 0};
}

/* ---------------------------------------------------------------- sampling */

static double middle(int index, int face) { return (2.0 * index + 1) / face - 1; }

/* (1 + u^2 + v^2)^(3/2) */
static double stretch(double u, double v) {
    double square = 1 + u * u + v * v;
    return square * sqrt(square);
}

/* Negative values count as well: light that is taken away must be sampled too. */
static double weight(const float *rgb, double u, double v) {
    double brightness = 0.2126 * fabs((double)rgb[0]) + 0.7152 * fabs((double)rgb[1]) +
                        0.0722 * fabs((double)rgb[2]);
    return brightness / stretch(u, v);
}

static size_t row_count(const GiEnvironment *environment) {
    return FACE_COUNT * (size_t)environment->face;
}

bool gi_environment_sampler_init(
    GiEnvironmentSampler *sampler, GiMemory *memory, const GiEnvironment *environment) {
    size_t rows = row_count(environment), side = (size_t)environment->face;
    sampler->environment = environment;
    sampler->rows = gi_memory_allocate(memory, (rows + 1) * sizeof(double));
    sampler->columns = gi_memory_allocate(memory, rows * (side + 1) * sizeof(double));
    if (sampler->rows == NULL || sampler->columns == NULL) {
        gi_environment_sampler_reset(sampler, memory);
        return false;
    }
    sampler->rows[0] = 0;
    for (size_t i = 0; i < rows; i++) {
        double *sums = sampler->columns + i * (side + 1);
        int row = (int)(i % side);
        const float *rgb = texel(environment, (int)(i / side), 0, row);
        sums[0] = 0;
        for (int k = 0; k < environment->face; k++) {
            double u = middle(k, environment->face), v = middle(row, environment->face);
            sums[k + 1] = sums[k] + weight(rgb + 3 * k, u, v);
        }
        sampler->rows[i + 1] = sampler->rows[i] + sums[side];
    }
    return true;
}

void gi_environment_sampler_reset(GiEnvironmentSampler *sampler, GiMemory *memory) {
    size_t rows = row_count(sampler->environment), side = (size_t)sampler->environment->face;
    gi_memory_free(memory, sampler->rows, (rows + 1) * sizeof(double));
    gi_memory_free(memory, sampler->columns, rows * (side + 1) * sizeof(double));
    sampler->rows = sampler->columns = NULL;
}

/* Which of the count parts, whose ends are running sums, holds the fraction u of the whole; never
 * one without extent. *rest becomes the place within it, from 0 to 1. */
static size_t choose(const double *sums, size_t count, double u, double *rest) {
    double wanted = u * sums[count];
    size_t low = 0, high = count;
    while (high - low > 1) {
        size_t half = low + (high - low) / 2;
        if (sums[half] <= wanted) {
            low = half;
        } else {
            high = half;
        }
    }
    *rest = (wanted - sums[low]) / (sums[low + 1] - sums[low]);
    return low;
}

/* Per solid angle, at u, v of the texel in column `column` of row `row` of all. */
static double density_at(
    const GiEnvironmentSampler *sampler, size_t row, size_t column, double u, double v) {
    size_t rows = row_count(sampler->environment), side = (size_t)sampler->environment->face;
    const double *sums = sampler->columns + row * (side + 1);
    if (!(sums[side] > 0)) return 0;
    double share = (sampler->rows[row + 1] - sampler->rows[row]) / sampler->rows[rows] *
                   ((sums[column + 1] - sums[column]) / sums[side]);
    double area = 4.0 / ((double)side * (double)side);
    return share / area * stretch(u, v);
}

double gi_environment_sample(
    const GiEnvironmentSampler *sampler, const double u[2], GiVec *direction, GiVec *radiance) {
    const GiEnvironment *environment = sampler->environment;
    size_t rows = row_count(environment), side = (size_t)environment->face;
    if (!(sampler->rows[rows] > 0)) return 0;
    double down, right;
    size_t row = choose(sampler->rows, rows, u[0], &down);
    size_t column = choose(sampler->columns + row * (side + 1), side, u[1], &right);
    Place place = {.face = (int)(row / side),
        .u = 2 * ((double)column + right) / (double)side - 1,
        .v = 2 * ((double)(row % side) + down) / (double)side - 1};
    *direction = gi_normalize(direction_of(place));
    *radiance =
        radiance_of(environment, texel(environment, place.face, (int)column, (int)(row % side)));
    return density_at(sampler, row, column, place.u, place.v);
}

double gi_environment_density(const GiEnvironmentSampler *sampler, GiVec direction) {
    Place place = place_of(direction);
    int side = sampler->environment->face;
    size_t row = (size_t)place.face * (size_t)side + (size_t)index_of(place.v, side);
    return density_at(sampler, row, (size_t)index_of(place.u, side), place.u, place.v);
}
