/* SPDX-License-Identifier: MIT
 * Recipes: what it takes to draw a picture once more, as a struct and as the text in a PNG. A line
 * is a word and what belongs to it:
 *
 *     glint 0.1.0
 *     dialect 2012
 *     size 640 480
 *     crop 0 0 64 64                         only of a part
 *     samples 16
 *     light 2                                only of one light's picture
 *     sampling random                        only when it is not sobol
 *     broken no-shadows,light-missing=2      only of a picture with mistakes
 *     scene 1234 995dc9bbdf1939fa solids.xml
 *     mesh 5678 0123456789abcdef data/knot.ply
 *     pixels fedcba9876543210                after the pixels, a text of its own
 *
 * A word that is not known belongs to a later version, whose pictures cannot be judged here. */
#include "glint/glint.h"

#include "base/array.h"
#include "base/cookie.h"
#include "base/digest.h"
#include "glint_scene.h"
#include "image/png_extra.h"
#include "math/gamma.h"
#include "port/file.h"
#include "port/folder.h"
#include "texture/texture.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct GiRecipe {
    GlintRecipe recipe; /* the first member: what is handed out */
    GiMemory memory;
    GI_ARRAY(GlintRecipeFile) files;
    GI_ARRAY(size_t) names;    /* of the files: offsets into text */
    GI_ARRAY(size_t) capacity; /* of their bytes */
    GI_ARRAY(char) text;
} GiRecipe;

static const char *const kinds[] = {"scene", "mesh", "texture", "environment"};
enum { KIND_COUNT = sizeof kinds / sizeof kinds[0], BROKEN_LIMIT = 1024 };

/* ---------------------------------------------------------------- life */

static GiRecipe *create(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    GiRecipe *own = gi_memory_allocate(&memory, sizeof *own);
    if (own == NULL) return NULL;
    memset(own, 0, sizeof *own);
    gi_memory_init(&own->memory, NULL, 0);
    return own;
}

void glint_recipe_destroy(GlintRecipe *recipe) {
    if (recipe == NULL) return;
    GiRecipe *own = (GiRecipe *)recipe;
    for (size_t i = 0; i < own->files.count; i++) {
        /* It is the recipe's own, and const only for others. */
        gi_memory_free(
            &own->memory, (void *)(uintptr_t)own->files.data[i].bytes, own->capacity.data[i]);
    }
    gi_array_free(&own->memory, &own->files);
    gi_array_free(&own->memory, &own->names);
    gi_array_free(&own->memory, &own->capacity);
    gi_array_free(&own->memory, &own->text);
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    gi_memory_free(&memory, own, sizeof *own);
}

/* A name with line breaks would be two lines. */
static bool add_file(GiRecipe *own, const GlintRecipeFile *file, const char *name, size_t length) {
    GiMemory *memory = &own->memory;
    if (!gi_array_reserve(memory, &own->text, length + 1) ||
        !gi_array_push(memory, &own->names, own->text.count) ||
        !gi_array_push(memory, &own->capacity, 0) || !gi_array_push(memory, &own->files, *file)) {
        return false;
    }
    for (size_t i = 0; i < length; i++) {
        own->text.data[own->text.count++] = (unsigned char)name[i] < 32 ? '?' : name[i];
    }
    own->text.data[own->text.count++] = '\0';
    return true;
}

/* When no more files come: their names stay where they are. */
static GlintRecipe *complete(GiRecipe *own) {
    for (size_t i = 0; i < own->files.count; i++) {
        own->files.data[i].name = own->text.data + own->names.data[i];
    }
    own->recipe.files = own->files.data;
    own->recipe.file_count = (int)own->files.count;
    return &own->recipe;
}

/* ---------------------------------------------------------------- of a scene */

static bool embed_copy(GiRecipe *own, size_t index, const void *bytes, size_t size) {
    void *copy = gi_memory_allocate(&own->memory, size + 1);
    if (copy == NULL) return false;
    if (size > 0) memcpy(copy, bytes, size);
    own->files.data[index].bytes = copy;
    own->capacity.data[index] = size + 1;
    return true;
}

/* The content of a file that the scene names, which must be what it was when it was loaded. */
static GlintStatus embed_file(GiRecipe *own, size_t index, const char *path, GlintError *error) {
    const GlintRecipeFile *file = &own->files.data[index];
    GiFileBytes bytes;
    GlintStatus status = gi_file_bytes_load(&bytes, &own->memory, path, NULL, error);
    if (status != GLINT_OK) return status;
    if (bytes.size > GI_PNG_FILE_LIMIT) {
        status = gi_error_set_path(
            error, GLINT_ERROR_FILE, path, "it is larger than 1 GiB, too large to be embedded");
    } else if (gi_digest(0, bytes.bytes, bytes.size) != file->digest) {
        status = gi_error_set_path(
            error, GLINT_ERROR_FILE, path, "it has changed since the scene was loaded");
    } else if (!embed_copy(own, index, bytes.bytes, bytes.size)) {
        status = gi_error_memory(error);
    }
    gi_file_bytes_free(&bytes, &own->memory);
    return status;
}

static GlintStatus embed(GiRecipe *own, const GlintScene *scene, GlintError *error) {
    const GiWindow *window = &scene->sources.window;
    if (scene->sources.memory == NULL || window->size > GI_PNG_FILE_LIMIT) {
        return ARGUMENT(error, "only a scene loaded with keep_sources, of at most 1 GiB, can be "
                               "embedded");
    }
    if (!embed_copy(own, 0, window->data, window->size)) return gi_error_memory(error);
    for (size_t i = 1; i < own->files.count; i++) {
        const GiSceneFile *file = &scene->model.files.data[i];
        const char *path = scene->model.file_names.data + file->path;
        GlintStatus status = embed_file(own, i, path, error);
        if (status != GLINT_OK) return status;
    }
    return GLINT_OK;
}

GlintStatus glint_scene_recipe(const GlintScene *scene, const GlintRenderDesc *desc,
    bool with_files, GlintRecipe **recipe, GlintError *error) {
    if (scene == NULL || desc == NULL || recipe == NULL) {
        return ARGUMENT(error, "scene, desc or recipe is null");
    }
    *recipe = NULL;
    if (desc->cookie != GI_COOKIE) {
        return ARGUMENT(error, "the desc was not made by glint_render_desc_default");
    }
    if (desc->show != GLINT_SHOW_PICTURE) {
        return ARGUMENT(error, "there is no recipe of what only explains a picture");
    }
    if (desc->camera != NULL) {
        return ARGUMENT(error, "a recipe is of the scene's own camera");
    }
    GiRecipe *own = create();
    if (own == NULL) return gi_error_memory(error);
    const GiScene *model = &scene->model;
    GlintRecipe *made = &own->recipe;
    snprintf(made->version, sizeof made->version, "%s", glint_version_text());
    made->dialect = model->dialect;
    made->width = desc->width != 0 ? desc->width : model->width;
    made->height = desc->height != 0 ? desc->height : model->height;
    made->crop_x = desc->crop_x;
    made->crop_y = desc->crop_y;
    made->crop_width = desc->crop_width != 0 ? desc->crop_width : made->width - desc->crop_x;
    made->crop_height = desc->crop_height != 0 ? desc->crop_height : made->height - desc->crop_y;
    made->samples = desc->samples != 0 ? desc->samples : model->samples;
    made->light = desc->light;
    made->sampling = desc->sampling;
    made->mistakes = desc->mistakes;
    const uint64_t reversed = GLINT_MISTAKE_BIT(GLINT_MISTAKE_TRANSFORMS_REVERSED);
    made->mistakes.set &= ~reversed;
    if (model->reverse_transforms) made->mistakes.set |= reversed;
    GlintStatus status = GLINT_OK;
    for (size_t i = 0; i < model->files.count && status == GLINT_OK; i++) {
        const GiSceneFile *file = &model->files.data[i];
        const char *name = model->file_names.data + file->name;
        GlintRecipeFile item = {.kind = file->kind, .size = file->size, .digest = file->digest};
        if (!add_file(own, &item, name, strlen(name))) status = gi_error_memory(error);
    }
    if (status == GLINT_OK && with_files) status = embed(own, scene, error);
    if (status != GLINT_OK) {
        glint_recipe_destroy(made);
        return status;
    }
    *recipe = complete(own);
    return GLINT_OK;
}

/* ---------------------------------------------------------------- writing the text */

typedef struct Text {
    char *buffer;
    size_t size, used; /* used: without the cut */
} Text;

GI_PRINTF(2, 3) static void say(Text *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    size_t left = text->used < text->size ? text->size - text->used : 0;
    int length = vsnprintf(left > 0 ? text->buffer + text->used : NULL, left, format, arguments);
    if (length > 0) text->used += (size_t)length;
    va_end(arguments);
}

size_t glint_recipe_format(const GlintRecipe *recipe, char *buffer, size_t size) {
    Text text = {buffer, size, 0};
    say(&text, "glint %s\ndialect %s\nsize %d %d\n", recipe->version,
        glint_dialect_name(recipe->dialect), recipe->width, recipe->height);
    if (recipe->crop_width != recipe->width || recipe->crop_height != recipe->height) {
        say(&text, "crop %d %d %d %d\n", recipe->crop_x, recipe->crop_y, recipe->crop_width,
            recipe->crop_height);
    }
    say(&text, "samples %d\n", recipe->samples);
    if (recipe->light != 0) say(&text, "light %d\n", recipe->light);
    if (recipe->sampling == GLINT_SAMPLING_RANDOM) say(&text, "sampling random\n");
    if (recipe->mistakes.set != 0) {
        char names[BROKEN_LIMIT];
        glint_mistakes_format(&recipe->mistakes, names, sizeof names);
        say(&text, "broken %s\n", names);
    }
    for (int i = 0; i < recipe->file_count; i++) {
        const GlintRecipeFile *file = &recipe->files[i];
        say(&text, "%s %llu %016llx %s\n", kinds[file->kind], (unsigned long long)file->size,
            (unsigned long long)file->digest, file->name);
    }
    return text.used;
}

/* ---------------------------------------------------------------- reading it */

/* A word, and what follows it in the line. */
typedef struct Line {
    char word[16];
    const char *rest;
    size_t length; /* of the rest */
} Line;

static const char *next_line(const char *text, Line *line) {
    size_t length = strcspn(text, "\n"), word = strcspn(text, " \n");
    snprintf(line->word, sizeof line->word, "%.*s", (int)(word < 15 ? word : 15), text);
    bool more = text[word] == ' ';
    line->rest = text + word + (more ? 1 : 0);
    line->length = length - word - (more ? 1 : 0);
    return text + length + (text[length] == '\n');
}

/* All of the rest as this many numbers, each from low to 2^28. */
static bool take_numbers(const Line *line, int low, int count, int **numbers) {
    const char *at = line->rest, *end = line->rest + line->length;
    for (int i = 0; i < count; i++) {
        char *behind;
        long number = strtol(at, &behind, 10);
        if (behind == at || behind > end || number < low || number > 1 << 28) return false;
        *numbers[i] = (int)number;
        at = behind;
    }
    return at == end;
}

static bool take_digest(const char *at, const char *end, uint64_t *digest) {
    if (end - at < 16) return false;
    *digest = 0;
    for (int i = 0; i < 16; i++) {
        const char *digits = "0123456789abcdef", *digit = at[i] ? strchr(digits, at[i]) : NULL;
        if (digit == NULL) return false;
        *digest = *digest << 4 | (uint64_t)(digit - digits);
    }
    return true;
}

typedef enum Reading { READ_GOOD, READ_BROKEN, READ_UNKNOWN, READ_MEMORY } Reading;

static Reading take_file(GiRecipe *own, GlintFileKind kind, const Line *line) {
    const char *end = line->rest + line->length;
    GlintRecipeFile file = {.kind = kind};
    char *behind;
    file.size = strtoull(line->rest, &behind, 10);
    if (behind == line->rest || end - behind < 18 || *behind != ' ' || behind[17] != ' ' ||
        !take_digest(behind + 1, end, &file.digest)) {
        return READ_BROKEN;
    }
    const char *name = behind + 18;
    return add_file(own, &file, name, (size_t)(end - name)) ? READ_GOOD : READ_MEMORY;
}

static Reading take_line(GiRecipe *own, const Line *line) {
    GlintRecipe *recipe = &own->recipe;
    const char *end = line->rest + line->length;
    char rest[40];
    snprintf(rest, sizeof rest, "%.*s", (int)(line->length < 39 ? line->length : 39), line->rest);
    bool good = true;
    if (strcmp(line->word, "glint") == 0) {
        snprintf(recipe->version, sizeof recipe->version, "%.31s", rest);
    } else if (strcmp(line->word, "dialect") == 0) {
        if (!glint_dialect_from_name(rest, &recipe->dialect)) return READ_UNKNOWN;
    } else if (strcmp(line->word, "size") == 0) {
        good = take_numbers(line, 1, 2, (int *[]){&recipe->width, &recipe->height});
        recipe->crop_width = recipe->width;
        recipe->crop_height = recipe->height;
    } else if (strcmp(line->word, "crop") == 0) {
        good = take_numbers(line, 0, 4,
            (int *[]){&recipe->crop_x, &recipe->crop_y, &recipe->crop_width, &recipe->crop_height});
    } else if (strcmp(line->word, "samples") == 0) {
        good = take_numbers(line, 1, 1, (int *[]){&recipe->samples});
    } else if (strcmp(line->word, "light") == 0) {
        good = take_numbers(line, -1, 1, (int *[]){&recipe->light});
    } else if (strcmp(line->word, "sampling") == 0) {
        if (strcmp(rest, "random") != 0) return READ_UNKNOWN;
        recipe->sampling = GLINT_SAMPLING_RANDOM;
    } else if (strcmp(line->word, "broken") == 0) {
        char names[BROKEN_LIMIT];
        snprintf(names, sizeof names, "%.*s", (int)line->length, line->rest);
        const char *wrong;
        if (!glint_mistakes_parse(names, &recipe->mistakes, &wrong)) return READ_UNKNOWN;
    } else if (strcmp(line->word, "pixels") == 0) {
        good = recipe->has_pixels = take_digest(line->rest, end, &recipe->pixels);
    } else {
        for (int kind = 0; kind < KIND_COUNT; kind++) {
            if (strcmp(line->word, kinds[kind]) == 0) {
                return take_file(own, (GlintFileKind)kind, line);
            }
        }
        return READ_UNKNOWN;
    }
    return good ? READ_GOOD : READ_BROKEN;
}

typedef struct Loading {
    GiRecipe *own;
    Reading reading; /* the first that is not good */
    char word[16];   /* at which it was found */
} Loading;

/* The embedded files stand in the order of the recipe, some of them perhaps missing. */
static bool take_content(GiRecipe *own, const GiPngFile *file) {
    for (size_t i = 0; i < own->files.count; i++) {
        GlintRecipeFile *known = &own->files.data[i];
        const char *name = own->text.data + own->names.data[i];
        if (known->bytes != NULL || strcmp(name, file->name) != 0 || known->size != file->size ||
            known->digest != gi_digest(0, file->bytes, file->size)) {
            continue;
        }
        known->bytes = file->bytes;
        own->capacity.data[i] = file->size + 1;
        return true;
    }
    return false;
}

static bool take_extra(void *user, const GiPngExtra *extra) {
    Loading *loading = user;
    GiRecipe *own = loading->own;
    if (extra->text == NULL) {
        /* The reader's memory and the recipe's are the same. */
        if (!take_content(own, &extra->file)) {
            gi_memory_free(
                &own->memory, (void *)(uintptr_t)extra->file.bytes, extra->file.size + 1);
            if (loading->reading == READ_GOOD) loading->reading = READ_BROKEN;
        }
        return true;
    }
    for (const char *text = extra->text; *text != '\0' && loading->reading == READ_GOOD;) {
        Line line;
        text = next_line(text, &line);
        loading->reading = take_line(own, &line);
        memcpy(loading->word, line.word, sizeof line.word);
    }
    return loading->reading != READ_MEMORY;
}

static GlintStatus judge(const Loading *loading, const char *path, GlintError *error) {
    const GlintRecipe *recipe = &loading->own->recipe;
    if (loading->reading == READ_UNKNOWN) {
        return gi_error_set_path(error, GLINT_ERROR_FILE, path,
            "its recipe says `%s`, which Glint %s does not know", loading->word,
            glint_version_text());
    }
    if (loading->reading == READ_GOOD && recipe->version[0] == '\0') {
        return gi_error_set_path(error, GLINT_ERROR_FILE, path,
            "it has no recipe: Glint did not draw it, or another "
            "program has saved it since");
    }
    bool whole = recipe->width > 0 && recipe->height <= (1 << 28) / recipe->width &&
                 recipe->samples > 0 && recipe->crop_x <= recipe->width - recipe->crop_width &&
                 recipe->crop_y <= recipe->height - recipe->crop_height && recipe->crop_width > 0 &&
                 recipe->crop_height > 0;
    if (loading->reading == READ_GOOD && whole) return GLINT_OK;
    return gi_error_set_path(error, GLINT_ERROR_FILE, path, "its recipe is broken");
}

GlintStatus glint_recipe_load(const char *path, GlintRecipe **recipe, GlintError *error) {
    if (path == NULL || recipe == NULL) return ARGUMENT(error, "path or recipe is null");
    *recipe = NULL;
    GiRecipe *own = create();
    if (own == NULL) return gi_error_memory(error);
    GiFileBytes bytes;
    GlintStatus status = gi_file_bytes_load(&bytes, &own->memory, path, NULL, error);
    if (status == GLINT_OK) {
        Loading loading = {.own = own};
        GlintError reason = {.status = GLINT_OK};
        status = gi_png_read_extras(
            &own->memory, bytes.bytes, bytes.size, take_extra, &loading, &reason);
        gi_file_bytes_free(&bytes, &own->memory);
        status = status == GLINT_OK ? judge(&loading, path, error)
                                    : gi_error_set_path(error, status, path, "%s", reason.message);
    }
    if (status == GLINT_OK) {
        *recipe = complete(own);
    } else {
        glint_recipe_destroy(&own->recipe);
    }
    return status;
}

/* ---------------------------------------------------------------- pixels */

GlintStatus glint_picture_digest(const char *path, uint64_t *digest, GlintError *error) {
    if (path == NULL || digest == NULL) return ARGUMENT(error, "path or digest is null");
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    GiPicture picture;
    GlintStatus status = gi_picture_load(&picture, &memory, path, error);
    if (status != GLINT_OK) return status;
    *digest = gi_digest(0, picture.rgb, 3 * (size_t)picture.width * (size_t)picture.height);
    gi_picture_free(&picture, &memory);
    return GLINT_OK;
}

GlintStatus glint_image_digest(const GlintImage *image, uint64_t *digest, GlintError *error) {
    if (image == NULL || image->pixels == NULL || digest == NULL) {
        return ARGUMENT(error, "image, pixels or digest is null");
    }
    size_t row_size = 3 * (size_t)image->width;
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    uint8_t *row = gi_memory_allocate(&memory, row_size);
    if (row == NULL) return gi_error_memory(error);
    *digest = 0;
    for (int y = 0; y < image->height; y++) {
        gi_gamma_encode(image->pixels + (size_t)y * row_size, row_size, row);
        *digest = gi_digest(*digest, row, row_size);
    }
    gi_memory_free(&memory, row, row_size);
    return GLINT_OK;
}
