/* SPDX-License-Identifier: MIT */
#include "reader/element.h"

#include "scene/scene.h"

#include <stdio.h>
#include <string.h>

#define ROUND  (GI_IN_SPHERE | GI_IN_CYLINDER | GI_IN_CONE)
#define FLAT   (GI_IN_PLANE | GI_IN_DISC)
#define SHADED (GI_IN_LAMBERTIAN | GI_IN_PHONG)

/* clang-format off */
#define ROW(name, contexts, kind, slot, default_text, ...) \
    {name, contexts, GI_KIND_##kind, GI_SLOT_##slot, default_text, __VA_ARGS__}

const GiElement gi_elements[] = {
    ROW("scene", 0, SCENE, NONE, NULL, .help = "the root element"),

    ROW("camera", GI_IN_SCENE, CAMERA, NONE, NULL, .help = "the eye and its window"),
    ROW("image", GI_IN_SCENE | GI_IN_CAMERA, INTEGER_PAIR, IMAGE, NULL, GI_CHECK_IMAGE_SIZE,
        .help = "width and height in pixels"),
    ROW("surface", GI_IN_SCENE | GI_IN_GROUP, SURFACE, NONE, NULL, .help = "something to be seen"),
    ROW("shader", GI_IN_SCENE | GI_IN_ANY_SURFACE, SHADER, NONE, NULL,
        .help = "how a surface reflects light; in the scene: a definition to refer to"),
    ROW("material", GI_IN_SCENE | GI_IN_ANY_SURFACE, SHADER, NONE, NULL,
        .evidence = GI_EVIDENCE_MATERIAL, .alias_of = "shader", .help = "older word for shader"),
    ROW("light", GI_IN_SCENE, LIGHT, NONE, NULL, .help = "a source of light"),
    ROW("samples", GI_IN_SCENE, INTEGER, SAMPLES, "1", GI_CHECK_SAMPLES,
        .help = "samples per pixel, rounded to a square grid"),
    ROW("backColor", GI_IN_SCENE, COLOR, BACK_COLOR, "0 0 0",
        .help = "linear colour of a ray that hits nothing"),
    ROW("exposure", GI_IN_SCENE, REAL, EXPOSURE, "1", .evidence = GI_EVIDENCE_EXPOSURE,
        .help = "factor of the final colour; ignored when not positive"),

    ROW("viewPoint", GI_IN_CAMERA, POINT, VIEW_POINT, "0 0 0",
        .help = "the eye; for parallel cameras the centre of the window"),
    ROW("viewDir", GI_IN_CAMERA, VECTOR, VIEW_DIR, "0 0 -1", GI_CHECK_LENGTH,
        .help = "direction to the centre of the window"),
    ROW("viewUp", GI_IN_CAMERA, VECTOR, VIEW_UP, "0 1 0", GI_CHECK_LENGTH,
        .help = "what is up in the picture"),
    ROW("projNormal", GI_IN_CAMERA, VECTOR, PROJ_NORMAL, NULL, GI_CHECK_LENGTH,
        .help = "normal of the window; opposite to viewDir when absent"),
    ROW("projDistance", GI_IN_CAMERA, REAL, PROJ_DISTANCE, "1", GI_CHECK_POSITIVE,
        .help = "distance of the window from the eye, along viewDir"),
    ROW("viewWidth", GI_IN_CAMERA, REAL, VIEW_WIDTH, "1", GI_CHECK_POSITIVE,
        .help = "width of the window"),
    ROW("viewHeight", GI_IN_CAMERA, REAL, VIEW_HEIGHT, "1", GI_CHECK_POSITIVE,
        .help = "height of the window"),

    ROW("center", ROUND, POINT, CENTER, "0 0 0", .help = "centre of the surface"),
    ROW("radius", ROUND | GI_IN_DISC, REAL, RADIUS, "1", GI_CHECK_POSITIVE,
        .help = "radius; of a cone: in the plane of its center"),
    ROW("height", GI_IN_CYLINDER | GI_IN_CONE, REAL, HEIGHT, "1", GI_CHECK_POSITIVE,
        .help = "extent along z, half of it on each side of the center"),
    ROW("tipz", GI_IN_CONE, REAL, TIPZ, "0", .help = "z of the apex"),
    ROW("theta", GI_IN_CONE, REAL, THETA, "60", GI_CHECK_ANGLE,
        .help = "full opening angle at the apex in degrees; tipz wins over it"),
    ROW("minPt", GI_IN_BOX, POINT, MIN_PT, "0 0 0", .help = "a corner"),
    ROW("maxPt", GI_IN_BOX, POINT, MAX_PT, "0 0 0", .help = "the opposite corner"),
    ROW("point", FLAT, POINT, POINT, "0 0 0", .help = "a point of the plane, the disc's centre"),
    ROW("normal", FLAT, VECTOR, NORMAL, "0 0 1", GI_CHECK_LENGTH,
        .help = "vector at right angles to the surface"),
    ROW("translate", GI_IN_GROUP, VECTOR, TRANSLATE, NULL, .help = "moves the group"),
    ROW("rotate", GI_IN_GROUP, VECTOR, ROTATE, NULL,
        .help = "turns the group by degrees about x, then y, then z"),
    ROW("scale", GI_IN_GROUP, VECTOR, SCALE, NULL, GI_CHECK_NO_ZERO,
        .help = "stretches the group; may be negative"),

    ROW("diffuseColor", SHADED, COLOR, DIFFUSE, "1 1 1",
        .help = "diffuse reflection; 0.2 0.2 0.2 when absent from a Lambertian shader of 2019"),
    ROW("color", SHADED, COLOR, DIFFUSE, "1 1 1", .alias_of = "diffuseColor",
        .help = "older word for diffuseColor"),
    ROW("specularColor", GI_IN_PHONG, COLOR, SPECULAR, "1 1 1", .help = "colour of the highlight"),
    ROW("exponent", GI_IN_PHONG, REAL, EXPONENT, "1", .help = "sharpness of the highlight"),

    ROW("position", GI_IN_ANY_LIGHT, POINT, POSITION, "0 0 0", .help = "where the light stands"),
    ROW("intensity", GI_IN_ANY_LIGHT, COLOR, INTENSITY, "1 1 1", .help = "colour of the light"),
    ROW("color", GI_IN_ANY_LIGHT, COLOR, INTENSITY, "1 1 1", .alias_of = "intensity",
        .help = "older word for intensity"),
    ROW("falloff", GI_IN_POINT_LIGHT, CHOICE, FALLOFF, NULL, .choices = "none inverse-square",
        .help = "how light weakens with distance; as the dialect has it when absent"),
    {.name = NULL},
};

#define TYPE(name, kind, context, value, ...) \
    {name, GI_KIND_##kind, GI_IN_##context, GLINT_##value, __VA_ARGS__}

const GiType gi_types[] = {
    TYPE("PerspectiveCamera", CAMERA, CAMERA, CAMERA_PERSPECTIVE, GI_EVIDENCE_CAMERA_TYPE, NULL,
        "rays start at viewPoint"),
    TYPE("ParallelCamera", CAMERA, CAMERA, CAMERA_PARALLEL, GI_EVIDENCE_CAMERA_TYPE, NULL,
        "rays run parallel to viewDir"),
    TYPE("OrthographicCamera", CAMERA, CAMERA, CAMERA_PARALLEL, GI_EVIDENCE_CAMERA_TYPE,
        "ParallelCamera", "the same as ParallelCamera"),

    TYPE("Sphere", SURFACE, SPHERE, SURFACE_SPHERE, 0, NULL, "a ball"),
    TYPE("Box", SURFACE, BOX, SURFACE_BOX, 0, NULL, "a box along the axes"),
    TYPE("Cylinder", SURFACE, CYLINDER, SURFACE_CYLINDER, 0, NULL, "along z, closed"),
    TYPE("Cone", SURFACE, CONE, SURFACE_CONE, 0, NULL, "along z, closed"),
    TYPE("Plane", SURFACE, PLANE, SURFACE_PLANE, GI_EVIDENCE_MATERIAL, NULL, "without end"),
    TYPE("Disc", SURFACE, DISC, SURFACE_DISC, GI_EVIDENCE_MATERIAL, NULL, "flat and round"),
    TYPE("Group", SURFACE, GROUP, SURFACE_GROUP, GI_EVIDENCE_SECOND_TRACER, NULL,
        "surfaces under a common transform"),

    TYPE("Lambertian", SHADER, LAMBERTIAN, SHADER_LAMBERTIAN, 0, NULL, "matte"),
    TYPE("Phong", SHADER, PHONG, SHADER_PHONG, 0, NULL, "matte with a highlight"),
    TYPE("RGBNormals", SHADER, RGB_NORMALS, SHADER_RGB_NORMALS, 0, NULL,
        "shows the normal as a colour"),

    TYPE("PointLight", LIGHT, POINT_LIGHT, LIGHT_POINT, GI_EVIDENCE_LIGHT_TYPE, NULL,
        "shines from a point, with shadows"),
    TYPE("Light", LIGHT, POINT_LIGHT, LIGHT_POINT, 0, "PointLight", "the same as PointLight"),
    TYPE("AmbientLight", LIGHT, AMBIENT_LIGHT, LIGHT_AMBIENT, GI_EVIDENCE_LIGHT_TYPE, NULL,
        "adds intensity times diffuseColor everywhere"),
    TYPE("ConstantLight", LIGHT, CONSTANT_LIGHT, LIGHT_CONSTANT, GI_EVIDENCE_LIGHT_TYPE, NULL,
        "adds diffuseColor everywhere"),
    TYPE("NormalLight", LIGHT, NORMAL_LIGHT, LIGHT_NORMAL, GI_EVIDENCE_LIGHT_TYPE, NULL,
        "adds (normal + 1) / 2 everywhere"),
    {.name = NULL},
};
/* clang-format on */

/* ---------------------------------------------------------------- finding */

/* Setting a bit makes small letters of capitals; that it also mixes up other characters does no
 * harm here. */
static unsigned hash_name(const char *name) {
    unsigned hash = 0;
    for (; *name != '\0'; name++) hash = hash * 3 + ((unsigned char)*name | 0x20u);
    return (hash ^ hash >> 7) % GI_ELEMENT_SLOT_COUNT;
}

static bool same_name(const char *a, const char *b) {
    while (*a != '\0' && (*a == *b || gi_lower(*a) == gi_lower(*b))) a++, b++;
    return *a == '\0' && *b == '\0';
}

void gi_element_index_init(GiElementIndex *index) {
    memset(index, 0, sizeof *index);
    for (unsigned row = 0; gi_elements[row].name != NULL; row++) {
        uint8_t *first = &index->first[hash_name(gi_elements[row].name)];
        index->next[row] = *first;
        *first = (uint8_t)(row + 1);
    }
}

const GiElement *gi_element_find(const GiElementIndex *index, const char *name, uint32_t contexts) {
    for (unsigned row = index->first[hash_name(name)]; row != 0; row = index->next[row - 1]) {
        const GiElement *element = &gi_elements[row - 1];
        if ((element->contexts & contexts) != 0 && same_name(element->name, name)) return element;
    }
    return NULL;
}

const GiElement *gi_element_guess(GiElementIndex *index, const char *name, uint32_t contexts) {
    uint8_t *guess = &index->after[index->last];
    const GiElement *element = *guess > 0 ? &gi_elements[*guess - 1] : NULL;
    if (element == NULL || (element->contexts & contexts) == 0 ||
        strcmp(element->name, name) != 0) {
        element = gi_element_find(index, name, contexts);
        if (element == NULL) return NULL;
        *guess = (uint8_t)(element - gi_elements + 1);
    }
    index->last = *guess;
    return element;
}

const GiType *gi_type_find(const char *name, GiKind kind) {
    for (const GiType *type = gi_types; type->name != NULL; type++) {
        if (type->kind != kind || type->name[0] != name[0]) continue;
        if (strcmp(type->name, name) == 0) return type;
    }
    return NULL;
}

/* ---------------------------------------------------------------- words */

const char *gi_kind_text(GiKind kind) {
    switch (kind) {
    case GI_KIND_REAL: return "a number";
    case GI_KIND_INTEGER: return "a whole number";
    case GI_KIND_INTEGER_PAIR: return "an image size";
    case GI_KIND_VECTOR: return "a vector";
    case GI_KIND_POINT: return "a point";
    case GI_KIND_COLOR: return "a colour";
    case GI_KIND_CHOICE: return "a word";
    case GI_KIND_SCENE: return "a scene";
    case GI_KIND_CAMERA: return "a camera";
    case GI_KIND_SURFACE: return "a surface";
    case GI_KIND_SHADER: return "a shader";
    case GI_KIND_LIGHT: break;
    }
    return "a light";
}

int gi_kind_count(GiKind kind) {
    switch (kind) {
    case GI_KIND_REAL:
    case GI_KIND_INTEGER:
    case GI_KIND_CHOICE: return 1;
    case GI_KIND_INTEGER_PAIR: return 2;
    case GI_KIND_VECTOR:
    case GI_KIND_POINT:
    case GI_KIND_COLOR: return 3;
    default: return 0;
    }
}

uint32_t gi_kind_contexts(GiKind kind) {
    switch (kind) {
    case GI_KIND_SCENE: return GI_IN_SCENE;
    case GI_KIND_CAMERA: return GI_IN_CAMERA;
    case GI_KIND_SURFACE: return GI_IN_ANY_SURFACE;
    case GI_KIND_SHADER: return GI_IN_ANY_SHADER;
    case GI_KIND_LIGHT: return GI_IN_ANY_LIGHT;
    default: return 0;
    }
}

/* Joins words as "a, b or c"; the caller says how many there will be. */
typedef struct Enumeration {
    char *buffer;
    size_t size, length;
    int index, count;
} Enumeration;

static void enumerate(Enumeration *list, const char *word) {
    const char *joint = list->index == 0 ? "" : list->index + 1 == list->count ? " or " : ", ";
    list->index++;
    int written =
        snprintf(list->buffer + list->length, list->size - list->length, "%s%s", joint, word);
    if (written > 0) list->length += (size_t)written;
    if (list->length >= list->size) list->length = list->size - 1;
}

static bool listed(const GiType *type, GiKind kind, uint32_t contexts) {
    return type->kind == kind && type->alias_of == NULL && (type->context & contexts) != 0;
}

static void list_types(GiKind kind, uint32_t contexts, Enumeration *list) {
    list->index = list->count = 0;
    for (const GiType *type = gi_types; type->name != NULL; type++) {
        list->count += listed(type, kind, contexts);
    }
    for (const GiType *type = gi_types; type->name != NULL; type++) {
        if (listed(type, kind, contexts)) enumerate(list, type->name);
    }
}

void gi_type_list_text(GiKind kind, char *buffer, size_t size) {
    Enumeration list = {.buffer = buffer, .size = size};
    buffer[0] = '\0';
    list_types(kind, UINT32_MAX, &list);
}

/* Whether "an" goes before the word; "RGB" is spelled, so that it begins with a vowel. */
static bool takes_an(const char *word) {
    bool spelled = word[0] >= 'A' && word[0] <= 'Z' && word[1] >= 'A' && word[1] <= 'Z';
    return word[0] != '\0' && strchr(spelled ? "AEFHILMNORSX" : "AEIOUaeiou", word[0]) != NULL;
}

void gi_context_text(uint32_t contexts, char *buffer, size_t size) {
    static const GiKind kinds[] = {
        GI_KIND_SCENE, GI_KIND_CAMERA, GI_KIND_SURFACE, GI_KIND_SHADER, GI_KIND_LIGHT};
    Enumeration list = {.buffer = buffer, .size = size};
    buffer[0] = '\0';
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        list.count += (contexts & gi_kind_contexts(kinds[i])) != 0;
    }
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        uint32_t all = gi_kind_contexts(kinds[i]), some = contexts & all;
        if (some == 0) continue;
        if (kinds[i] == GI_KIND_SCENE) {
            enumerate(&list, "the scene");
        } else if (some == all) {
            enumerate(&list, gi_kind_text(kinds[i]));
        } else {
            char types[200], phrase[240];
            Enumeration inner = {.buffer = types, .size = sizeof types};
            list_types(kinds[i], some, &inner);
            const char *noun = strchr(gi_kind_text(kinds[i]), ' ') + 1;
            bool named = kinds[i] == GI_KIND_LIGHT; /* "PointLight" says it */
            snprintf(phrase, sizeof phrase, "%s %s%s%s", takes_an(types) ? "an" : "a", types,
                named ? "" : " ", named ? "" : noun);
            enumerate(&list, phrase);
        }
    }
}
