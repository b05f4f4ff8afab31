/* SPDX-License-Identifier: MIT
 * Samples as scene files, with the same digits in every format. */
#pragma once

#include "samples/sample.h"

#include <stdio.h>

/* Each writes the whole scene. The caller opens and closes the file and asks ferror. beside: the
 * name of the file with the sample's mesh or sky; null: it has none, or the format holds meshes
 * itself. */
void sample_write_xml(const Sample *sample, const char *beside, FILE *file);

/* Tachyon 0.99. Only for spheres and meshes: it has no closed cylinders and no cones. */
void sample_write_tachyon(const Sample *sample, const char *beside, FILE *file);

/* POV-Ray 3.7. Not for groups, glass, and lights other than points. */
void sample_write_povray(const Sample *sample, const char *beside, FILE *file);

/* What an XML file names. */
void sample_write_obj(const Sample *sample, FILE *file);
void sample_write_sky(FILE *file); /* PFM */
