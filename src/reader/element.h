/* SPDX-License-Identifier: MIT
 * What a scene may contain, as two tables: the elements and the types of the elements that have
 * one. The reader is driven by them; so are the schema, the documentation of the format and shell
 * completion, which is why a row also carries its default as text and a line of help. */
#pragma once

#include "reader/span.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The places an element can stand in, as a set: the scene, the camera, and one place per type that
 * has children. Types whose children are the same share one. */
typedef uint64_t GiContexts;

#define GI_CONTEXT(bit)          (UINT64_C(1) << (bit))
#define GI_CONTEXTS(first, last) (GI_CONTEXT((last) + 1) - GI_CONTEXT(first))

#define GI_IN_SCENE  GI_CONTEXT(0)
#define GI_IN_CAMERA GI_CONTEXT(1)

#define GI_IN_SPHERE      GI_CONTEXT(2)
#define GI_IN_BOX         GI_CONTEXT(3)
#define GI_IN_CYLINDER    GI_CONTEXT(4)
#define GI_IN_CONE        GI_CONTEXT(5)
#define GI_IN_PLANE       GI_CONTEXT(6)
#define GI_IN_DISC        GI_CONTEXT(7)
#define GI_IN_MESH        GI_CONTEXT(8)
#define GI_IN_GROUP       GI_CONTEXT(9)
#define GI_IN_ANY_SURFACE GI_CONTEXTS(2, 9)

#define GI_IN_LAMBERTIAN    GI_CONTEXT(10)
#define GI_IN_PHONG         GI_CONTEXT(11)
#define GI_IN_RGB_NORMALS   GI_CONTEXT(12)
#define GI_IN_GLAZED        GI_CONTEXT(13)
#define GI_IN_GLASS         GI_CONTEXT(14)
#define GI_IN_MICROFACET    GI_CONTEXT(15) /* of 2018, with a brdf */
#define GI_IN_MICROFACETS   GI_CONTEXT(16) /* of 2019: MicrofacetBeckmann, MicrofacetGGX */
#define GI_IN_COOK_TORRANCE GI_CONTEXT(17)
#define GI_IN_ANY_SHADER    GI_CONTEXTS(10, 17)

#define GI_IN_LAMBERTIAN_BSDF GI_CONTEXT(18)
#define GI_IN_MICROFACET_BSDF GI_CONTEXT(19)
#define GI_IN_GLASS_BSDF      GI_CONTEXT(20)
#define GI_IN_GLAZED_BSDF     GI_CONTEXT(21)
#define GI_IN_ANY_BSDF        GI_CONTEXTS(18, 21)

#define GI_IN_BRDF    GI_CONTEXT(22)
#define GI_IN_TEXTURE GI_CONTEXT(23)

#define GI_IN_POINT_LIGHT       GI_CONTEXT(24)
#define GI_IN_AMBIENT_LIGHT     GI_CONTEXT(25)
#define GI_IN_CONSTANT_LIGHT    GI_CONTEXT(26)
#define GI_IN_NORMAL_LIGHT      GI_CONTEXT(27)
#define GI_IN_DIRECTIONAL_LIGHT GI_CONTEXT(28)
#define GI_IN_RECTANGLE_LIGHT   GI_CONTEXT(29)
#define GI_IN_ANY_LIGHT         GI_CONTEXTS(24, 29)

#define GI_IN_CUBEMAP         GI_CONTEXT(30)
#define GI_IN_INTEGRATOR      GI_CONTEXT(31) /* one without children */
#define GI_IN_PATH_INTEGRATOR GI_CONTEXT(32)
#define GI_IN_ANY_INTEGRATOR  GI_CONTEXTS(31, 32)

#define GI_ANYWHERE UINT64_MAX

typedef enum GiKind {
    GI_KIND_REAL,
    GI_KIND_INTEGER,
    GI_KIND_INTEGER_PAIR,
    GI_KIND_VECTOR,
    GI_KIND_POINT,
    GI_KIND_COLOR,
    GI_KIND_CHOICE, /* one of the words in `choices`; its value is the number of the word */
    GI_KIND_STRING, /* text; its value says where the reader keeps it */
    GI_KIND_SCENE,  /* from here on: elements with children */
    GI_KIND_CAMERA,
    GI_KIND_SURFACE,
    GI_KIND_SHADER,
    GI_KIND_BSDF, /* what a shader is to the model, with types of its own */
    GI_KIND_BRDF,
    GI_KIND_TEXTURE,
    GI_KIND_LIGHT,
    GI_KIND_ENVIRONMENT,
    GI_KIND_INTEGRATOR
} GiKind;

typedef enum GiCheck {
    GI_CHECK_NONE,
    GI_CHECK_POSITIVE,
    GI_CHECK_SAMPLES, /* at most GI_SAMPLES_LIMIT; 0 is read as 1 */
    GI_CHECK_LENGTH,  /* a vector that is not zero */
    GI_CHECK_NO_ZERO, /* no component is zero */
    GI_CHECK_ANGLE,   /* between 0 and 180, both excluded */
    GI_CHECK_BIT,     /* 0 or 1 */
    GI_CHECK_DEPTH,   /* 1 to GI_PATH_LIMIT */
    GI_CHECK_IMAGE_SIZE
} GiCheck;

/* Where a value goes. Aliases share a slot. The slots of one kind of object stand together, so that
 * they are emptied together. */
typedef enum GiSlot {
    GI_SLOT_NONE,
    GI_SLOT_VIEW_POINT,
    GI_SLOT_VIEW_DIR,
    GI_SLOT_VIEW_UP,
    GI_SLOT_PROJ_NORMAL,
    GI_SLOT_PROJ_DISTANCE,
    GI_SLOT_VIEW_WIDTH,
    GI_SLOT_VIEW_HEIGHT,
    GI_SLOT_CENTER,
    GI_SLOT_RADIUS,
    GI_SLOT_HEIGHT,
    GI_SLOT_TIPZ,
    GI_SLOT_THETA,
    GI_SLOT_MIN_PT,
    GI_SLOT_MAX_PT,
    GI_SLOT_POINT,
    GI_SLOT_NORMAL,
    GI_SLOT_DATA, /* the index of the mesh */
    GI_SLOT_DIFFUSE,
    GI_SLOT_SPECULAR, /* microfacetColor too */
    GI_SLOT_EXPONENT,
    GI_SLOT_MIRROR,
    GI_SLOT_TEXTURE,   /* its index */
    GI_SLOT_SUBSTRATE, /* the index of the shader */
    GI_SLOT_BRDF,      /* type, alpha, nt */
    GI_SLOT_DISTTYPE,  /* type, and the roughness and index that it puts into force */
    GI_SLOT_ROUGHNESS, /* alpha too; from here on also a brdf's */
    GI_SLOT_REFRACTION,
    GI_SLOT_PICTURE, /* its index */
    GI_SLOT_POSITION,
    GI_SLOT_INTENSITY,
    GI_SLOT_FALLOFF,
    GI_SLOT_DIRECTION,
    GI_SLOT_UP,
    GI_SLOT_LIGHT_WIDTH,
    GI_SLOT_LIGHT_HEIGHT,
    GI_SLOT_FILENAME, /* a string */
    GI_SLOT_SCALE_FACTOR,
    GI_SLOT_MAX_DEPTH,
    GI_SLOT_IMAGE,
    GI_SLOT_SAMPLES,
    GI_SLOT_BACK_COLOR,
    GI_SLOT_EXPOSURE,
    GI_SLOT_ENVIRONMENT, /* file name (a string), scale */
    GI_SLOT_INTEGRATOR,  /* type, depth */
    GI_SLOT_TRANSLATE,
    GI_SLOT_ROTATE,
    GI_SLOT_SCALE,
    GI_SLOT_COUNT
} GiSlot;

typedef struct GiElement {
    const char *name; /* as documented; files may write it in any case */
    GiContexts contexts;
    GiKind kind;
    GiSlot slot;
    const char *default_text; /* null: there is none */
    GiCheck check;
    bool required;
    unsigned evidence;    /* a set of GiEvidence: which year it points to */
    const char *choices;  /* words separated by spaces */
    const char *alias_of; /* null, or the name of the main row */
    const char *type;     /* the one that is meant when the file says none; null: it must say */
    const char *years;    /* dialects it was made for, separated by spaces; null: all. It is in
                             glint's as well, and understood in every other */
    const char *example;  /* a value, where there is no default to show */
    const char *help;
} GiElement;

typedef struct GiType {
    const char *name; /* exact */
    GiKind kind;
    GiContexts context; /* of its children */
    int value;          /* GlintSurfaceType and so on */
    unsigned evidence;
    const char *alias_of;
    const char *help;
    const char *years; /* as above */
} GiType;

extern const GiElement gi_elements[]; /* ends with a null name; row 0 is the scene */
extern const GiType gi_types[];       /* the same */

/* A hash of the element names, made once per reader. */
enum { GI_ELEMENT_LIMIT = 128, GI_ELEMENT_SLOT_COUNT = 256 };
typedef struct GiElementIndex {
    uint8_t first[GI_ELEMENT_SLOT_COUNT]; /* row + 1 */
    uint8_t next[GI_ELEMENT_LIMIT];       /* row + 1 */
    uint8_t sizes[GI_ELEMENT_LIMIT];      /* of the names */
    uint8_t after[GI_ELEMENT_LIMIT + 1];  /* row + 1 of what came after a row last time */
    uint8_t last;                         /* row + 1 */
    const GiType *type;                   /* the last that was found, or null */
    size_t type_size;                     /* of its name */
} GiElementIndex;

void gi_element_index_init(GiElementIndex *index);

/* The element of that name (in any case) that may stand in one of the contexts, or null. */
const GiElement *gi_element_find(const GiElementIndex *index, GiSpan name, GiContexts contexts);

/* The same for the next element of a file: elements mostly follow each other as they did before. */
const GiElement *gi_element_guess(GiElementIndex *index, GiSpan name, GiContexts contexts);

/* Name exact, without the package. Null when the kind has no such type. */
const GiType *gi_type_find(GiSpan name, GiKind kind);

/* The same for the next typed element of a file, mostly of the type of the one before. */
const GiType *gi_type_guess(GiElementIndex *index, GiSpan name, GiKind kind);

/* "a point", "a surface", ... */
const char *gi_kind_text(GiKind kind);
/* How many numbers a value of that kind has; 0 for objects. */
int gi_kind_count(GiKind kind);
/* All contexts of the types of a kind of object. */
GiContexts gi_kind_contexts(GiKind kind);

static inline bool gi_kind_is_object(GiKind kind) { return kind >= GI_KIND_SCENE; }
/* Whether a thing of one kind can stand where the other is wanted: a shader and a bsdf are the same
 * to a surface, and a vector, a point and a colour are three numbers alike. */
bool gi_kind_fits(GiKind kind, GiKind wanted);

/* "the scene", "a Sphere, Cylinder or Cone surface, a camera or a Group surface". */
void gi_context_text(GiContexts contexts, char *buffer, size_t size);
/* "Sphere, Box or Cone": all types of a kind but aliases. */
void gi_type_list_text(GiKind kind, char *buffer, size_t size);

static inline char gi_lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c + 32) : c; }
