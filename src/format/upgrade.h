/* SPDX-License-Identifier: MIT
 * From the rules of any dialect to those of `glint`. The rules of both are compared member by
 * member, never the dialects, so that a year that shares a rule needs nothing for it. */
#pragma once

#include "base/error.h"
#include "format/edit.h"

typedef struct GiUpgradeNote {
    GlintChangeKind kind;
    size_t offset; /* in the old text */
    size_t text;   /* into texts; with a zero */
    size_t order;
} GiUpgradeNote;

typedef struct GiUpgrade {
    const GiDocument *document;
    GiMemory *memory;
    const GiRules *from, *to;
    GiEdits edits;
    GI_ARRAY(GiUpgradeNote) notes;
    GI_ARRAY(char) texts;
    GI_ARRAY(size_t) targets; /* a token each: what it stands for, itself or what its ref names */
    bool has_points;          /* lights whose E is not a radiance */
    bool has_large;           /* rectangles or an environment, and an integrator that sees them */
    bool failed;              /* memory is short */
} GiUpgrade;

/* Upgrades a document and appends the new text; tells the changes. Errors: MEMORY. */
GlintStatus gi_upgrade_write(
    const GiDocument *document, GlintChangeFn change, void *user, GiText *text, GlintError *error);

/* ---- the parts of it */

/* Says what changes at a token: printf. */
GI_PRINTF(4, 5)
void gi_upgrade_note(
    GiUpgrade *upgrade, GlintChangeKind kind, size_t token, const char *format, ...);

/* The name that an element is going to have. */
const char *gi_upgrade_name(const GiUpgrade *upgrade, size_t token);

/* The last child for a slot, or GI_NO_TOKEN. */
size_t gi_upgrade_child(const GiUpgrade *upgrade, size_t token, GiSlot slot);

/* The numbers of a value element, or of what its ref names. False: they are not plain. */
bool gi_upgrade_numbers(const GiUpgrade *upgrade, size_t token, int count, double *values);

/* What stands between the tags of a value element, or of the one that its ref names. */
GiSpan gi_upgrade_content(const GiUpgrade *upgrade, size_t token);

/* Three numbers as text that reads back as the same. */
enum { GI_UPGRADE_TEXT_SIZE = 200 };
void gi_upgrade_format(const double values[3], char text[GI_UPGRADE_TEXT_SIZE]);

/* Gives the child for a slot the value old times factor; `fallback` when there is no child. False:
 * its value is not known, and nothing is changed. */
bool gi_upgrade_scale(GiUpgrade *upgrade, size_t token, GiSlot slot, const char *child_name,
    const double fallback[3], double factor);

void gi_upgrade_light(GiUpgrade *upgrade, size_t token);
void gi_upgrade_shader(GiUpgrade *upgrade, size_t token);
/* A surface that is no group: it may need a shader. */
void gi_upgrade_surface(GiUpgrade *upgrade, size_t token);
/* A value element: what its ref names may have moved. */
void gi_upgrade_value(GiUpgrade *upgrade, size_t token);
/* The index-th group. */
void gi_upgrade_group(GiUpgrade *upgrade, size_t token, uint32_t index);
