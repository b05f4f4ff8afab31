/* SPDX-License-Identifier: MIT
 * The smooth boundary between two transparent media: how much it mirrors and where light goes. c is
 * the cosine between the normal and the direction toward the viewer, on the viewer's side. */
#pragma once

#include "shade/shade.h"

/* The part of unpolarised light that is mirrored, by Fresnel's formulas for a relative index m, at
 * the cosines c before and ct behind the boundary. */
double gi_dielectric_reflectance(double c, double ct, double m);

/* The same from c alone; 1 where it is total. */
double gi_dielectric_fresnel(double c, double m);

/* Schlick's approximation (1994). */
double gi_dielectric_schlick(double c, double m);

/* The direction 2 c n - v in which v is mirrored. */
GiVec gi_dielectric_mirror(GiVec n, GiVec v, double c);

/* The cosine behind the boundary by Snell's law, e being the index before it divided by that
 * behind. False when reflection is total. */
bool gi_dielectric_cosine_behind(double c, double e, double *ct);

/* The direction -e v + (e c - ct) n of the ray behind the boundary. */
GiVec gi_dielectric_refract(GiVec n, GiVec v, double c, double ct, double e);
