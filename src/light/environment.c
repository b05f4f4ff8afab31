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

/* The opposite; not of unit length. Faces that are drawn cannot be foretold, so they are told apart
 * by a table. */
static GiVec direction_of(Place place) {
    enum { SIDE, U, V, U_SIDE, V_SIDE, V_DOWN };
    static const uint8_t parts[][3] = {
        [AXIS_X] = {SIDE, V, U_SIDE}, [AXIS_Y] = {U, SIDE, V_SIDE}, [AXIS_Z] = {U, V_DOWN, SIDE}};
    double side = faces[place.face].side, u = place.u, v = place.v;
    const double numbers[] = {side, u, v, u * side, v * side, -v * side};
    const uint8_t *part = parts[faces[place.face].axis];
    return gi_vec(numbers[part[0]], numbers[part[1]], numbers[part[2]]);
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

/* Of parts whose ends are running sums the last that begins with no more than `wanted`: never one
 * without extent, unless all are. From a hint where it is, it is not far: the first step, which
 * half of the walks take, is taken without asking. */
static inline size_t walk_to(const double *sums, size_t count, double wanted, size_t hint) {
    hint += (hint + 1 < count) & (sums[hint + 1] <= wanted);
    while (hint + 1 < count && sums[hint + 1] <= wanted) hint++;
    while (hint > 0 && sums[hint] > wanted) hint--;
    return hint;
}

/* As many hints as there are parts (Chen and Asau 1974): on average a walk takes one step. */
static void find_hints(const double *sums, size_t count, uint32_t *hints) {
    size_t at = 0;
    for (size_t i = 0; i < count; i++) {
        at = walk_to(sums, count, (double)i / (double)count * sums[count], at);
        hints[i] = (uint32_t)at;
    }
}

/* Which of the count parts holds the fraction u of the whole. *rest becomes the place within it,
 * from 0 to 1. */
static inline size_t choose(
    const double *sums, const uint32_t *hints, size_t count, double u, double *rest) {
    double wanted = u * sums[count];
    size_t part = walk_to(sums, count, wanted, hints[(size_t)(u * (double)count)]);
    *rest = (wanted - sums[part]) / (sums[part + 1] - sums[part]);
    return part;
}

/* The sums and hints of a row. */
static void sum_row(const GiEnvironmentSampler *sampler, size_t row) {
    const GiEnvironment *environment = sampler->environment;
    size_t side = (size_t)environment->face;
    double *sums = sampler->columns + row * (side + 1);
    int line = (int)(row % side);
    const float *rgb = texel(environment, (int)(row / side), 0, line);
    sums[0] = 0;
    for (int k = 0; k < environment->face; k++) {
        double u = middle(k, environment->face), v = middle(line, environment->face);
        sums[k + 1] = sums[k] + weight(rgb + 3 * k, u, v);
    }
    find_hints(sums, side, sampler->column_hints + row * side);
}

bool gi_environment_sampler_init(
    GiEnvironmentSampler *sampler, GiMemory *memory, const GiEnvironment *environment) {
    size_t rows = row_count(environment), side = (size_t)environment->face;
    sampler->environment = environment;
    sampler->rows = gi_memory_allocate(memory, (rows + 1) * sizeof(double));
    sampler->columns = gi_memory_allocate(memory, rows * (side + 1) * sizeof(double));
    sampler->row_hints = gi_memory_allocate(memory, rows * sizeof(uint32_t));
    sampler->column_hints = gi_memory_allocate(memory, rows * side * sizeof(uint32_t));
    if (sampler->rows == NULL || sampler->columns == NULL || sampler->row_hints == NULL ||
        sampler->column_hints == NULL) {
        gi_environment_sampler_reset(sampler, memory);
        return false;
    }
    sampler->rows[0] = 0;
    for (size_t i = 0; i < rows; i++) {
        sum_row(sampler, i);
        sampler->rows[i + 1] = sampler->rows[i] + sampler->columns[i * (side + 1) + side];
    }
    find_hints(sampler->rows, rows, sampler->row_hints);
    return true;
}

void gi_environment_sampler_reset(GiEnvironmentSampler *sampler, GiMemory *memory) {
    size_t rows = row_count(sampler->environment), side = (size_t)sampler->environment->face;
    gi_memory_free(memory, sampler->rows, (rows + 1) * sizeof(double));
    gi_memory_free(memory, sampler->columns, rows * (side + 1) * sizeof(double));
    gi_memory_free(memory, sampler->row_hints, rows * sizeof(uint32_t));
    gi_memory_free(memory, sampler->column_hints, rows * side * sizeof(uint32_t));
    sampler->rows = sampler->columns = NULL;
    sampler->row_hints = sampler->column_hints = NULL;
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
    size_t row = choose(sampler->rows, sampler->row_hints, rows, u[0], &down);
    size_t column = choose(sampler->columns + row * (side + 1), sampler->column_hints + row * side,
        side, u[1], &right);
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
