/* SPDX-License-Identifier: MIT
 * The events of the parser: opens and closes frames, knows which element may stand where and what
 * the attributes mean. What the elements amount to is decided in object.c. */
#include "reader/state.h"

#include "reader/suggest.h"

#include <string.h>

/* ---------------------------------------------------------------- places in a start tag */

static bool is_blank(unsigned unit) {
    return unit == ' ' || unit == '\t' || unit == '\n' || unit == '\r';
}

GiPlace gi_tree_attribute(GiReader *reader, int index, bool value, int *length) {
    const GiWindow *window = &reader->window;
    GiPlace tag = gi_reader_top(reader)->place;
    int unit = gi_window_unit(window);
    int64_t p = tag.offset + unit;
    *length = 1;
    while (gi_window_at(window, p) != GI_WINDOW_END && !is_blank(gi_window_at(window, p)))
        p += unit;
    for (int i = 0;; i++) {
        while (is_blank(gi_window_at(window, p))) p += unit;
        int64_t name = p;
        unsigned c;
        while ((c = gi_window_at(window, p)) != '=' && !is_blank(c)) {
            /* An attribute that is not written here has its default from the DTD. */
            if (c == GI_WINDOW_END || c == '>' || c == '/') return tag;
            p += unit;
        }
        if (i == index && !value) {
            *length = (int)((p - name) / unit);
            return (GiPlace){.offset = name};
        }
        while (is_blank(gi_window_at(window, p))) p += unit;
        p += unit;
        while (is_blank(gi_window_at(window, p))) p += unit;
        unsigned quote = gi_window_at(window, p);
        int64_t begin = p += unit;
        while ((c = gi_window_at(window, p)) != quote) {
            if (c == GI_WINDOW_END) return tag;
            p += unit;
        }
        if (i == index) {
            /* In characters, but an attribute of more than a screen needs no exact length. */
            int limit = (int)((p - begin) / unit < 100 ? (p - begin) / unit : 100);
            *length = 0;
            for (int64_t q = begin; q < p && *length < limit; q += unit) {
                unsigned d = gi_window_at(window, q);
                *length += unit == 2 ? (d & 0xfc00) != 0xdc00 : (d & 0xc0) != 0x80;
            }
            return (GiPlace){.offset = begin};
        }
        p += unit;
    }
}

/* ---------------------------------------------------------------- frames */

static bool push_text(GiReader *reader, GiSpan text, uint32_t *index) {
    if (reader->tags.count > UINT32_MAX / 2 ||
        !gi_array_reserve(reader->memory, &reader->tags, text.size + 1)) {
        return false;
    }
    *index = (uint32_t)reader->tags.count;
    memcpy(reader->tags.data + *index, text.data, text.size);
    reader->tags.data[*index + text.size] = '\0';
    reader->tags.count += text.size + 1;
    return true;
}

static GiFrame *push_frame(GiReader *reader, GiSpan tag, int64_t offset) {
    enum { TAG_SHOWN = 80 };
    if (reader->frames.count >= GI_DEPTH_LIMIT) {
        gi_report_add(&reader->report, (GiPlace){.offset = offset}, 1,
            "elements are nested more than %d deep", GI_DEPTH_LIMIT);
        gi_reader_stop(reader);
        return NULL;
    }
    if (reader->tags.count > UINT32_MAX / 2 ||
        !gi_array_reserve(reader->memory, &reader->frames, 1) ||
        !gi_array_reserve(reader->memory, &reader->tags, TAG_SHOWN + 1)) {
        gi_reader_out_of_memory(reader);
        return NULL;
    }
    char *copy = reader->tags.data + reader->tags.count;
    size_t length = tag.size < TAG_SHOWN ? tag.size : TAG_SHOWN;
    gi_span_copy((GiSpan){tag.data, length}, copy);
    copy[length] = '\0';
    /* Written where it stays: copying what was just put together member by member stalls. */
    GiFrame *frame = &reader->frames.data[reader->frames.count++];
    memset(frame, 0, sizeof *frame);
    frame->place.offset = offset;
    frame->tag = (uint32_t)reader->tags.count;
    frame->name = frame->tag + (uint32_t)length; /* an empty string, until there is a name */
    reader->tags.count += length + 1;
    return frame;
}

static void pop_frame(GiReader *reader) {
    reader->tags.count = gi_reader_top(reader)->tag;
    reader->frames.count--;
}

/* ---------------------------------------------------------------- unknown elements */

static void place_words(const GiFrame *parent, char *buffer, size_t size) {
    GiContexts contexts = parent->type != NULL ? parent->type->context : parent->contexts;
    gi_context_text(contexts, buffer, size);
}

static bool is_scene(GiSpan tag) {
    return tag.size == 5 && gi_edit_distance(tag.data, 5, "scene", 5, 0) == 0;
}

/* What is said of an element that may not stand here. Returns the element that was probably meant,
 * so that its content is still checked; null when there is no telling. */
static const GiElement *report_element(
    GiReader *reader, const GiFrame *parent, GiSpan tag, GiPlace place) {
    if (gi_report_is_full(&reader->report)) {
        reader->report.error_count++;
        return NULL;
    }
    GiReport *report = &reader->report;
    int length = 1 + gi_text_length(tag.data, tag.size < 80 ? tag.size : 80);
    char quote[GI_QUOTE_SIZE], here[240], there[240];
    gi_quote(quote, tag.data, tag.size);
    if (parent == NULL) {
        gi_report_add(report, place, length, "the root element must be `scene`; found `%s`", quote);
        GiSuggestion root = gi_suggestion_begin(tag.data, tag.size);
        gi_suggestion_offer(&root, "scene");
        return root.best != NULL ? &gi_elements[0] : NULL;
    }
    if (!gi_kind_is_object(parent->element->kind)) {
        gi_report_add(report, place, length, "`%s` cannot stand here: %s holds %s, no elements",
            quote, parent->element->name, gi_kind_text(parent->element->kind));
        return NULL;
    }
    place_words(parent, here, sizeof here);
    const GiElement *elsewhere = gi_element_find(&reader->elements, tag, GI_ANYWHERE);
    if (elsewhere == NULL && is_scene(tag)) {
        gi_report_add(
            report, place, length, "`scene` is the root element and cannot stand in %s", here);
        return NULL;
    }
    if (elsewhere != NULL) {
        GiContexts contexts = 0;
        for (const GiElement *e = gi_elements; e->name != NULL; e++) {
            if (strcmp(e->name, elsewhere->name) == 0) contexts |= e->contexts;
        }
        gi_context_text(contexts, there, sizeof there);
        if (here[0] == '\0') {
            gi_report_add(report, place, length, "`%s` cannot stand here; it belongs in %s",
                elsewhere->name, there);
        } else {
            gi_report_add(report, place, length, "`%s` cannot stand in %s; it belongs in %s",
                elsewhere->name, here, there);
        }
        return NULL;
    }
    GiSuggestion suggestion = gi_suggestion_begin(tag.data, tag.size);
    for (const GiElement *e = gi_elements; e->name != NULL; e++) {
        if ((e->contexts & parent->contexts) != 0) gi_suggestion_offer(&suggestion, e->name);
    }
    if (suggestion.best != NULL) {
        gi_report_add(report, place, length, "unknown element `%s` in %s: did you mean `%s`?",
            quote, here, suggestion.best);
        return gi_element_find(&reader->elements, gi_span(suggestion.best), parent->contexts);
    }
    for (const GiElement *e = gi_elements; e->name != NULL; e++) {
        gi_suggestion_offer(&suggestion, e->name);
    }
    if (suggestion.best != NULL && strcmp(suggestion.best, "scene") != 0) {
        const GiElement *near =
            gi_element_find(&reader->elements, gi_span(suggestion.best), GI_ANYWHERE);
        gi_context_text(near->contexts, there, sizeof there);
        gi_report_add(report, place, length,
            "unknown element `%s` in %s: `%s` is near, but belongs in %s", quote, here, near->name,
            there);
        return NULL;
    }
    gi_report_add(report, place, length, "unknown element `%s` in %s", quote, here);
    return NULL;
}

/* ---------------------------------------------------------------- attributes */

typedef struct Attributes {
    GiSpan name, ref, type, dialect; /* data null: not given */
    int name_index, ref_index, type_index, dialect_index;
} Attributes;

static void report_attribute(GiReader *reader, const GiElement *element, GiSpan name, int index) {
    if (gi_report_is_full(&reader->report)) {
        reader->report.error_count++;
        return;
    }
    bool object = gi_kind_is_object(element->kind), scene = element->kind == GI_KIND_SCENE;
    int length;
    GiPlace place = gi_tree_attribute(reader, index, false, &length);
    char quote[GI_QUOTE_SIZE];
    gi_quote(quote, name.data, name.size);
    GiSuggestion suggestion = gi_suggestion_begin(name.data, name.size);
    gi_suggestion_offer(&suggestion, "name");
    if (!scene) gi_suggestion_offer(&suggestion, "ref");
    if (object && !scene) gi_suggestion_offer(&suggestion, "type");
    if (scene) gi_suggestion_offer(&suggestion, "dialect");
    if (suggestion.best != NULL) {
        gi_report_add(&reader->report, place, length,
            "unknown attribute `%s` of %s: did you mean `%s`?", quote, element->name,
            suggestion.best);
        return;
    }
    gi_report_add(&reader->report, place, length, "unknown attribute `%s`: %s takes %s", quote,
        element->name,
        scene    ? "dialect"
        : object ? "type, name and ref"
                 : "name and ref, and its value as text");
}

static bool read_attributes(GiReader *reader, const GiElement *element, const GiAttribute *list,
    int count, Attributes *attributes) {
    bool scene = element->kind == GI_KIND_SCENE, good = true;
    for (int i = 0; i < count; i++) {
        GiSpan name = list[i].name, value = list[i].value;
        bool long_value = false;
        if (gi_span_is(name, "type") && gi_kind_is_object(element->kind) && !scene) {
            attributes->type = value;
            attributes->type_index = i;
        } else if (gi_span_is(name, "ref") && !scene) {
            attributes->ref = value;
            attributes->ref_index = i;
            long_value = value.size > GI_NAME_LIMIT;
        } else if (gi_span_is(name, "name")) {
            attributes->name = value;
            attributes->name_index = i;
            long_value = value.size > GI_NAME_LIMIT;
        } else if (gi_span_is(name, "dialect") && scene) {
            attributes->dialect = value;
            attributes->dialect_index = i;
        } else {
            report_attribute(reader, element, name, i);
            good = false;
        }
        if (long_value) {
            int length;
            GiPlace place = gi_tree_attribute(reader, i, true, &length);
            gi_report_add(&reader->report, place, length, "the %.*s of %s is longer than %d bytes",
                (int)name.size, name.data, element->name, GI_NAME_LIMIT);
            if (name.data[0] == 'n') attributes->name.data = NULL;
            good = false;
        }
    }
    return good;
}

static void read_dialect(GiReader *reader, GiSpan name, int index) {
    for (int i = 0; i < GLINT_DIALECT_COUNT; i++) {
        if (!gi_span_is(name, glint_dialect_name((GlintDialect)i))) continue;
        reader->dialect = (GlintDialect)i;
        return;
    }
    int length;
    GiPlace place = gi_tree_attribute(reader, index, true, &length);
    char quote[GI_QUOTE_SIZE];
    GiSuggestion suggestion = gi_suggestion_begin(name.data, name.size);
    for (int i = 0; i < GLINT_DIALECT_COUNT; i++) {
        gi_suggestion_offer(&suggestion, glint_dialect_name((GlintDialect)i));
    }
    gi_quote(quote, name.data, name.size);
    if (suggestion.best != NULL) {
        gi_report_add(&reader->report, place, length,
            "unknown dialect \"%s\": did you mean \"%s\"?", quote, suggestion.best);
        return;
    }
    gi_report_add(&reader->report, place, length,
        "unknown dialect \"%s\": there are auto, 2011, 2012, material, 2013, 2017, 2017b, 2018, "
        "2018b, 2019 and glint",
        quote);
}

/* Finds the type of an object, or reports. With a near miss the type that was meant is used, so
 * that what stands inside is judged by it. */
static void read_type(GiReader *reader, GiFrame *frame, const Attributes *attributes) {
    GiKind kind = frame->element->kind;
    GiSpan name = attributes->type;
    char list[240], quote[GI_QUOTE_SIZE];
    if (name.data == NULL) {
        const char *implied = frame->element->type;
        if (implied != NULL) {
            frame->type = gi_type_find(gi_span(implied), kind);
            return;
        }
        if (frame->broken) return; /* by another attribute, which may have been meant for it */
        frame->broken = true;
        gi_type_list_text(kind, list, sizeof list);
        gi_report_add(&reader->report, frame->place,
            1 + (int)strlen(reader->tags.data + frame->tag), "%s needs a type: %s",
            frame->element->name, list);
        return;
    }
    for (size_t i = name.size; i-- > 0;) {
        if (name.data[i] != '.') continue;
        name = (GiSpan){name.data + i + 1, name.size - i - 1};
        break;
    }
    frame->type = gi_type_guess(&reader->elements, name, kind);
    if (frame->type != NULL) {
        reader->evidence |= frame->type->evidence;
        return;
    }
    frame->broken = true;
    if (gi_report_is_full(&reader->report)) {
        reader->report.error_count++;
        return;
    }
    int length;
    GiPlace place = gi_tree_attribute(reader, attributes->type_index, true, &length);
    const char *noun = strchr(gi_kind_text(kind), ' ') + 1;
    gi_quote(quote, name.data, name.size);
    gi_type_list_text(kind, list, sizeof list);
    for (const GiType *type = gi_types; type->name != NULL; type++) {
        if (!gi_span_is(name, type->name)) continue;
        gi_report_add(&reader->report, place, length, "%s is %s type, but this is %s: %s", quote,
            gi_kind_text(type->kind), gi_kind_text(kind), list);
        return;
    }
    GiSuggestion suggestion = gi_suggestion_begin(name.data, name.size);
    for (const GiType *type = gi_types; type->name != NULL; type++) {
        if (type->kind == kind) gi_suggestion_offer(&suggestion, type->name);
    }
    if (suggestion.best != NULL) {
        gi_report_add(&reader->report, place, length,
            "unknown %s type \"%s\": did you mean \"%s\"?", noun, quote, suggestion.best);
        frame->type = gi_type_find(gi_span(suggestion.best), kind);
        return;
    }
    gi_report_add(&reader->report, place, length, "unknown %s type \"%s\": there %s %s", noun,
        quote, strstr(list, " or ") != NULL ? "are" : "is", list);
}

/* Whether a surface that is still open has the name. */
static bool stands_in(const GiReader *reader, GiSpan name) {
    for (size_t i = 0; i + 1 < reader->frames.count; i++) {
        const GiFrame *frame = &reader->frames.data[i];
        if (frame->element != NULL && frame->element->kind == GI_KIND_SURFACE &&
            gi_span_is(name, reader->tags.data + frame->name)) {
            return true;
        }
    }
    return false;
}

/* An attribute `ref`: the named thing takes the place of this element. */
static void read_ref(GiReader *reader, GiFrame *frame, const Attributes *attributes) {
    const GiNamed *named = gi_names_get(&reader->names, attributes->ref);
    GiFrame *parent = gi_reader_parent(reader);
    GiKind kind = frame->element->kind;
    frame->skip = GI_SKIP_IGNORED;
    if (named != NULL && !named->broken) {
        GiKind named_kind = (GiKind)named->kind;
        if (gi_kind_fits(named_kind, kind)) {
            gi_object_refer(reader, frame, parent, named);
            return;
        }
    }
    frame->broken = true;
    if (parent != NULL) parent->broken = true;
    gi_object_name(reader, frame, (GiNamed){.kind = (uint8_t)kind, .broken = true});
    if (named != NULL && named->broken) return;
    if (gi_report_is_full(&reader->report)) {
        reader->report.error_count++;
        return;
    }
    int length;
    GiPlace place = gi_tree_attribute(reader, attributes->ref_index, true, &length);
    char quote[GI_QUOTE_SIZE], near[GI_QUOTE_SIZE];
    gi_quote(quote, attributes->ref.data, attributes->ref.size);
    if (named != NULL) {
        gi_report_add(&reader->report, place, length, "\"%s\" names %s, but %s needs %s", quote,
            gi_kind_text((GiKind)named->kind), frame->element->name, gi_kind_text(kind));
        return;
    }
    if (kind == GI_KIND_SURFACE && attributes->ref.size > 0 && stands_in(reader, attributes->ref)) {
        gi_report_add(&reader->report, place, length,
            "\"%s\" names the group that this stands in: a group cannot contain itself", quote);
        return;
    }
    const char *best = gi_names_suggest(&reader->names, attributes->ref);
    if (best != NULL) {
        gi_report_add(&reader->report, place, length,
            "nothing is named \"%s\" before this line: did you mean \"%s\"?", quote,
            gi_quote(near, best, strlen(best)));
    } else {
        gi_report_add(
            &reader->report, place, length, "nothing is named \"%s\" before this line", quote);
    }
}

/* ---------------------------------------------------------------- events */

/* Names defined in what is skipped for an error: their uses must not be errors too. */
static void name_skipped(GiReader *reader, const GiAttribute *list, int count) {
    for (int i = 0; i < count; i++) {
        if (!gi_span_is(list[i].name, "name") || list[i].value.size > GI_NAME_LIMIT) continue;
        if (!gi_names_set(&reader->names, list[i].value, (GiNamed){.broken = true})) {
            gi_reader_out_of_memory(reader);
        }
    }
}

void gi_tree_start(
    GiReader *reader, GiSpan tag, const GiAttribute *list, int count, int64_t offset) {
    if (reader->stopped) return;
    GiFrame *frame = push_frame(reader, tag, offset);
    if (frame == NULL) return;
    GiFrame *parent = gi_reader_parent(reader);
    if (parent != NULL && parent->skip != GI_SKIP_NONE) {
        frame->skip = parent->skip;
        if (frame->skip == GI_SKIP_UNKNOWN) name_skipped(reader, list, count);
        return;
    }
    const GiElement *element;
    if (parent == NULL) {
        gi_report_keep_root(&reader->report, frame->place);
        element = is_scene(tag) ? &gi_elements[0] : NULL;
    } else {
        element = gi_element_guess(&reader->elements, tag, parent->contexts);
    }
    if (element == NULL) {
        /* Of a type that is not known, nobody can say what belongs in it. */
        bool judged = parent == NULL || parent->type != NULL ||
                      parent->element->kind == GI_KIND_SCENE ||
                      !gi_kind_is_object(parent->element->kind);
        if (parent != NULL) parent->broken = true;
        element = judged ? report_element(reader, parent, tag, frame->place) : NULL;
        frame->broken = true;
        if (element == NULL) {
            frame->skip = GI_SKIP_UNKNOWN;
            name_skipped(reader, list, count);
            return;
        }
    }
    frame->element = element;
    reader->evidence |= element->evidence;
    if (element->kind == GI_KIND_CAMERA) reader->camera_seen = true;
    if (element->slot == GI_SLOT_IMAGE) reader->image_seen = true;

    Attributes attributes = {.name = {NULL, 0}};
    if (count > 0 && !read_attributes(reader, element, list, count, &attributes)) {
        frame->broken = true;
    }
    if (attributes.name.data != NULL) {
        if (!push_text(reader, attributes.name, &frame->name)) {
            gi_reader_out_of_memory(reader);
            return;
        }
    }
    if (attributes.dialect.data != NULL) {
        read_dialect(reader, attributes.dialect, attributes.dialect_index);
    }
    if (attributes.ref.data != NULL) {
        read_ref(reader, frame, &attributes);
        return;
    }
    if (!gi_kind_is_object(element->kind)) {
        gi_value_begin(reader);
        return;
    }
    if (element->kind != GI_KIND_SCENE) read_type(reader, frame, &attributes);
    frame->contexts = frame->type != NULL ? frame->type->context : gi_kind_contexts(element->kind);
    gi_object_begin(reader, frame);
}

void gi_tree_end(GiReader *reader, int64_t end) {
    if (reader->stopped) return;
    GiFrame *frame = gi_reader_top(reader), *parent = gi_reader_parent(reader);
    if (frame->skip == GI_SKIP_NONE) {
        if (gi_kind_is_object(frame->element->kind)) {
            gi_object_finish(reader, frame, parent);
        } else {
            GiVec value;
            if (!frame->broken && gi_value_finish(reader, frame, &value)) {
                bool text = frame->element->kind == GI_KIND_STRING;
                gi_object_set(reader, parent, frame->element, value,
                    text ? gi_value_place(reader, frame) : frame->place);
                gi_object_name_value(reader, frame, value);
            } else {
                parent->broken = true;
                gi_object_name(reader, frame,
                    (GiNamed){.kind = (uint8_t)frame->element->kind, .broken = true});
            }
        }
    }
    if (reader->report.out_of_memory) gi_reader_out_of_memory(reader);
    pop_frame(reader);
    if (parent == NULL) reader->scene_end = end;
}

/* Text where only elements belong. */
static void check_blank(GiReader *reader, GiFrame *frame, GiSpan text, int64_t offset) {
    size_t i = 0;
    while (i < text.size && is_blank((unsigned char)text.data[i])) i++;
    if (i == text.size || frame->text_reported) return;
    frame->text_reported = true;
    if (gi_report_is_full(&reader->report)) {
        reader->report.error_count++;
        return;
    }
    /* The word is not quoted: it may be cut here by the end of a chunk. */
    GiPlace place = {.offset = offset + gi_window_span(&reader->window, text.data, i)};
    gi_report_add(&reader->report, place, 1, "text does not belong here: %s holds elements only",
        frame->element->name);
}

void gi_tree_text(GiReader *reader, GiSpan text, int64_t offset) {
    if (reader->stopped || reader->frames.count == 0) return;
    GiFrame *frame = gi_reader_top(reader);
    if (frame->skip != GI_SKIP_NONE) return;
    if (gi_kind_is_object(frame->element->kind)) {
        check_blank(reader, frame, text, offset);
    } else {
        gi_value_append(reader, text, offset);
    }
}

bool gi_tree_numbers(GiReader *reader, GiVec value, int count) {
    const GiFrame *frame = gi_reader_top(reader);
    return frame->skip != GI_SKIP_NONE || gi_value_take(reader, frame->element, value, count);
}

bool gi_tree_value(GiReader *reader, GiSpan tag, GiVec value, int count, int64_t offset) {
    if (reader->frames.count == 0 || reader->frames.count >= GI_DEPTH_LIMIT) return false;
    GiFrame *parent = gi_reader_top(reader);
    if (parent->skip != GI_SKIP_NONE) return false;
    const GiElement *element = gi_element_guess(&reader->elements, tag, parent->contexts);
    if (element == NULL || !gi_value_fits(element, value, count)) return false;
    reader->evidence |= element->evidence;
    gi_object_set(reader, parent, element, value, (GiPlace){.offset = offset});
    return true;
}
