/* SPDX-License-Identifier: MIT */
#include "reader/element.h"

#include "scene/scene.h"

#include <stdio.h>
#include <string.h>

#define ROUND  (GI_IN_SPHERE | GI_IN_CYLINDER | GI_IN_CONE)
#define FLAT   (GI_IN_PLANE | GI_IN_DISC)
#define MATTE  (GI_IN_LAMBERTIAN | GI_IN_PHONG)
#define FACETS (GI_IN_MICROFACET | GI_IN_MICROFACETS)
#define BSDF   (GI_IN_LAMBERTIAN_BSDF | GI_IN_MICROFACET_BSDF)

#define FROM_2013 "2013 2017 2017b 2018 2018b 2019"
#define FROM_2017 "2017 2017b 2018 2018b 2019"
#define MESHES    "2012 2017 2017b 2018 2018b 2019"
#define TEXTURES  "2017 2018 2019"
#define UNTYPED   "2011 2012 2013 2017 2018 2019" /* lights */
#define SHADERS   "2011 2012 material 2013 2017 2017b 2018 2019"
#define PHONG     "2011 2012 material 2013 2017 2017b 2019"
#define OURS      "" /* glint alone */

/* clang-format off */
#define ROW(name, contexts, kind, slot, default_text, ...) \
    {name, contexts, GI_KIND_##kind, GI_SLOT_##slot, default_text, __VA_ARGS__}

const GiElement gi_elements[] = {
    ROW("scene", 0, SCENE, NONE, NULL, .help = "the root element"),

    ROW("camera", GI_IN_SCENE, CAMERA, NONE, NULL, .type = "PerspectiveCamera",
        .help = "the eye and its window"),
    ROW("image", GI_IN_SCENE | GI_IN_CAMERA, INTEGER_PAIR, IMAGE, NULL, GI_CHECK_IMAGE_SIZE,
        .example = "640 480", .help = "width and height in pixels"),
    ROW("surface", GI_IN_SCENE | GI_IN_GROUP, SURFACE, NONE, NULL, .help = "something to be seen"),
    ROW("shader", GI_IN_SCENE | GI_IN_ANY_SURFACE, SHADER, NONE, NULL,
        .years = SHADERS,
        .help = "how a surface reflects light; in the scene: a definition to refer to"),
    ROW("material", GI_IN_SCENE | GI_IN_ANY_SURFACE, SHADER, NONE, NULL,
        .evidence = GI_EVIDENCE_MATERIAL, .alias_of = "shader", .years = "material",
        .help = "older word for shader"),
    ROW("bsdf", GI_IN_SCENE | GI_IN_ANY_SURFACE, BSDF, NONE, NULL, .evidence = GI_EVIDENCE_BSDF,
        .years = "2018b", .help = "the shader of 2018b"),
    ROW("brdf", GI_IN_SCENE | GI_IN_MICROFACET, BRDF, BRDF, NULL, .required = true,
        .evidence = GI_EVIDENCE_BRDF, .years = "2018",
        .help = "how the microfacets are distributed"),
    ROW("texture", GI_IN_SCENE | GI_IN_ANY_SHADER | GI_IN_ANY_BSDF, TEXTURE, TEXTURE, NULL,
        .evidence = GI_EVIDENCE_EXPOSURE, .years = TEXTURES,
        .help = "a picture in the place of diffuseColor"),
    ROW("light", GI_IN_SCENE, LIGHT, NONE, NULL, .type = "Light", .help = "a source of light"),
    ROW("environment", GI_IN_SCENE, ENVIRONMENT, ENVIRONMENT, NULL, .evidence = GI_EVIDENCE_BSDF,
        .years = "2018b", .help = "light from all around"),
    ROW("cubemap", GI_IN_SCENE, ENVIRONMENT, ENVIRONMENT, NULL, .type = "Cubemap",
        .evidence = GI_EVIDENCE_SECOND_TRACER, .alias_of = "environment",
        .years = "2017b", .help = "the environment of 2017b"),
    ROW("integrator", GI_IN_SCENE, INTEGRATOR, INTEGRATOR, NULL, .evidence = GI_EVIDENCE_BSDF,
        .years = "2018b", .help = "how light is gathered; LightSamplingIntegrator when absent"),
    ROW("samples", GI_IN_SCENE, INTEGER, SAMPLES, "1", GI_CHECK_SAMPLES,
        .years = "2012 2017b 2018b", .help = "samples per pixel, rounded to a square grid"),
    ROW("backColor", GI_IN_SCENE, COLOR, BACK_COLOR, "0 0 0",
        .years = FROM_2013, .help = "linear colour of a ray that hits nothing"),
    ROW("exposure", GI_IN_SCENE, REAL, EXPOSURE, "1", .evidence = GI_EVIDENCE_EXPOSURE,
        .years = FROM_2017, .help = "factor of the final colour; ignored when not positive"),

    ROW("viewPoint", GI_IN_CAMERA, POINT, VIEW_POINT, "0 0 0",
        .help = "the eye; for parallel cameras the centre of the window"),
    ROW("viewDir", GI_IN_CAMERA, VECTOR, VIEW_DIR, "0 0 -1", GI_CHECK_LENGTH,
        .help = "direction to the centre of the window"),
    ROW("viewUp", GI_IN_CAMERA, VECTOR, VIEW_UP, "0 1 0", GI_CHECK_LENGTH,
        .help = "what is up in the picture"),
    ROW("projNormal", GI_IN_CAMERA, VECTOR, PROJ_NORMAL, NULL, GI_CHECK_LENGTH,
        .example = "0 0 1", .help = "normal of the window; opposite to viewDir when absent"),
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
    ROW("tipz", GI_IN_CONE, REAL, TIPZ, "0", .years = "2012", .example = "1",
        .help = "z of the apex"),
    ROW("theta", GI_IN_CONE, REAL, THETA, "60", GI_CHECK_ANGLE,
        .years = "2011", .help = "full opening angle at the apex in degrees; tipz wins over it"),
    ROW("minPt", GI_IN_BOX, POINT, MIN_PT, "0 0 0", .help = "a corner"),
    ROW("maxPt", GI_IN_BOX, POINT, MAX_PT, "0 0 0", .example = "1 1 1",
        .help = "the opposite corner"),
    ROW("point", FLAT, POINT, POINT, "0 0 0", .help = "a point of the plane, the disc's centre"),
    ROW("normal", FLAT, VECTOR, NORMAL, "0 0 1", GI_CHECK_LENGTH,
        .help = "vector at right angles to the surface"),
    ROW("data", GI_IN_MESH, STRING, DATA, NULL, .required = true,
        .years = MESHES, .example = "teapot.obj",
        .help = "the file of the mesh, .obj, .msh or .ply"),
    ROW("translate", GI_IN_GROUP, VECTOR, TRANSLATE, NULL,
        .years = "2012 2017b 2018b", .example = "0 0 5", .help = "moves the group"),
    ROW("rotate", GI_IN_GROUP, VECTOR, ROTATE, NULL,
        .years = "2012 2017b 2018b", .example = "90 0 0",
        .help = "turns the group by degrees about x, then y, then z"),
    ROW("scale", GI_IN_GROUP, VECTOR, SCALE, NULL, GI_CHECK_NO_ZERO,
        .years = "2012 2017b 2018b", .example = "1 1 2",
        .help = "stretches the group; may be negative"),

    ROW("diffuseColor", MATTE | GI_IN_COOK_TORRANCE | BSDF, COLOR, DIFFUSE, "1 1 1",
        .help = "diffuse reflection; 0.2 0.2 0.2 when absent from a Lambertian shader of 2019"),
    ROW("diffuseColor", FACETS, COLOR, DIFFUSE, "0 0 0", .help = "diffuse reflection"),
    ROW("color", MATTE, COLOR, DIFFUSE, "1 1 1", .alias_of = "diffuseColor",
        .years = "material", .help = "older word for diffuseColor"),
    ROW("specularColor", GI_IN_PHONG | GI_IN_COOK_TORRANCE | GI_IN_MICROFACET_BSDF, COLOR, SPECULAR,
        "1 1 1", .help = "colour of the highlight"),
    ROW("exponent", GI_IN_PHONG, REAL, EXPONENT, "1", .help = "sharpness of the highlight"),
    ROW("microfacetColor", GI_IN_MICROFACET, COLOR, SPECULAR, "0 0 0",
        .help = "colour of the highlight"),
    ROW("microfacetColor", GI_IN_MICROFACETS, COLOR, SPECULAR, "1 1 1",
        .help = "colour of the highlight"),
    ROW("mirrorCoefficient", MATTE | FACETS, COLOR, MIRROR, "0 0 0", .evidence = GI_EVIDENCE_2019,
        .years = "2019", .help = "colour of the mirror; black: none"),
    ROW("alpha", GI_IN_BRDF | GI_IN_MICROFACETS, REAL, ROUGHNESS, NULL, GI_CHECK_POSITIVE,
        .required = true, .years = "2018 2019", .example = "0.3",
        .help = "roughness of the microfacets"),
    ROW("nt", GI_IN_BRDF | GI_IN_MICROFACETS, REAL, REFRACTION, NULL, GI_CHECK_POSITIVE,
        .required = true, .years = "2018 2019", .example = "1.5",
        .help = "index of refraction of the microfacets"),
    ROW("roughness", GI_IN_COOK_TORRANCE, REAL, ROUGHNESS, "1", GI_CHECK_POSITIVE,
        .help = "width of the highlight"),
    ROW("roughness", GI_IN_MICROFACET_BSDF, REAL, ROUGHNESS, "0.5", GI_CHECK_POSITIVE,
        .help = "alpha of the microfacets; counts for a later disttype"),
    ROW("refractiveIndex", GI_IN_GLASS, REAL, REFRACTION, "1", GI_CHECK_POSITIVE,
        .help = "index of refraction"),
    ROW("refractiveIndex", GI_IN_GLAZED | GI_IN_COOK_TORRANCE, REAL, REFRACTION, NULL,
        GI_CHECK_POSITIVE, .required = true, .example = "1.5", .help = "index of refraction"),
    ROW("refractiveIndex", GI_IN_GLASS_BSDF | GI_IN_GLAZED_BSDF, REAL, REFRACTION, "1.5",
        GI_CHECK_POSITIVE, .help = "index of refraction"),
    ROW("refractiveIndex", GI_IN_MICROFACET_BSDF, REAL, REFRACTION, "1.5", GI_CHECK_POSITIVE,
        .help = "index of refraction; counts for a later disttype"),
    ROW("disttype", GI_IN_MICROFACET_BSDF, INTEGER, DISTTYPE, "0", GI_CHECK_BIT,
        .help = "0: Beckmann, 1: GGX; puts an earlier roughness and refractiveIndex into force"),
    ROW("substrate", GI_IN_GLAZED, SHADER, SUBSTRATE, NULL, .required = true,
        .help = "the shader under the glaze"),
    ROW("substrate", GI_IN_GLAZED_BSDF, BSDF, SUBSTRATE, NULL, .required = true,
        .help = "the bsdf under the glaze"),
    ROW("image", GI_IN_TEXTURE, STRING, PICTURE, NULL, .required = true,
        .example = "earth.png", .help = "the file of the picture, PNG or JPEG"),

    ROW("position", GI_IN_ANY_LIGHT, POINT, POSITION, "0 0 0",
        .help = "where the light stands; of a rectangle the centre"),
    ROW("intensity", GI_IN_ANY_LIGHT, COLOR, INTENSITY, "1 1 1", .help = "colour of the light"),
    ROW("color", GI_IN_ANY_LIGHT, COLOR, INTENSITY, "1 1 1", .alias_of = "intensity",
        .years = "2011", .help = "older word for intensity"),
    ROW("falloff", GI_IN_POINT_LIGHT, CHOICE, FALLOFF, NULL, .choices = "none inverse-square",
        .years = OURS, .example = "inverse-square",
        .help = "how light weakens with distance; as the dialect has it when absent"),
    ROW("direction", GI_IN_DIRECTIONAL_LIGHT, VECTOR, DIRECTION, NULL, GI_CHECK_LENGTH,
        .required = true, .example = "1 2 3", .help = "vector toward the light"),
    ROW("normalDir", GI_IN_RECTANGLE_LIGHT, VECTOR, DIRECTION, "0 0 -1", GI_CHECK_LENGTH,
        .help = "vector to the side that shines"),
    ROW("upDir", GI_IN_RECTANGLE_LIGHT, VECTOR, UP, "0 1 0", GI_CHECK_LENGTH,
        .help = "vector along the height"),
    ROW("width", GI_IN_RECTANGLE_LIGHT, REAL, LIGHT_WIDTH, "1", GI_CHECK_POSITIVE,
        .help = "extent across upDir"),
    ROW("height", GI_IN_RECTANGLE_LIGHT, REAL, LIGHT_HEIGHT, "1", GI_CHECK_POSITIVE,
        .help = "extent along upDir"),
    ROW("filename", GI_IN_CUBEMAP, STRING, FILENAME, NULL, .required = true,
        .example = "sky.pfm", .help = "the file of the map, PFM: a cross of 3 x 4 faces"),
    ROW("scaleFactor", GI_IN_CUBEMAP, REAL, SCALE_FACTOR, "1", .help = "factor of the map"),
    ROW("maxDepth", GI_IN_PATH_INTEGRATOR, INTEGER, MAX_DEPTH, "12", GI_CHECK_DEPTH,
        .years = OURS, .help = "how many surfaces a path may meet"),
    {.name = NULL},
};

#define TYPE(name, kind, context, value, ...) \
    {name, GI_KIND_##kind, GI_IN_##context, GLINT_##value, __VA_ARGS__}

const GiType gi_types[] = {
    TYPE("PerspectiveCamera", CAMERA, CAMERA, CAMERA_PERSPECTIVE, GI_EVIDENCE_CAMERA_TYPE, NULL,
        "rays start at viewPoint", NULL),
    TYPE("ParallelCamera", CAMERA, CAMERA, CAMERA_PARALLEL, GI_EVIDENCE_CAMERA_TYPE, NULL,
        "rays run parallel to viewDir", "2013 2017b 2018b"),
    TYPE("OrthographicCamera", CAMERA, CAMERA, CAMERA_PARALLEL, GI_EVIDENCE_CAMERA_TYPE,
        "ParallelCamera", "the same as ParallelCamera", TEXTURES),

    TYPE("Sphere", SURFACE, SPHERE, SURFACE_SPHERE, 0, NULL, "a ball", NULL),
    TYPE("Box", SURFACE, BOX, SURFACE_BOX, 0, NULL, "a box along the axes", NULL),
    TYPE("Cylinder", SURFACE, CYLINDER, SURFACE_CYLINDER, 0, NULL, "along z, closed",
        "2011 2012 2017b 2018b"),
    TYPE("Cone", SURFACE, CONE, SURFACE_CONE, 0, NULL, "along z, closed", "2011 2012"),
    TYPE("Plane", SURFACE, PLANE, SURFACE_PLANE, GI_EVIDENCE_MATERIAL, NULL, "without end",
        "material"),
    TYPE("Disc", SURFACE, DISC, SURFACE_DISC, GI_EVIDENCE_MATERIAL, NULL, "flat and round",
        "material"),
    TYPE("Mesh", SURFACE, MESH, SURFACE_MESH, 0, NULL, "triangles of a file", MESHES),
    TYPE("Group", SURFACE, GROUP, SURFACE_GROUP, GI_EVIDENCE_SECOND_TRACER, NULL,
        "surfaces under a common transform", "2012 2017b 2018b"),

    TYPE("Lambertian", SHADER, LAMBERTIAN, SHADER_LAMBERTIAN, 0, NULL, "matte", SHADERS),
    TYPE("Phong", SHADER, PHONG, SHADER_PHONG, 0, NULL, "matte with a highlight", PHONG),
    TYPE("RGBNormals", SHADER, RGB_NORMALS, SHADER_RGB_NORMALS, 0, NULL,
        "shows the normal as a colour", TEXTURES),
    TYPE("Glazed", SHADER, GLAZED, SHADER_GLAZED, GI_EVIDENCE_SECOND_TRACER, NULL,
        "a clear coat that mirrors over a substrate", "2012 2017b"),
    TYPE("Glass", SHADER, GLASS, SHADER_GLASS, GI_EVIDENCE_SECOND_TRACER, NULL,
        "mirrors and refracts", "2012 2017b"),
    TYPE("Microfacet", SHADER, MICROFACET, SHADER_BECKMANN, 0, NULL,
        "microfacets, distributed as the brdf says, on a matte base", "2018"),
    TYPE("MicrofacetBeckmann", SHADER, MICROFACETS, SHADER_BECKMANN, GI_EVIDENCE_2019, NULL,
        "microfacets with Beckmann's distribution", "2019"),
    TYPE("MicrofacetGGX", SHADER, MICROFACETS, SHADER_GGX, GI_EVIDENCE_2019, NULL,
        "microfacets with the GGX distribution", "2019"),
    TYPE("CookTorrance", SHADER, COOK_TORRANCE, SHADER_COOK_TORRANCE, GI_EVIDENCE_SECOND_TRACER,
        NULL, "the older microfacets of Cook and Torrance", "2017b"),

    TYPE("LambertianBSDF", BSDF, LAMBERTIAN_BSDF, SHADER_LAMBERTIAN, 0, NULL, "matte", "2018b"),
    TYPE("MicrofacetBSDF", BSDF, MICROFACET_BSDF, SHADER_BECKMANN, 0, NULL,
        "microfacets, distributed as disttype says, on a matte base", "2018b"),
    TYPE("GlassBSDF", BSDF, GLASS_BSDF, SHADER_GLASS, 0, NULL, "mirrors and refracts", "2018b"),
    TYPE("GlazedBSDF", BSDF, GLAZED_BSDF, SHADER_GLAZED, 0, NULL,
        "a clear coat that mirrors over a substrate", "2018b"),

    TYPE("Beckmann", BRDF, BRDF, SHADER_BECKMANN, 0, NULL, "Beckmann's distribution", "2018"),
    TYPE("GGX", BRDF, BRDF, SHADER_GGX, 0, NULL, "the GGX distribution", "2018"),

    TYPE("RepeatTexture", TEXTURE, TEXTURE, WRAP_REPEAT, 0, NULL, "the picture repeats itself",
        TEXTURES),
    TYPE("ClampTexture", TEXTURE, TEXTURE, WRAP_CLAMP, 0, NULL, "the picture's edge goes on",
        TEXTURES),

    TYPE("PointLight", LIGHT, POINT_LIGHT, LIGHT_POINT, GI_EVIDENCE_LIGHT_TYPE, NULL,
        "shines from a point, with shadows", "material 2017b 2018b"),
    TYPE("Light", LIGHT, POINT_LIGHT, LIGHT_POINT, 0, "PointLight", "the same as PointLight",
        UNTYPED),
    TYPE("AmbientLight", LIGHT, AMBIENT_LIGHT, LIGHT_AMBIENT, GI_EVIDENCE_LIGHT_TYPE, NULL,
        "adds intensity times diffuseColor everywhere", "material"),
    TYPE("ConstantLight", LIGHT, CONSTANT_LIGHT, LIGHT_CONSTANT, GI_EVIDENCE_LIGHT_TYPE, NULL,
        "adds diffuseColor everywhere", "material"),
    TYPE("NormalLight", LIGHT, NORMAL_LIGHT, LIGHT_NORMAL, GI_EVIDENCE_LIGHT_TYPE, NULL,
        "adds (normal + 1) / 2 everywhere", "material"),
    TYPE("DirectionalLight", LIGHT, DIRECTIONAL_LIGHT, LIGHT_DIRECTIONAL, GI_EVIDENCE_LIGHT_TYPE,
        NULL, "shines from infinitely far away, with shadows", "2017b"),
    TYPE("RectangleLight", LIGHT, RECTANGLE_LIGHT, LIGHT_RECTANGLE, GI_EVIDENCE_LIGHT_TYPE, NULL,
        "shines from one side of a rectangle, with soft shadows", "2017b 2018b"),

    {"Cubemap", GI_KIND_ENVIRONMENT, GI_IN_CUBEMAP, 0, 0, NULL, "a picture on the faces of a cube",
        "2017b 2018b"},

    TYPE("LightSamplingIntegrator", INTEGRATOR, INTEGRATOR, INTEGRATOR_LIGHT_SAMPLING, 0, NULL,
        "direct light, by points of the lights", "2018b"),
    TYPE("BSDFSamplingIntegrator", INTEGRATOR, INTEGRATOR, INTEGRATOR_BSDF_SAMPLING, 0, NULL,
        "direct light, by directions of the bsdf", "2018b"),
    TYPE("PointLightIntegrator", INTEGRATOR, INTEGRATOR, INTEGRATOR_POINT_LIGHT, 0, NULL,
        "point lights only, no mirrors", "2018b"),
    TYPE("PathIntegrator", INTEGRATOR, PATH_INTEGRATOR, INTEGRATOR_PATH, 0, NULL,
        "all light, also from surface to surface", OURS),
    {.name = NULL},
};
/* clang-format on */

/* ---------------------------------------------------------------- finding */

/* Setting a bit makes small letters of capitals; that it also mixes up other characters does no
 * harm here. */
static unsigned hash_name(GiSpan name) {
    unsigned hash = 0;
    for (size_t i = 0; i < name.size; i++) hash = hash * 3 + ((unsigned char)name.data[i] | 0x20u);
    return (hash ^ hash >> 7) % GI_ELEMENT_SLOT_COUNT;
}

static bool same_name(const char *a, GiSpan b) {
    size_t i = 0;
    while (i < b.size && a[i] != '\0' && gi_lower(a[i]) == gi_lower(b.data[i])) i++;
    return i == b.size && a[i] == '\0';
}

void gi_element_index_init(GiElementIndex *index) {
    memset(index, 0, sizeof *index);
    for (unsigned row = 0; gi_elements[row].name != NULL; row++) {
        GiSpan name = gi_span(gi_elements[row].name);
        uint8_t *first = &index->first[hash_name(name)];
        index->sizes[row] = (uint8_t)name.size;
        index->next[row] = *first;
        *first = (uint8_t)(row + 1);
    }
}

const GiElement *gi_element_find(const GiElementIndex *index, GiSpan name, GiContexts contexts) {
    for (unsigned row = index->first[hash_name(name)]; row != 0; row = index->next[row - 1]) {
        const GiElement *element = &gi_elements[row - 1];
        if ((element->contexts & contexts) != 0 && same_name(element->name, name)) return element;
    }
    return NULL;
}

const GiElement *gi_element_guess(GiElementIndex *index, GiSpan name, GiContexts contexts) {
    uint8_t *guess = &index->after[index->last];
    const GiElement *element = *guess > 0 ? &gi_elements[*guess - 1] : NULL;
    if (element == NULL || (element->contexts & contexts) == 0 ||
        name.size != index->sizes[*guess - 1] || !gi_span_equals(name, element->name)) {
        element = gi_element_find(index, name, contexts);
        if (element == NULL) return NULL;
        *guess = (uint8_t)(element - gi_elements + 1);
    }
    index->last = *guess;
    return element;
}

const GiType *gi_type_find(GiSpan name, GiKind kind) {
    for (const GiType *type = gi_types; type->name != NULL; type++) {
        if (type->kind != kind || name.size == 0 || type->name[0] != name.data[0]) continue;
        if (gi_span_is(name, type->name)) return type;
    }
    return NULL;
}

const GiType *gi_type_guess(GiElementIndex *index, GiSpan name, GiKind kind) {
    const GiType *type = index->type;
    if (type == NULL || type->kind != kind || name.size != index->type_size ||
        !gi_span_equals(name, type->name)) {
        type = gi_type_find(name, kind);
        if (type == NULL) return NULL;
        index->type = type;
        index->type_size = name.size;
    }
    return type;
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
    case GI_KIND_STRING: return "text";
    case GI_KIND_SCENE: return "a scene";
    case GI_KIND_CAMERA: return "a camera";
    case GI_KIND_SURFACE: return "a surface";
    case GI_KIND_SHADER: return "a shader";
    case GI_KIND_BSDF: return "a bsdf";
    case GI_KIND_BRDF: return "a brdf";
    case GI_KIND_TEXTURE: return "a texture";
    case GI_KIND_LIGHT: return "a light";
    case GI_KIND_ENVIRONMENT: return "an environment";
    case GI_KIND_INTEGRATOR: break;
    }
    return "an integrator";
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

GiContexts gi_kind_contexts(GiKind kind) {
    switch (kind) {
    case GI_KIND_SCENE: return GI_IN_SCENE;
    case GI_KIND_CAMERA: return GI_IN_CAMERA;
    case GI_KIND_SURFACE: return GI_IN_ANY_SURFACE;
    case GI_KIND_SHADER: return GI_IN_ANY_SHADER;
    case GI_KIND_BSDF: return GI_IN_ANY_BSDF;
    case GI_KIND_BRDF: return GI_IN_BRDF;
    case GI_KIND_TEXTURE: return GI_IN_TEXTURE;
    case GI_KIND_LIGHT: return GI_IN_ANY_LIGHT;
    case GI_KIND_ENVIRONMENT: return GI_IN_CUBEMAP;
    case GI_KIND_INTEGRATOR: return GI_IN_ANY_INTEGRATOR;
    default: return 0;
    }
}

bool gi_kind_fits(GiKind kind, GiKind wanted) {
    bool shader = kind == GI_KIND_SHADER || kind == GI_KIND_BSDF;
    bool to_shade = wanted == GI_KIND_SHADER || wanted == GI_KIND_BSDF;
    return kind == wanted || (shader && to_shade) ||
           (gi_kind_count(kind) == 3 && gi_kind_count(wanted) == 3);
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

static bool listed(const GiType *type, GiKind kind, GiContexts contexts) {
    return type->kind == kind && type->alias_of == NULL && (type->context & contexts) != 0;
}

static void list_types(GiKind kind, GiContexts contexts, Enumeration *list) {
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
    list_types(kind, GI_ANYWHERE, &list);
}

/* Whether "an" goes before the word; "RGB" is spelled, so that it begins with a vowel. */
static bool takes_an(const char *word) {
    bool spelled = word[0] >= 'A' && word[0] <= 'Z' && word[1] >= 'A' && word[1] <= 'Z';
    return word[0] != '\0' && strchr(spelled ? "AEFHILMNORSX" : "AEIOUaeiou", word[0]) != NULL;
}

void gi_context_text(GiContexts contexts, char *buffer, size_t size) {
    static const GiKind kinds[] = {GI_KIND_SCENE, GI_KIND_CAMERA, GI_KIND_SURFACE, GI_KIND_SHADER,
        GI_KIND_BSDF, GI_KIND_BRDF, GI_KIND_TEXTURE, GI_KIND_LIGHT, GI_KIND_ENVIRONMENT,
        GI_KIND_INTEGRATOR};
    Enumeration list = {.buffer = buffer, .size = size};
    buffer[0] = '\0';
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        list.count += (contexts & gi_kind_contexts(kinds[i])) != 0;
    }
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        GiContexts all = gi_kind_contexts(kinds[i]), some = contexts & all;
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
            /* "PointLight" says it. */
            bool named = kinds[i] == GI_KIND_LIGHT || kinds[i] == GI_KIND_BSDF ||
                         kinds[i] == GI_KIND_INTEGRATOR;
            snprintf(phrase, sizeof phrase, "%s %s%s%s", takes_an(types) ? "an" : "a", types,
                named ? "" : " ", named ? "" : noun);
            enumerate(&list, phrase);
        }
    }
}
