/* SPDX-License-Identifier: MIT
 * Beckmann's distribution of microfacets, for the two families that use it. */
#pragma once

#include "shade/lobe.h"

/* A roughness in a range where its square and its inverse's square stay numbers. */
double gi_microfacet_roughness(const GiShader *shader);

/* The normal m of microfacets seen from n: cosine, squares of cosine and sine. */
typedef struct GiFacet {
    double cosine, cosine_square, sine_square;
} GiFacet;

GiFacet gi_microfacet_facet(GiVec n, GiVec m);

/* D per solid angle of m; D cos integrates to one. */
double gi_microfacet_beckmann(GiFacet m, double alpha);

/* Draws m about n with the density D cos (Walter et al. 2007, equations 28 and 29). */
GiVec gi_microfacet_beckmann_draw(GiVec n, double alpha, double u1, double u2);
