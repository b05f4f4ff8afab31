/* SPDX-License-Identifier: MIT
 * Drawing without lights and with them, to tell the time of camera rays from that of shadow rays:
 * a tile goes through both, and a clock within would measure itself. */
#pragma once

#include "scenes.h"

/* Draws in a process of its own, rep_count times each way, and fills both arrays with seconds;
 * zeros for scenes where the question makes no sense: rays that go on, large lights, paths. */
void apart_measure(const BenchScene *scene, const char *path, int threads, int rep_count,
    double *camera_seconds, double *shadow_seconds);
