/* SPDX-License-Identifier: MIT
 * Whether a picture is what its recipe says: its pixels are untouched, its files are what they
 * were, and this program draws the very same pixels again. */
#define _POSIX_C_SOURCE 200809L
#include "interrupt.h"
#include "message.h"
#include "scene_file.h"
#include "value.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct VerifyOptions {
    const char *scene; /* null: the one inside, or the one that the recipe names */
    int thread_count;
    const char *isa;
    bool quiet;
} VerifyOptions;

/* One picture on its way to a verdict. */
typedef struct Verifying {
    const VerifyOptions *options;
    const char *picture;
    const GlintRecipe *recipe;
    CliSceneFile file; /* of the scene */
    CliJob job;
    int complaints;
} Verifying;

CLI_PRINTF(2, 3) static void complain(Verifying *verifying, const char *format, ...) {
    char text[600];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    cli_progress_clear(&verifying->file.progress);
    cli_message_diagnostic(&(GlintDiagnostic){.severity = GLINT_SEVERITY_ERROR,
        .path = verifying->picture,
        .message = text,
        .caret_length = 1});
    verifying->complaints++;
}

/* ---------------------------------------------------------------- the scene */

/* folder/name, allocated; folder is all of path before its base. */
static char *beside(const char *path, const char *name) {
    size_t folder = (size_t)(cli_path_base(path) - path), size = folder + strlen(name) + 1;
    char *joined = malloc(size);
    if (joined != NULL) snprintf(joined, size, "%.*s%s", (int)folder, path, name);
    return joined;
}

/* Where the scene is: as told, inside the picture, where it was, or beside the picture. Null, with
 * the complaint made: nowhere. The caller frees it. */
static char *find_scene(Verifying *verifying) {
    const GlintRecipe *recipe = verifying->recipe;
    if (verifying->options->scene != NULL) return strdup(verifying->options->scene);
    if (recipe->file_count == 0) {
        complain(verifying, "it was drawn from no file, so there is nothing to draw it from again");
        return NULL;
    }
    if (cli_unpack_is_embedded(recipe)) return strdup(verifying->picture);
    const char *name = recipe->files[0].name;
    if (access(name, R_OK) == 0) return strdup(name);
    char *near = beside(verifying->picture, cli_path_base(name));
    if (near != NULL && access(near, R_OK) == 0) return near;
    free(near);
    complain(verifying,
        "its scene is not found, neither as '%s' nor beside the picture: name it "
        "with --scene",
        name);
    return NULL;
}

static const char *kind_name(GlintFileKind kind) {
    static const char *const names[] = {"scene", "mesh", "texture", "environment"};
    return names[kind];
}

static void compare_files(Verifying *verifying) {
    const GlintRecipe *recipe = verifying->recipe;
    GlintSceneFile now;
    int count = 0;
    while (glint_scene_file(verifying->file.scene, count, &now)) count++;
    if (count != recipe->file_count) {
        complain(verifying, "its scene names other files than then: %d, not %d",
            count > 0 ? count - 1 : 0, recipe->file_count - 1);
        return;
    }
    for (int i = 0; i < count; i++) {
        const GlintRecipeFile *then = &recipe->files[i];
        glint_scene_file(verifying->file.scene, i, &now);
        if (now.size == then->size && now.digest == then->digest) continue;
        complain(verifying, "the %s '%s' has changed since", kind_name(then->kind), then->name);
    }
}

/* ---------------------------------------------------------------- the pixels */

static CliStatus draw_again(Verifying *verifying) {
    const GlintRecipe *recipe = verifying->recipe;
    CliSceneFile *file = &verifying->file;
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = recipe->width;
    desc.height = recipe->height;
    desc.crop_x = recipe->crop_x;
    desc.crop_y = recipe->crop_y;
    desc.crop_width = recipe->crop_width;
    desc.crop_height = recipe->crop_height;
    desc.samples = recipe->samples;
    desc.light = recipe->light;
    desc.sampling = recipe->sampling;
    desc.mistakes = recipe->mistakes;
    desc.monitor = &file->monitor;
    size_t count = 3 * (size_t)recipe->crop_width * (size_t)recipe->crop_height;
    float *pixels = malloc(count * sizeof *pixels);
    if (pixels == NULL) return cli_scene_file_fail(file, GLINT_ERROR_MEMORY, CLI_MACHINE);
    GlintStatus status = glint_render(file->scene, &desc, pixels, &file->error);
    uint64_t digest = 0;
    if (status == GLINT_OK) {
        GlintImage image = {recipe->crop_width, recipe->crop_height, pixels};
        status = glint_image_digest(&image, &digest, &file->error);
    }
    free(pixels);
    if (status != GLINT_OK) return cli_scene_file_fail(file, status, CLI_MACHINE);
    if (digest == recipe->pixels) return CLI_OK;
    if (strcmp(recipe->version, glint_version_text()) == 0) {
        complain(verifying, "drawn again, its pixels are others");
    } else {
        complain(verifying, "drawn again by Glint %s, its pixels are others; Glint %s drew it",
            glint_version_text(), recipe->version);
    }
    return CLI_INPUT;
}

/* What can be seen without drawing. */
static CliStatus check_pixels(Verifying *verifying) {
    if (!verifying->recipe->has_pixels) {
        complain(verifying, "its recipe has no digest of its pixels");
        return CLI_INPUT;
    }
    uint64_t digest;
    GlintError error;
    if (glint_picture_digest(verifying->picture, &digest, &error) != GLINT_OK) {
        complain(verifying, "its pixels cannot be read: %s", error.message);
        return CLI_INPUT;
    }
    if (digest == verifying->recipe->pixels) return CLI_OK;
    complain(verifying, "its pixels were changed after it was drawn");
    return CLI_INPUT;
}

static CliStatus verify_scene(Verifying *verifying, const char *scene) {
    verifying->job = (CliJob){.scene = (char *)(uintptr_t)scene};
    bool progress = !verifying->options->quiet && cli_message_on_terminal();
    cli_scene_file_begin(&verifying->file, &verifying->job, 0, 1, progress);
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.thread_count = verifying->options->thread_count;
    desc.isa = verifying->options->isa;
    desc.dialect = verifying->recipe->dialect;
    desc.reverse_transforms = cli_scene_file_reverses(&verifying->recipe->mistakes);
    CliStatus status = cli_scene_file_load(&verifying->file, &desc);
    if (status == CLI_OK) compare_files(verifying);
    if (status == CLI_OK && verifying->complaints > 0) status = CLI_INPUT;
    if (status == CLI_OK) status = cli_scene_file_commit(&verifying->file);
    if (status == CLI_OK) status = draw_again(verifying);
    cli_scene_file_end(&verifying->file);
    return status;
}

static CliStatus verify(const VerifyOptions *options, const char *picture) {
    Verifying verifying = {.options = options, .picture = picture};
    GlintRecipe *recipe;
    GlintError error;
    GlintStatus loaded = glint_recipe_load(picture, &recipe, &error);
    if (loaded != GLINT_OK) {
        complain(&verifying, "%s", error.message);
        return loaded == GLINT_ERROR_MEMORY ? CLI_MACHINE : CLI_INPUT;
    }
    verifying.recipe = recipe;
    CliStatus status = check_pixels(&verifying);
    char *scene = status == CLI_OK ? find_scene(&verifying) : NULL;
    if (status == CLI_OK) status = scene != NULL ? verify_scene(&verifying, scene) : CLI_INPUT;
    if (status == CLI_OK && !options->quiet && !cli_interrupt_seen()) {
        printf("%s: the same %d x %d pixels, drawn again\n", picture, recipe->crop_width,
            recipe->crop_height);
    }
    free(scene);
    glint_recipe_destroy(recipe);
    return status;
}

static CliStatus run(void *values, const CliOperands *operands) {
    const VerifyOptions *options = values;
    if (operands->count == 0) return cli_message_usage("no picture given");
    if (options->scene != NULL && operands->count > 1) {
        return cli_message_usage("--scene is of one picture, and %d are given", operands->count);
    }
    CliStatus status = CLI_OK;
    for (int i = 0; i < operands->count && !cli_interrupt_seen(); i++) {
        status = cli_status_worse(status, verify(options, operands->items[i]));
    }
    return cli_status_worse(status, cli_message_flush_output());
}

/* ---------------------------------------------------------------- options */

static CliStatus set_scene(void *values, const char *value) {
    ((VerifyOptions *)values)->scene = value;
    return CLI_OK;
}

static CliStatus set_threads(void *values, const char *value) {
    return cli_value_threads(value, &((VerifyOptions *)values)->thread_count);
}

static CliStatus set_isa(void *values, const char *value) {
    return cli_value_isa(value, &((VerifyOptions *)values)->isa);
}

static CliStatus set_quiet(void *values, const char *value) {
    (void)value;
    ((VerifyOptions *)values)->quiet = true;
    return CLI_OK;
}

static const CliOption option_table[] = {
    {0, "scene", "FILE", CLI_FORM_REQUIRED, "The picture", "draw it from this scene", set_scene},
    {'t', "threads", "N", CLI_FORM_REQUIRED, "The machine",
        "draw with N threads (default: one a core)", set_threads},
    {0, "isa", "NAME", CLI_FORM_REQUIRED, "The machine",
        "use this instruction set, not the fastest", set_isa},
    {'q', "quiet", NULL, CLI_FORM_NONE, "Messages", "say nothing of pictures that are right",
        set_quiet},
};

static VerifyOptions defaults;

const CliVerb cli_verb_verify = {.name = "verify",
    .operands = "PICTURE.png...",
    .summary = "tell whether a picture can be drawn again, pixel for pixel",
    .about = "Every PNG that Glint draws tells how it was drawn: version, dialect, size, and\n"
             "digests of the scene, of the files that it names, and of the pixels. This\n"
             "checks that the pixels are untouched and the files are what they were, and\n"
             "draws them again: they must be the same. The scene is taken from the picture\n"
             "itself (drawn with --embed), from where it was, or from beside the picture.",
    .example_text = "is this picture still what this scene and this program make?",
    .example = "glint verify scenes/solids.xml.png",
    .options = option_table,
    .option_count = CLI_COUNT(option_table),
    .values = &defaults,
    .run = run};
