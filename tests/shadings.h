/* SPDX-License-Identifier: MIT
 * Surfaces to shade, for the tests of src/shade: a shader with a normal and a viewer, and the
 * sphere to integrate over. */
#pragma once

#include "random.h"

#include "shade/bsdf.h"

/* Every year with rules of its own. */
#define SHADING_FIRST_YEAR GLINT_DIALECT_2011
#define SHADING_LAST_YEAR  GLINT_DIALECT_GLINT

GiVec shading_direction(Random *random); /* unit, uniform over the sphere */

/* At an angle to the axis z and in the plane of x and z. */
GiVec shading_slant(double degrees);

/* A shader of that type with random colours and random but usual parameters. */
GiShader shading_random_shader(Random *random, GlintShaderType type);

/* The normal is z. */
GiShading shading_of(const GiShader *shader, GlintDialect year, GiVec toward_viewer);

/* The integral of f over the sphere, by the midpoint rule in angle from and about z with
 * 2 rows^2 points for each hemisphere, so that the horizon lies between two rows. */
typedef double ShadingFunction(const GiShading *at, GiVec l);
double shading_integral(const GiShading *at, ShadingFunction *function, int rows);

/* The same over the angles from (of a half turn) low_row to high_row and (of a turn) low_column to
 * high_column. */
double shading_integral_part(const GiShading *at, ShadingFunction *function, const double row[2],
    const double column[2], int steps);

/* Two of the functions to integrate; the first gives the red part. */
double shading_evaluate_red(const GiShading *at, GiVec l);
double shading_density(const GiShading *at, GiVec l);
