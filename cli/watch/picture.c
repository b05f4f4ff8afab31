/* SPDX-License-Identifier: MIT */
#include "watch/picture.h"

#include <math.h>
#include <string.h>

/* The pixels that pixel i of `to` covers, and how much of the first and the last. */
typedef struct Range {
    int begin, end;
    double first, last;
} Range;

static Range range_of(int i, int from, int to) {
    double begin = (double)i * from / to, end = (double)(i + 1) * from / to;
    Range range = {(int)begin, (int)ceil(end), 1, 1};
    if (range.end > from) range.end = from;
    if (from <= to) {
        /* Enlarged: the pixel that the middle lies in. */
        range.begin = (int)((begin + end) / 2);
        range.end = range.begin + 1;
        return range;
    }
    range.first = range.begin + 1 - begin;
    range.last = end - (range.end - 1);
    return range;
}

static double weight(const Range *range, int i) {
    return i == range->begin ? range->first : i == range->end - 1 ? range->last : 1;
}

void cli_picture_resize(
    const float *from, int from_width, int from_height, float *to, int to_width, int to_height) {
    for (int y = 0; y < to_height; y++) {
        Range rows = range_of(y, from_height, to_height);
        for (int x = 0; x < to_width; x++) {
            Range columns = range_of(x, from_width, to_width);
            double sum[3] = {0}, total = 0;
            for (int v = rows.begin; v < rows.end; v++) {
                for (int u = columns.begin; u < columns.end; u++) {
                    const float *pixel = from + 3 * ((size_t)v * (size_t)from_width + (size_t)u);
                    double share = weight(&rows, v) * weight(&columns, u);
                    for (int k = 0; k < 3; k++) sum[k] += share * (double)pixel[k];
                    total += share;
                }
            }
            float *pixel = to + 3 * ((size_t)y * (size_t)to_width + (size_t)x);
            for (int k = 0; k < 3; k++) pixel[k] = (float)(sum[k] / total);
        }
    }
}

void cli_picture_fit(int width, int height, int most_width, int most_height, bool enlarge,
    int *fit_width, int *fit_height) {
    double scale = fmin((double)most_width / width, (double)most_height / height);
    if (!enlarge && scale > 1) scale = 1;
    int w = (int)(width * scale + 0.5), h = (int)(height * scale + 0.5);
    *fit_width = w < 1 ? 1 : w < most_width || most_width < 1 ? w : most_width;
    *fit_height = h < 1 ? 1 : h < most_height || most_height < 1 ? h : most_height;
}
