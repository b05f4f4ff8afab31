/* SPDX-License-Identifier: MIT */
#include "watch/camera.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE 0.017453292519943295

/* The least angle between the window's normal and what is up. */
static const double least_angle = 2 * DEGREE;

static const double least_zoom = 1e-3, most_zoom = 1e3;

typedef struct Vector {
    double x, y, z;
} Vector;

static Vector load(const double v[3]) { return (Vector){v[0], v[1], v[2]}; }

static void store(double to[3], Vector v) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

static Vector add(Vector a, Vector b) { return (Vector){a.x + b.x, a.y + b.y, a.z + b.z}; }
static Vector scale(Vector a, double s) { return (Vector){a.x * s, a.y * s, a.z * s}; }
static double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Vector cross(Vector a, Vector b) {
    return (Vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/* Scaled first, so that no square overflows. */
static double length(Vector a) {
    double largest = fmax(fmax(fabs(a.x), fabs(a.y)), fabs(a.z));
    if (largest == 0) return 0;
    Vector b = scale(a, 1 / largest);
    return largest * sqrt(dot(b, b));
}
static Vector unit(Vector a) { return scale(a, 1 / length(a)); }

/* About a unit axis (Rodrigues' formula). */
static Vector turn(Vector v, Vector axis, double angle) {
    Vector along = scale(axis, dot(axis, v) * (1 - cos(angle)));
    return add(add(scale(v, cos(angle)), scale(cross(axis, v), sin(angle))), along);
}

/* ---------------------------------------------------------------- short numbers */

/* To a multiple of a power of ten, about a ten-millionth of size. */
static double shorten(double value, double size) {
    char text[400];
    int digits = 6 - (int)floor(log10(size));
    if (!isfinite(size) || size == 0 || digits > 300) return value;
    if (digits < 0) digits = 0;
    snprintf(text, sizeof text, "%.*f", digits, value);
    double rounded = strtod(text, NULL);
    return rounded == 0 ? 0 : rounded; /* and not -0 */
}

static void shorten3(double v[3], double size) {
    for (int i = 0; i < 3; i++) v[i] = shorten(v[i], size);
}

void cli_camera_number(double value, char text[CLI_CAMERA_NUMBER_SIZE]) {
    for (int digits = 1; digits <= 17; digits++) {
        snprintf(text, CLI_CAMERA_NUMBER_SIZE, "%.*g", digits, value);
        if (strtod(text, NULL) == value) break;
    }
    /* 12 is nicer than 1.2e+01, and a file may hold either. */
    if (strchr(text, 'e') != NULL && fabs(value) >= 1e-4 && fabs(value) < 1e7) {
        char plain[400];
        for (int digits = 0; digits <= 12; digits++) {
            snprintf(plain, sizeof plain, "%.*f", digits, value);
            if (strtod(plain, NULL) == value) break;
        }
        if (strtod(plain, NULL) == value && strlen(plain) < CLI_CAMERA_NUMBER_SIZE) {
            memcpy(text, plain, strlen(plain) + 1);
        }
    }
}

/* ---------------------------------------------------------------- the window */

/* The window's axes, as docs/scene-format.md has them. */
typedef struct Axes {
    Vector d, u, v, w;
} Axes;

static bool has_normal(const GlintCameraDesc *camera) {
    Vector normal = load(camera->projection_normal);
    return normal.x != 0 || normal.y != 0 || normal.z != 0;
}

static Axes axes_of(const GlintCameraDesc *camera) {
    Axes axes = {.d = unit(load(camera->view_direction))};
    axes.w = has_normal(camera) ? unit(load(camera->projection_normal)) : scale(axes.d, -1);
    if (dot(axes.w, axes.d) > 0) axes.w = scale(axes.w, -1);
    axes.u = unit(cross(unit(load(camera->view_up)), axes.w));
    axes.v = cross(axes.w, axes.u);
    return axes;
}

/* A normal that the file gives opposite to the direction stays so, to the last digit. */
static bool is_straight(const GlintCameraDesc *camera, const Axes *axes) {
    return has_normal(camera) && length(cross(axes->w, axes->d)) < 1e-6;
}

/* Puts the turned axes and the moved eye into the camera, in short numbers. */
static void put(GlintCameraDesc *camera, Vector point, const Axes *axes, double distance) {
    Axes before = axes_of(camera);
    bool straight = is_straight(camera, &before);
    double direction_size = length(load(camera->view_direction));
    double normal_size = length(load(camera->projection_normal));
    double sign = dot(load(camera->projection_normal), before.w) < 0 ? -1 : 1;
    store(camera->view_direction, scale(axes->d, direction_size));
    shorten3(camera->view_direction, direction_size);
    if (straight) {
        store(camera->projection_normal, scale(load(camera->view_direction), -1));
        for (int i = 0; i < 3; i++) camera->projection_normal[i] += 0.0; /* no -0 */
    } else if (has_normal(camera)) {
        store(camera->projection_normal, scale(axes->w, sign * normal_size));
        shorten3(camera->projection_normal, normal_size);
    }
    store(camera->view_point, point);
    shorten3(camera->view_point, distance);
}

/* ---------------------------------------------------------------- movements */

void cli_camera_orbit(
    GlintCameraDesc *camera, double distance, double right_degrees, double up_degrees) {
    Axes axes = axes_of(camera);
    Vector up = unit(load(camera->view_up));
    Vector pivot = add(load(camera->view_point), scale(axes.d, distance));
    /* The window's normal leans toward what is up as the eye goes up. */
    double lean = acos(fmin(fmax(dot(axes.w, up), -1), 1)), half_turn = 180 * DEGREE;
    double rise = fmin(up_degrees * DEGREE, lean - least_angle);
    rise = fmax(rise, lean - (half_turn - least_angle));
    if (rise * up_degrees < 0) rise = 0;
    Vector *all[] = {&axes.d, &axes.u, &axes.v, &axes.w};
    Vector side = axes.u;
    for (int i = 0; i < 4; i++) {
        *all[i] = turn(*all[i], side, -rise);
        *all[i] = turn(*all[i], up, right_degrees * DEGREE);
    }
    put(camera, add(pivot, scale(axes.d, -distance)), &axes, distance);
}

void cli_camera_pan(GlintCameraDesc *camera, double distance, double right, double down) {
    Axes axes = axes_of(camera);
    bool parallel = camera->type == GLINT_CAMERA_PARALLEL;
    double far = parallel ? 1 : distance / camera->projection_distance;
    Vector point = load(camera->view_point);
    point = add(point, scale(axes.u, -right * camera->view_width * far));
    point = add(point, scale(axes.v, down * camera->view_height * far));
    store(camera->view_point, point);
    shorten3(camera->view_point, parallel ? camera->view_width : distance);
}

void cli_camera_zoom(GlintCameraDesc *camera, double distance, double factor) {
    factor = fmin(fmax(factor, least_zoom), most_zoom);
    if (camera->type == GLINT_CAMERA_PARALLEL) {
        camera->view_width = shorten(camera->view_width * factor, camera->view_width * factor);
        camera->view_height = shorten(camera->view_height * factor, camera->view_height * factor);
        return;
    }
    Vector d = unit(load(camera->view_direction));
    double moved = distance * (1 - factor);
    store(camera->view_point, add(load(camera->view_point), scale(d, moved)));
    shorten3(camera->view_point, distance * factor);
}

bool cli_camera_equal(const GlintCameraDesc *a, const GlintCameraDesc *b) {
    bool same = a->type == b->type && a->projection_distance == b->projection_distance &&
                a->view_width == b->view_width && a->view_height == b->view_height;
    for (int i = 0; i < 3; i++) {
        same = same && a->view_point[i] == b->view_point[i] &&
               a->view_direction[i] == b->view_direction[i] && a->view_up[i] == b->view_up[i] &&
               a->projection_normal[i] == b->projection_normal[i];
    }
    return same;
}
