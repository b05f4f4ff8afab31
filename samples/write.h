/* SPDX-License-Identifier: MIT
 * Samples as scene files, with the same digits in every format. */
#pragma once

#include "samples/sample.h"

#include <stdio.h>

/* Each writes the whole scene. The caller opens and closes the file and asks ferror. */
void sample_write_xml(const Sample *sample, FILE *file);

/* Tachyon 0.99. Only for spheres: it has no closed cylinders and no cones. */
void sample_write_tachyon(const Sample *sample, FILE *file);

/* POV-Ray 3.7. Not for helices. */
void sample_write_povray(const Sample *sample, FILE *file);
