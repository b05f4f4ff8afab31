/* SPDX-License-Identifier: MIT
 * The text has been read without errors, so it is well-formed, and only what may stand in a camera
 * has to be told apart: elements, comments, sections of characters, instructions. */
#include "watch/camera_text.h"

#include <stdio.h>
#include <string.h>

/* The elements of a camera that are written. */
typedef enum Value {
    VALUE_POINT,
    VALUE_DIRECTION,
    VALUE_UP,
    VALUE_NORMAL,
    VALUE_DISTANCE,
    VALUE_WIDTH,
    VALUE_HEIGHT,
    VALUE_COUNT
} Value;

static const char *const names[VALUE_COUNT] = {
    "viewPoint", "viewDir", "viewUp", "projNormal", "projDistance", "viewWidth", "viewHeight"};

typedef struct Span {
    size_t begin, end;
} Span;

/* A child element of the camera; all zero: it has none of this name. */
typedef struct Child {
    Span whole;   /* from its `<` to behind its `>` */
    Span content; /* without white space at its ends */
    bool refers;  /* to a value with a name */
    bool named;
} Child;

typedef struct Camera {
    const char *text;
    size_t size;
    Span start_tag; /* of the camera */
    bool closed;    /* the start tag is all there is */
    Child children[VALUE_COUNT];
    Span last; /* the last child of any name, or the start tag */
} Camera;

/* ---------------------------------------------------------------- finding */

static bool starts(const Camera *camera, size_t at, const char *word) {
    size_t size = strlen(word);
    return camera->size - at >= size && memcmp(camera->text + at, word, size) == 0;
}

/* Behind the next such word; the end of the text when there is none. */
static size_t behind(const Camera *camera, size_t at, const char *word) {
    for (; at < camera->size; at++) {
        if (starts(camera, at, word)) return at + strlen(word);
    }
    return camera->size;
}

static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

static bool ends_name(char c) { return is_space(c) || c == '/' || c == '>'; }

/* Behind the `>` of a tag; one in a quoted value does not count. */
static size_t tag_end(const Camera *camera, size_t at) {
    for (char quote = '\0'; at < camera->size; at++) {
        char c = camera->text[at];
        if (quote != '\0') {
            if (c == quote) quote = '\0';
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '>') {
            return at + 1;
        }
    }
    return camera->size;
}

static bool has_tag_name(const Camera *camera, size_t at, const char *name) {
    size_t end = at + 1 + strlen(name);
    return starts(camera, at + 1, name) && end < camera->size && ends_name(camera->text[end]);
}

/* The value of an attribute of a start tag; false when it has none of this name. */
static bool attribute(const Camera *camera, Span tag, const char *name, Span *value) {
    size_t at = tag.begin;
    while (at < tag.end && !ends_name(camera->text[at])) at++;
    while (at < tag.end) {
        while (at < tag.end && is_space(camera->text[at])) at++;
        size_t begin = at;
        while (at < tag.end && camera->text[at] != '=') at++;
        size_t end = at;
        while (end > begin && is_space(camera->text[end - 1])) end--;
        while (at < tag.end && camera->text[at] != '"' && camera->text[at] != '\'') at++;
        if (at >= tag.end) return false;
        char quote = camera->text[at++];
        value->begin = at;
        while (at < tag.end && camera->text[at] != quote) at++;
        value->end = at++;
        if (end - begin == strlen(name) && memcmp(camera->text + begin, name, end - begin) == 0) {
            return true;
        }
    }
    return false;
}

/* The offset of a place: lines end with \n, \r or both, and columns are characters. */
static bool locate(const CliCameraText *place, size_t *offset) {
    size_t at = 0;
    if (place->size >= 3 && memcmp(place->text, "\xef\xbb\xbf", 3) == 0) at = 3;
    for (int64_t line = 1; line < place->line && at < place->size; at++) {
        bool pair = place->text[at] == '\r' && at + 1 < place->size && place->text[at + 1] == '\n';
        if (place->text[at] == '\n' || (place->text[at] == '\r' && !pair)) line++;
    }
    const size_t line_begin = at;
    int64_t column = 1;
    for (; at < place->size && place->text[at] != '\n' && place->text[at] != '\r'; at++) {
        bool continues = ((unsigned char)place->text[at] & 0xc0) == 0x80;
        int64_t byte_column = (int64_t)(at - line_begin) + 1;
        if (!continues && at > line_begin) column++;
        /* In files of one byte a character the columns are bytes. */
        if ((column == place->column || byte_column == place->column) && place->text[at] == '<') {
            *offset = at;
            return true;
        }
    }
    return false;
}

/* The camera's start tag. */
static bool open_camera(const CliCameraText *place, Camera *camera) {
    *camera = (Camera){.text = place->text, .size = place->size};
    size_t at;
    if (!locate(place, &at) || !has_tag_name(camera, at, "camera")) return false;
    camera->start_tag = (Span){at, tag_end(camera, at)};
    camera->closed = camera->text[camera->start_tag.end - 2] == '/';
    camera->last = camera->start_tag;
    return true;
}

bool cli_camera_text_ref(const CliCameraText *place, char *name, size_t size) {
    Camera camera;
    Span value;
    if (!open_camera(place, &camera)) return false;
    if (!attribute(&camera, camera.start_tag, "ref", &value)) return false;
    int length =
        snprintf(name, size, "%.*s", (int)(value.end - value.begin), place->text + value.begin);
    return length >= 0 && (size_t)length < size;
}

/* ---------------------------------------------------------------- the children */

/* Notes the child whose start tag this is; content_end: where its end tag begins. */
static void note_child(Camera *camera, Span tag, size_t content_end, size_t end) {
    camera->last = (Span){tag.begin, end};
    for (int value = 0; value < VALUE_COUNT; value++) {
        if (!has_tag_name(camera, tag.begin, names[value])) continue;
        Span content = {tag.end, content_end}, unused;
        while (content.begin < content.end && is_space(camera->text[content.begin])) {
            content.begin++;
        }
        while (content.end > content.begin && is_space(camera->text[content.end - 1])) {
            content.end--;
        }
        camera->children[value] = (Child){.whole = {tag.begin, end},
            .content = content,
            .refers = attribute(camera, tag, "ref", &unused),
            .named = attribute(camera, tag, "name", &unused)};
    }
}

/* Goes through the camera to its end tag; the children of children are passed by. */
static bool read_children(Camera *camera) {
    if (camera->closed) return true;
    Span tag = {0};
    int depth = 0;
    for (size_t at = camera->start_tag.end; at < camera->size;) {
        if (camera->text[at] != '<') {
            at++;
        } else if (starts(camera, at, "<!--")) {
            at = behind(camera, at + 4, "-->");
        } else if (starts(camera, at, "<![CDATA[")) {
            at = behind(camera, at, "]]>");
        } else if (starts(camera, at, "<?")) {
            at = behind(camera, at, "?>");
        } else if (starts(camera, at, "</")) {
            if (depth == 0) return true;
            size_t end = tag_end(camera, at);
            if (--depth == 0) note_child(camera, tag, at, end);
            at = end;
        } else {
            Span own = {at, tag_end(camera, at)};
            bool empty = camera->text[own.end - 2] == '/';
            if (depth == 0) tag = own;
            if (empty && depth == 0) note_child(camera, own, own.end, own.end);
            depth += !empty;
            at = own.end;
        }
    }
    return false;
}

/* ---------------------------------------------------------------- writing */

static bool is_same(const GlintCameraDesc *a, const GlintCameraDesc *b, Value value) {
    switch (value) {
    case VALUE_POINT: return memcmp(a->view_point, b->view_point, sizeof a->view_point) == 0;
    case VALUE_DIRECTION:
        return memcmp(a->view_direction, b->view_direction, sizeof a->view_direction) == 0;
    case VALUE_UP: return memcmp(a->view_up, b->view_up, sizeof a->view_up) == 0;
    case VALUE_NORMAL:
        return memcmp(a->projection_normal, b->projection_normal, sizeof a->projection_normal) == 0;
    case VALUE_DISTANCE: return a->projection_distance == b->projection_distance;
    case VALUE_WIDTH: return a->view_width == b->view_width;
    default: return a->view_height == b->view_height;
    }
}

static void format_value(const GlintCameraDesc *camera, Value value, char *text, size_t size) {
    const double *vectors[] = {
        camera->view_point, camera->view_direction, camera->view_up, camera->projection_normal};
    char number[3][CLI_CAMERA_NUMBER_SIZE];
    if (value <= VALUE_NORMAL) {
        for (int i = 0; i < 3; i++) cli_camera_number(vectors[value][i], number[i]);
        snprintf(text, size, "%s %s %s", number[0], number[1], number[2]);
        return;
    }
    cli_camera_number(value == VALUE_DISTANCE ? camera->projection_distance
                      : value == VALUE_WIDTH  ? camera->view_width
                                              : camera->view_height,
        number[0]);
    snprintf(text, size, "%s", number[0]);
}

/* The white space in front of a child, from the end of the line before. */
static Span indentation(const Camera *camera, Span child) {
    size_t begin = child.begin;
    while (begin > 0 && (camera->text[begin - 1] == ' ' || camera->text[begin - 1] == '\t')) {
        begin--;
    }
    bool own_line =
        begin > 0 && (camera->text[begin - 1] == '\n' || camera->text[begin - 1] == '\r');
    if (!own_line) return (Span){child.begin, child.begin};
    begin--;
    if (begin > 0 && camera->text[begin] == '\n' && camera->text[begin - 1] == '\r') begin--;
    return (Span){begin, child.begin};
}

/* The children that the file does not have yet. */
static void add_missing(const Camera *camera, const GlintCameraDesc *before,
    const GlintCameraDesc *after, CliBytes *result) {
    bool has_children = camera->last.begin != camera->start_tag.begin;
    Span indent = indentation(camera, camera->last);
    for (int value = 0; value < VALUE_COUNT; value++) {
        if (is_same(before, after, (Value)value) || camera->children[value].whole.end > 0) continue;
        char text[4 * CLI_CAMERA_NUMBER_SIZE];
        format_value(after, (Value)value, text, sizeof text);
        cli_bytes_add(result, camera->text + indent.begin, indent.end - indent.begin);
        if (!has_children && indent.end > indent.begin) cli_bytes_add_text(result, "  ");
        cli_bytes_format(result, "<%s>%s</%s>", names[value], text, names[value]);
    }
    if (camera->closed)
        cli_bytes_add(result, camera->text + indent.begin, indent.end - indent.begin);
}

/* The next child behind an offset that has to change; -1: none. */
static int next_change(const Camera *camera, const GlintCameraDesc *before,
    const GlintCameraDesc *after, size_t from) {
    int next = -1;
    for (int value = 0; value < VALUE_COUNT; value++) {
        const Child *child = &camera->children[value];
        if (child->whole.end == 0 || child->whole.begin < from) continue;
        if (is_same(before, after, (Value)value)) continue;
        if (next < 0 || child->whole.begin < camera->children[next].whole.begin) next = value;
    }
    return next;
}

bool cli_camera_text_replace(const CliCameraText *place, const GlintCameraDesc *before,
    const GlintCameraDesc *after, CliBytes *result, char *reason, size_t reason_size) {
    Camera camera;
    if (!open_camera(place, &camera) || !read_children(&camera)) {
        snprintf(reason, reason_size, "the camera is not found in the text of the scene");
        return false;
    }
    size_t at = 0;
    int value;
    while ((value = next_change(&camera, before, after, at)) >= 0) {
        const Child *child = &camera.children[value];
        if (child->named) {
            snprintf(reason, reason_size,
                "%s has a name, and what refers to it would change as well", names[value]);
            return false;
        }
        char text[4 * CLI_CAMERA_NUMBER_SIZE];
        format_value(after, (Value)value, text, sizeof text);
        Span old = child->refers ? child->whole : child->content;
        cli_bytes_add(result, camera.text + at, old.begin - at);
        if (child->refers) cli_bytes_format(result, "<%s>", names[value]);
        cli_bytes_add_text(result, text);
        if (child->refers) cli_bytes_format(result, "</%s>", names[value]);
        at = old.end;
    }
    if (at < camera.last.end) {
        size_t end = camera.last.end - (camera.closed ? 2 : 0);
        cli_bytes_add(result, camera.text + at, end - at);
        at = camera.last.end;
    }
    if (camera.closed) cli_bytes_add_text(result, ">");
    add_missing(&camera, before, after, result);
    if (camera.closed) cli_bytes_add_text(result, "</camera>");
    cli_bytes_add(result, camera.text + at, camera.size - at);
    if (result->failed) snprintf(reason, reason_size, "not enough memory");
    return !result->failed;
}
