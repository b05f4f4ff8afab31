/* SPDX-License-Identifier: MIT
 * The numbers that decide where samples fall. They are a function of pixel, number of the sample
 * and dimension, never of the order of calls: a crop, or any number of threads, draws the same
 * picture.
 *
 * A dimension is a purpose: the place on the film, the choice at the first bounce, and so on. Over
 * the samples 0, 1, 2, ... of a pixel, the pairs of one dimension are a (0,2)-sequence: of the
 * first 2^m, and of each 2^m that follow, one lies in each of the 2^m boxes of any of the shapes
 * 2^-k x 2^(k-m). Different dimensions, and different pixels, are independent. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

typedef struct GiSampler {
    uint64_t seed;    /* of the pixel */
    uint32_t sample;  /* its number, bits reversed */
    bool independent; /* plain random numbers, to compare with */
} GiSampler;

/* x and y count in the whole picture; sample from 0. */
GiSampler gi_sampler(uint32_t x, uint32_t y, uint32_t sample);
GiSampler gi_sampler_independent(uint32_t x, uint32_t y, uint32_t sample);

/* Uniform in [0, 1), whole multiples of 2^-32. The single number of a dimension is the first of its
 * pair. */
double gi_sample_1d(const GiSampler *sampler, uint64_t dimension);
void gi_sample_2d(const GiSampler *sampler, uint64_t dimension, double u[2]);
