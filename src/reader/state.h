/* SPDX-License-Identifier: MIT
 * What the reader knows in the middle of a file. The open elements form a stack of frames on the
 * heap; the values of the object being read stand in slots, one per meaning. One set of slots is
 * enough, since objects with slots do not nest within their own kind, with two exceptions: groups,
 * which keep nothing in slots, and glazing, whose one value waits in its frame. */
#pragma once

#include "reader/crew.h"
#include "reader/element.h"
#include "reader/files.h"
#include "reader/name.h"
#include "reader/reader.h"
#include "reader/report.h"
#include "reader/scan.h"
#include "scene/scene.h"

#include <expat.h>

enum {
    GI_DEPTH_LIMIT = 100000,
    GI_NAME_LIMIT = 4096,  /* bytes of a name or ref */
    GI_TEXT_LIMIT = 4096,  /* characters of a value, runs of white space counted once */
    GI_SEGMENT_LIMIT = 256 /* pieces of a value whose places are told apart */
};

typedef enum GiSkip {
    GI_SKIP_NONE,
    GI_SKIP_IGNORED, /* content of an element with a ref */
    GI_SKIP_UNKNOWN  /* content of something that is not known; its names count as broken */
} GiSkip;

typedef struct GiFrame {
    GiPlace place;            /* of its `<` */
    const GiElement *element; /* null when skipped */
    const GiType *type;       /* null: none, or not known */
    GiContexts contexts;      /* of its children */
    double refraction;        /* of glazing, while its substrate is read; 0: not given */
    uint32_t index;           /* a group's index, or a surface's shader */
    uint32_t tag, name;       /* into tags: the tag as written, the name attribute ("" for none) */
    uint8_t skip;             /* GiSkip */
    bool broken;              /* an error inside is reported: do not check the whole */
    bool text_reported;
} GiFrame;

/* A piece of a value's text that stands in the file without interruption. */
typedef struct GiSegment {
    size_t index; /* into text */
    GiPlace place;
} GiSegment;

typedef struct GiSlotValue {
    GiVec value;
    GiPlace place;
} GiSlotValue;

/* A group whose transform is good in one order of its steps only. */
typedef struct GiDoubtfulGroup {
    uint32_t group;
    GiPlace place;
} GiDoubtfulGroup;

/* What is done with the elements that are like a pattern of the tape (like.c). */
typedef struct GiPath {
    GiContexts contexts; /* where they stand; 0: nothing is known yet */
    bool known;          /* how they are to be used */
    const GiElement *element;
    const GiType *type;
    unsigned evidence;
    const GiElement *uses[GI_HOLE_LIMIT]; /* the children with the holes */
    uint32_t offsets[GI_HOLE_LIMIT];      /* from a child to its hole */
} GiPath;

typedef struct GiReader {
    const GiReaderSource *source;
    GiScene *scene;
    GiMemory *memory;
    GiScanner scanner;
    GiTape tape;          /* what is scanned, when one thread does all */
    GiCrew *crew;         /* null: one thread does all */
    bool crew_considered; /* whether there is need of more */
    int64_t scan_begin;   /* where the others began to scan, */
    GiPlace next_keep;    /* and where the window will begin when that is played */
    int64_t digested;     /* the digest is that of the bytes before it */
    uint64_t digest;
    GiPath paths[GI_PATTERN_LIMIT];   /* for the patterns of the tape that is played */
    XML_Parser parser;                /* null: the scanner still understands the file */
    int64_t parser_shift;             /* from the parser's offsets to those of the file */
    GI_ARRAY(GiAttribute) attributes; /* of the start tag that is being handled */
    GiElementIndex elements;
    GiWindow window;
    GiReport report;
    GiNames names;
    GiNames strings; /* each text once, with the file that it names when that is loaded */
    GiFiles files;
    GI_ARRAY(GiFrame) frames;
    GI_ARRAY(char) tags;
    GI_ARRAY(GiCamera) cameras; /* the named ones */
    GI_ARRAY(GiDoubtfulGroup) doubtful;
    size_t doubtful_located; /* so many of them have a line */
    GiSlotValue slots[GI_SLOT_COUNT];
    uint64_t given;                       /* a bit per slot */
    GiVec row_defaults[GI_ELEMENT_LIMIT]; /* of the table's rows */
    GiVec defaults[GI_SLOT_COUNT];
    const GiType *type; /* defaults and required are those of this type */
    uint64_t required;  /* a bit per slot */
    unsigned evidence;
    GlintDialect dialect; /* the attribute of the scene */
    int64_t scene_end;    /* offset behind `</scene>` */
    bool stopped;         /* no event counts any more */
    bool out_of_memory;
    GlintStatus file_status; /* CANCELLED or THREAD when that happened while a file was loaded */
    bool camera_seen, image_seen; /* with or without errors */
    char encoding[40];            /* as declared */

    char text[GI_TEXT_LIMIT];
    size_t text_size;
    int64_t text_next; /* offset at which a further piece continues the last segment */
    bool text_overflow;
    bool value_ready; /* `value` is what the text, all of it, says */
    GiVec value;
    GiSegment segments[GI_SEGMENT_LIMIT];
    size_t segment_count;
} GiReader;

static inline GiFrame *gi_reader_top(GiReader *reader) {
    return &reader->frames.data[reader->frames.count - 1];
}
/* The frame below the top one, or null. */
static inline GiFrame *gi_reader_parent(GiReader *reader) {
    size_t count = reader->frames.count;
    return count < 2 ? NULL : &reader->frames.data[count - 2];
}
static inline bool gi_reader_is_named(const GiReader *reader, const GiFrame *frame) {
    return reader->tags.data[frame->name] != '\0';
}
static inline bool gi_reader_is_given(const GiReader *reader, GiSlot slot) {
    return (reader->given >> slot & 1) != 0;
}

static inline GiVec gi_reader_slot(const GiReader *reader, GiSlot slot) {
    return gi_reader_is_given(reader, slot) ? reader->slots[slot].value : reader->defaults[slot];
}
static inline void gi_reader_put(GiReader *reader, GiSlot slot, GiVec value, GiPlace place) {
    reader->slots[slot] = (GiSlotValue){value, place};
    reader->given |= UINT64_C(1) << slot;
}

/* ---- reader.c */
void gi_reader_stop(GiReader *reader);
void gi_reader_out_of_memory(GiReader *reader);

/* ---- tape.c */
void gi_tape_play(GiReader *reader, const GiTape *tape);
/* The numbers behind a token, up to three. */
static inline GiVec gi_tape_vec(const GiTapeEntry *numbers, int count) {
    return gi_vec(
        numbers[0].number, count > 1 ? numbers[1].number : 0, count > 2 ? numbers[2].number : 0);
}

/* ---- like.c */
/* Takes an element like a pattern, an entry of the tape; bytes are where the tape begins. False,
 * and nothing has happened, when it must go the usual way. */
bool gi_like_play(
    GiReader *reader, const GiTape *tape, const GiTapeEntry *entry, const char *bytes);

/* ---- parser.c */
/* Makes expat ready to go on where the scanner stopped. False when memory is short. */
bool gi_parser_open(GiReader *reader);
void gi_parser_close(GiReader *reader);
/* Hands bytes to expat; `last`: the file ends with them. False when it stopped, for what it says is
 * malformed or since the reader stopped it. */
bool gi_parser_feed(GiReader *reader, const void *bytes, size_t size, bool last);
/* Where the event that is being handled, or what is wrong, begins in the file. */
int64_t gi_parser_offset(const GiReader *reader);

/* ---- tree.c: the events of a document, each with its offset in the file */
void gi_tree_start(
    GiReader *reader, GiSpan tag, const GiAttribute *list, int count, int64_t offset);
void gi_tree_end(GiReader *reader, int64_t end); /* the offset behind the tag */
void gi_tree_text(GiReader *reader, GiSpan text, int64_t offset);
/* An element's whole content, read already. False when it is to be given as text, since it is not
 * the value that belongs there. */
bool gi_tree_numbers(GiReader *reader, GiVec value, int count);
/* An element without attributes that holds nothing but numbers, all three events in one. False, and
 * nothing has happened, when they are to be given one by one: it is not a correct value that may
 * stand here. */
bool gi_tree_value(GiReader *reader, GiSpan tag, GiVec value, int count, int64_t offset);
/* The place of an attribute's name (or of its value) in the start tag that is being handled; length
 * in characters. The tag itself when it cannot be found. */
GiPlace gi_tree_attribute(GiReader *reader, int index, bool value, int *length);

/* ---- value.c: text to numbers */
void gi_value_begin(GiReader *reader);
void gi_value_append(GiReader *reader, GiSpan piece, int64_t offset);
/* Reads the text of the element as its kind. False, with the error reported, when it is wrong. */
bool gi_value_finish(GiReader *reader, const GiFrame *frame, GiVec *value);
/* Whether the numbers are a correct value of the element. Some that are not real numbers are left
 * to their text. */
bool gi_value_fits(const GiElement *element, GiVec value, int count);
/* Takes them for the value of the element if they are; otherwise false, and nothing is reported. */
bool gi_value_take(GiReader *reader, const GiElement *element, GiVec value, int count);
/* Whether a value passes the element's check; otherwise reports. */
bool gi_value_check(
    GiReader *reader, const GiElement *element, GiVec value, GiPlace place, int length);
/* Where the value begins in the file; the element itself when it is empty. */
GiPlace gi_value_place(const GiReader *reader, const GiFrame *frame);
/* Numbers without checks, for the table's defaults. */
GiVec gi_value_parse_default(const char *text);

/* ---- object.c: values to the model */
/* The slots of one kind of object. */
uint64_t gi_object_slots(GiKind kind);
void gi_object_begin(GiReader *reader, GiFrame *frame);
/* Puts the defaults of a type into force. */
void gi_object_use_type(GiReader *reader, const GiType *type);
/* Whether the object has all that its type requires; otherwise reports. Uses the type. */
bool gi_object_is_complete(GiReader *reader, const GiFrame *frame);
/* A value element of the parent (may be the scene, a group or another object) has this value. */
void gi_object_set(
    GiReader *reader, GiFrame *parent, const GiElement *element, GiVec value, GiPlace place);
/* Adds the object of the frame to the model and tells the names and the parent. */
void gi_object_finish(GiReader *reader, GiFrame *frame, GiFrame *parent);
/* Reports the groups whose transform is no good in the dialect that the file turned out to have. */
void gi_object_check_groups(GiReader *reader, GlintDialect dialect);
/* Uses a named thing as if it had been written here. */
void gi_object_refer(GiReader *reader, GiFrame *frame, GiFrame *parent, const GiNamed *named);
/* Remembers what the frame stands for under its name, when it has one. Where most have none this is
 * asked before, so that nothing is put together for it. */
void gi_object_name(GiReader *reader, const GiFrame *frame, GiNamed named);
/* Remembers where an object that has just been added stands, if anybody wants to know. */
void gi_object_remember(GiReader *reader, const GiFrame *frame, GlintObjectKind kind);
/* The same of a shader that is not added, since nothing has it and nothing can refer to it. */
void gi_object_remember_idle(GiReader *reader, const GiFrame *frame);
/* Remembers a value. */
void gi_object_name_value(GiReader *reader, const GiFrame *frame, GiVec value);

/* ---- shading.c: shaders, brdfs and textures */
void gi_shading_finish_shader(GiReader *reader, GiFrame *frame, GiFrame *parent);
void gi_shading_finish_brdf(GiReader *reader, GiFrame *frame, GiFrame *parent);
void gi_shading_finish_texture(GiReader *reader, GiFrame *frame, GiFrame *parent);
/* The parent of an element that stands for a shader has it. */
void gi_shading_give(GiReader *reader, const GiFrame *frame, GiFrame *parent, uint32_t shader);

/* ---- malformed.c */
/* Reports what the parser stopped at. */
void gi_malformed_report(GiReader *reader);
