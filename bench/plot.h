/* SPDX-License-Identifier: MIT
 * Curves over logarithmic axes, as SVG. */
#pragma once

#include <stdbool.h>
#include <stdio.h>

enum { PLOT_POINT_MAX = 16, PLOT_CURVE_MAX = 4 };

typedef struct PlotPoint {
    double x, y; /* above 0 */
} PlotPoint;

typedef struct PlotCurve {
    const char *label;
    int colour; /* 0 and 1 are one colour, 2 and 3 another one */
    bool dashed;
    int count;
    PlotPoint points[PLOT_POINT_MAX]; /* in any order */
} PlotCurve;

typedef struct PlotPanel {
    const char *title;
    int curve_count;
    PlotCurve curves[PLOT_CURVE_MAX];
} PlotPanel;

/* Panels side by side with the same axes, which reach from power of ten to power of ten. */
void plot_write(
    FILE *file, PlotPanel *panels, int panel_count, const char *x_label, const char *y_label);
