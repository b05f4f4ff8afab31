/* SPDX-License-Identifier: MIT
 * The background is that of the page, which may be light or dark, and a picture in a page is not
 * told which; so all colours are from the middle, where they stand out from both. */
#include "plot.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 380, HEIGHT = 300, LEFT = 64, TOP = 66, GAP = 46, BOTTOM = 52 };
static const char *const colours[] = {"#2f81f7", "#d9730d"};
static const char *const grey = "#7d8590";

typedef struct Axis {
    int low, high; /* powers of ten */
} Axis;

static double place(const Axis *axis, double value) {
    return (log10(value) - axis->low) / (axis->high - axis->low);
}

static void widen(Axis *axis, double value) {
    int below = (int)floor(log10(value) + 1e-9), above = (int)ceil(log10(value) - 1e-2);
    if (axis->low > below) axis->low = below;
    if (axis->high < above) axis->high = above;
}

/* "100", "10 k", "1 M", "0.01" */
static void write_power(FILE *file, int power) {
    if (power < 0) {
        fprintf(file, "%.*f", -power, pow(10, power));
    } else {
        static const char *const units[] = {"", " k", " M", " G"};
        int unit = power / 3 < 3 ? power / 3 : 3;
        fprintf(file, "%.0f%s", pow(10, power - 3 * unit), units[unit]);
    }
}

static void write_grid(FILE *file, double left, const Axis *x, const Axis *y, bool names) {
    for (int power = x->low; power <= x->high; power++) {
        double at = left + WIDTH * (double)(power - x->low) / (x->high - x->low);
        fprintf(file, "<path d=\"M%.1f %dv%d\"/>\n", at, TOP, HEIGHT);
        fprintf(file, "<text stroke=\"none\" x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">", at,
            TOP + HEIGHT + 18);
        write_power(file, power);
        fputs("</text>\n", file);
    }
    for (int power = y->low; power <= y->high; power++) {
        double at = TOP + HEIGHT * (1 - (double)(power - y->low) / (y->high - y->low));
        fprintf(file, "<path d=\"M%.1f %.1fh%d\"/>\n", left, at, WIDTH);
        if (!names) continue;
        fprintf(file, "<text stroke=\"none\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">", left - 8,
            at + 4);
        write_power(file, power);
        fputs("</text>\n", file);
    }
}

static int compare(const void *a, const void *b) {
    double x = ((const PlotPoint *)a)->x, y = ((const PlotPoint *)b)->x;
    return (x > y) - (x < y);
}

static void write_curve(
    FILE *file, PlotCurve *curve, double left, const Axis *x_axis, const Axis *y_axis) {
    qsort(curve->points, (size_t)curve->count, sizeof curve->points[0], compare);
    fprintf(file, "<g stroke=\"%s\" fill=\"%s\"><path fill=\"none\" stroke-width=\"2\"%s d=\"",
        colours[curve->colour / 2], colours[curve->colour / 2],
        curve->dashed ? " stroke-dasharray=\"5 4\"" : "");
    double x[PLOT_POINT_MAX], y[PLOT_POINT_MAX];
    for (int i = 0; i < curve->count; i++) {
        x[i] = left + WIDTH * place(x_axis, curve->points[i].x);
        y[i] = TOP + HEIGHT * (1 - place(y_axis, curve->points[i].y));
        fprintf(file, "%s%.1f %.1f", i == 0 ? "M" : "L", x[i], y[i]);
    }
    fputs("\"/>\n", file);
    for (int i = 0; i < curve->count; i++) {
        /* Round and square: colours alone do not tell everyone. */
        if (curve->colour < 2) {
            fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\"/>\n", x[i], y[i]);
        } else {
            fprintf(file, "<path d=\"M%.1f %.1fh6v6h-6z\"/>\n", x[i] - 3, y[i] - 3);
        }
    }
    fputs("</g>\n", file);
}

/* What the lines mean, above the first panels, from all of their labels. */
static void write_key(FILE *file, const PlotPanel *panels, int panel_count) {
    bool known[2 * sizeof colours / sizeof colours[0]] = {false};
    double x = LEFT;
    for (int i = 0; i < panel_count; i++) {
        for (int k = 0; k < panels[i].curve_count; k++) {
            const PlotCurve *curve = &panels[i].curves[k];
            if (known[curve->colour]) continue;
            known[curve->colour] = true;
            fprintf(file, "<path d=\"M%.1f 18h28\" stroke=\"%s\" stroke-width=\"2\"%s/>\n", x,
                colours[curve->colour / 2], curve->dashed ? " stroke-dasharray=\"5 4\"" : "");
            fprintf(file, "<text x=\"%.1f\" y=\"22\">%s</text>\n", x + 36, curve->label);
            x += 195;
        }
    }
}

void plot_write(
    FILE *file, PlotPanel *panels, int panel_count, const char *x_label, const char *y_label) {
    Axis x = {99, -99}, y = {99, -99};
    for (int i = 0; i < panel_count; i++) {
        for (int k = 0; k < panels[i].curve_count; k++) {
            const PlotCurve *curve = &panels[i].curves[k];
            for (int p = 0; p < curve->count; p++) {
                widen(&x, curve->points[p].x);
                widen(&y, curve->points[p].y);
            }
        }
    }
    if (x.low >= x.high) x.high = x.low + 1;
    if (y.low >= y.high) y.high = y.low + 1;
    int width = LEFT + panel_count * (WIDTH + GAP), height = TOP + HEIGHT + BOTTOM;
    fprintf(file,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" font-size=\"13\" "
        "font-family=\"sans-serif\">\n<g fill=\"%s\" stroke=\"none\">\n",
        width, height, grey);
    write_key(file, panels, panel_count);
    fprintf(file, "<text transform=\"translate(16 %d) rotate(-90)\" text-anchor=\"middle\">%s",
        TOP + HEIGHT / 2, y_label);
    fputs("</text>\n", file);
    for (int i = 0; i < panel_count; i++) {
        double left = LEFT + i * (WIDTH + GAP);
        fprintf(file, "<text x=\"%.1f\" y=\"%d\" font-weight=\"bold\">%s</text>\n", left, TOP - 10,
            panels[i].title);
        fprintf(file, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%s</text>\n",
            left + WIDTH / 2.0, TOP + HEIGHT + 40, x_label);
        fprintf(file, "<g stroke=\"%s\" stroke-opacity=\"0.35\">\n", grey);
        write_grid(file, left, &x, &y, i == 0);
        fputs("</g>\n", file);
        for (int k = 0; k < panels[i].curve_count; k++) {
            write_curve(file, &panels[i].curves[k], left, &x, &y);
        }
    }
    fputs("</g>\n</svg>\n", file);
}
