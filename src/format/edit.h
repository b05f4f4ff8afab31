/* SPDX-License-Identifier: MIT
 * Changes to a document's text, collected in any order and made at once. What no edit names stays
 * as it is. */
#pragma once

#include "format/document.h"

typedef struct GiEdit {
    size_t begin, end; /* of what goes, in the document's text */
    size_t text, size; /* of what comes, in the edits' text */
    size_t order;      /* edits at one place stay in theirs */
} GiEdit;

typedef struct GiEdits {
    const GiDocument *document;
    GI_ARRAY(GiEdit) list;
    GiText text;
    bool failed; /* memory is short */
} GiEdits;

void gi_edits_reset(GiEdits *edits);

/* Puts text in the place of a part of the document. Parts must not overlap. */
void gi_edit_replace(GiEdits *edits, size_t begin, size_t end, GiSpan text);

/* The same with an element as the text: its tags and what stands between them. */
void gi_edit_element(GiEdits *edits, size_t begin, size_t end, const char *name, GiSpan content);

/* Changes the name of an element, in both tags. */
void gi_edit_rename(GiEdits *edits, size_t start, const char *name);

/* Gives an element's attribute a value, or takes it away when that is null. */
void gi_edit_set_attribute(GiEdits *edits, size_t start, const char *name, const char *value);

/* Adds text as the last children of an element whose tags are called `name`: on a line of its own
 * where the first child has one. At most once for each element; several children are lines. */
void gi_edit_append(
    GiEdits *edits, size_t start, const char *name, const char *const *children, int count);

/* Appends the changed text. False when memory is, or was, short. */
bool gi_edits_apply(GiEdits *edits, GiText *text);
