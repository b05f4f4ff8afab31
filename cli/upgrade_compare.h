/* SPDX-License-Identifier: MIT
 * How much two texts of a scene differ as pictures. */
#pragma once

#include "content.h"

#include "glint/glint.h"

/* Draws both, at most CLI_COMPARE_SIDE pixels wide and high and with one sample each, and tells on
 * standard error how many pixels differ and by how much. The texts stand where the job's does; the
 * dialect is the old one's. Says what goes wrong. */
enum { CLI_COMPARE_SIDE = 256 };
CliStatus cli_compare_scenes(
    const CliJob *job, const CliContent *old, GlintDialect dialect, const CliContent *new);
