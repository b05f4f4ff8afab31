/* SPDX-License-Identifier: MIT
 * The way of most elements of a large scene: a surface that differs from one before it in its
 * numbers and its shader only. How each hole of the pattern is to be used is found out once; from
 * then on nothing is looked up but the shader's name.
 *
 * Only what is certainly right goes this way. Where anything else is found, or nobody knows what to
 * do with such an element, nothing has happened, and the element goes the usual way, token by
 * token, as if this were not here. */
#include "reader/state.h"

/* Whether the pattern is a surface with a type and nothing else, and its children are some of its
 * values and its shader. */
static bool find_uses(GiReader *reader, const GiTape *tape, const GiPattern *pattern,
    const char *bytes, GiPath *path) {
    const GiTapeEntry *entry = tape->entries.data + pattern->first;
    GiToken tag = entry[0].token;
    if (tag.count != 1) return false;
    GiSpan name = {bytes + tag.at + 1, tag.size - 1u};
    GiSpan attribute = {bytes + entry[1].token.at, entry[1].token.size};
    GiSpan value = {bytes + entry[2].token.at, entry[2].token.size};
    path->element = gi_element_find(&reader->elements, name, path->contexts);
    if (path->element == NULL || path->element->kind != GI_KIND_SURFACE) return false;
    path->type = gi_span_is(attribute, "type") ? gi_type_find(value, GI_KIND_SURFACE) : NULL;
    if (path->type == NULL || path->type->value == GLINT_SURFACE_GROUP ||
        path->type->value == GLINT_SURFACE_MESH) {
        return false;
    }
    path->evidence = path->element->evidence | path->type->evidence;
    entry += 3;
    for (int i = 0; i < pattern->hole_count; i++) {
        GiToken child = entry[0].token;
        int count = pattern->holes[i].count;
        name = (GiSpan){bytes + child.at + 1, child.size - 1u};
        const GiElement *element = gi_element_find(&reader->elements, name, path->type->context);
        if (element == NULL) return false;
        if (count > 0) {
            bool kept = (gi_object_slots(GI_KIND_SURFACE) >> element->slot & 1) != 0;
            if (!kept || element->slot == GI_SLOT_DATA) return false;
        } else {
            attribute = (GiSpan){bytes + entry[1].token.at, entry[1].token.size};
            if (element->kind != GI_KIND_SHADER || !gi_span_is(attribute, "ref")) return false;
        }
        path->uses[i] = element;
        path->offsets[i] = pattern->holes[i].begin - (child.at - tag.at);
        path->evidence |= element->evidence;
        entry += count > 0 ? 3 + count : 4;
    }
    return true;
}

/* What is to be done with elements like the pattern where the innermost open element is; null when
 * nobody knows. */
static const GiPath *find_path(
    GiReader *reader, const GiTape *tape, int number, const char *bytes, const GiFrame *parent) {
    GiPath *path = &reader->paths[number];
    if (path->contexts != parent->contexts) {
        *path = (GiPath){.contexts = parent->contexts};
        path->known = find_uses(reader, tape, &tape->patterns[number], bytes, path);
    }
    return path->known ? path : NULL;
}

static bool use_shader(GiReader *reader, GiSpan name, uint32_t *shader) {
    const GiNamed *named = gi_names_get(&reader->names, name);
    if (named == NULL || named->broken || !gi_kind_fits((GiKind)named->kind, GI_KIND_SHADER)) {
        return false;
    }
    *shader = named->index;
    return true;
}

bool gi_like_play(
    GiReader *reader, const GiTape *tape, const GiTapeEntry *entry, const char *bytes) {
    if (reader->frames.count == 0 || reader->frames.count + 2 > GI_DEPTH_LIMIT) return false;
    GiFrame *parent = gi_reader_top(reader);
    GiToken like = (entry++)->token;
    if (parent->skip != GI_SKIP_NONE) return false;
    const GiPath *path = find_path(reader, tape, like.size, bytes, parent);
    if (path == NULL) return false;
    uint32_t none = (uint32_t)reader->tags.count - 1; /* the end of a tag: an empty string */
    GiFrame frame = {.place.offset = tape->begin + like.at,
        .element = path->element,
        .type = path->type,
        .contexts = path->type->context,
        .tag = none,
        .name = none};
    gi_object_begin(reader, &frame);
    for (int i = 0; i < like.count; i++) {
        GiToken hole = (entry++)->token;
        if (hole.kind == GI_TOKEN_SPAN) {
            GiSpan name = {bytes + hole.at, hole.size};
            if (!use_shader(reader, name, &frame.index)) return false;
            continue;
        }
        GiVec value = gi_tape_vec(entry, hole.count);
        if (!gi_value_fits(path->uses[i], value, hole.count)) return false;
        GiPlace place = {.offset = tape->begin + hole.at - path->offsets[i]};
        gi_reader_put(reader, path->uses[i]->slot, value, place);
        entry += hole.count;
    }
    reader->evidence |= path->evidence;
    gi_object_finish(reader, &frame, parent);
    if (reader->report.out_of_memory) gi_reader_out_of_memory(reader);
    return true;
}
