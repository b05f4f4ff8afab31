/* SPDX-License-Identifier: MIT
 * One scene at a time: create, load, commit, render and save, destroy. A scene that fails is
 * reported, leaves no picture, and does not stop the others; an interrupt stops all. */
#define _XOPEN_SOURCE 700
#include "interrupt.h"
#include "layers.h"
#include "message.h"
#include "scene_file.h"
#include "stats.h"
#include "value.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* One scene on its way to a picture. */
typedef struct Drawing {
    const CliRenderOptions *options;
    CliSceneFile file;
    float *pixels;
    CliLayers layers;
    GlintRenderDesc area;
    double shown_range[2];
    CliStats stats;
} Drawing;

static CliStatus fail_machine(
    Drawing *drawing, GlintStatus status, const char *path, const char *text) {
    snprintf(drawing->file.error.path, sizeof drawing->file.error.path, "%s", path);
    snprintf(drawing->file.error.message, sizeof drawing->file.error.message, "%s", text);
    return cli_scene_file_fail(&drawing->file, status, CLI_MACHINE);
}

/* ---------------------------------------------------------------- steps */

/* A picture that cannot be written is better known before the drawing than after it. */
static CliStatus check_picture(Drawing *drawing) {
    const char *picture = drawing->file.job->picture;
    struct stat info;
    bool exists = lstat(picture, &info) == 0;
    if (exists && S_ISDIR(info.st_mode)) {
        return fail_machine(
            drawing, GLINT_ERROR_FILE, picture, "a folder stands in the picture's place");
    }
    /* A link leads elsewhere, and a pipe or device is written in place. */
    if (exists && !S_ISREG(info.st_mode)) return CLI_OK;
    const char *base = cli_path_base(picture);
    size_t length = (size_t)(base - picture);
    char *folder = malloc(length + 2);
    if (folder == NULL) return cli_scene_file_fail(&drawing->file, GLINT_ERROR_MEMORY, CLI_MACHINE);
    snprintf(folder, length + 2, "%.*s", length > 0 ? (int)length : 1, length > 0 ? picture : ".");
    CliStatus status = CLI_OK;
    if (access(folder, W_OK) != 0) {
        char text[128];
        snprintf(text, sizeof text, "cannot write into the folder: %s", strerror(errno));
        status = fail_machine(drawing, GLINT_ERROR_FILE, picture, text);
    }
    free(folder);
    return status;
}

/* The part to draw, now that the scene's size is known. */
static CliStatus choose_area(Drawing *drawing) {
    const CliRenderOptions *options = drawing->options;
    GlintSceneInfo info;
    glint_scene_info(drawing->file.scene, &info);
    CliStats *stats = &drawing->stats;
    /* Of a picture drawn anew, its recipe stands for the options that are not given. */
    const GlintRecipe *recipe = drawing->file.recipe;
    bool sized = options->width > 0, crop = options->crop_width > 0;
    bool again = recipe != NULL && !sized && !crop;
    stats->width = sized ? options->width : recipe != NULL ? recipe->width : info.width;
    stats->height = sized ? options->height : recipe != NULL ? recipe->height : info.height;
    stats->crop_x = crop ? options->crop_x : again ? recipe->crop_x : 0;
    stats->crop_y = crop ? options->crop_y : again ? recipe->crop_y : 0;
    stats->crop_width = crop ? options->crop_width : again ? recipe->crop_width : stats->width;
    stats->crop_height = crop ? options->crop_height : again ? recipe->crop_height : stats->height;
    if ((int64_t)stats->crop_x + stats->crop_width > stats->width ||
        (int64_t)stats->crop_y + stats->crop_height > stats->height) {
        cli_progress_clear(&drawing->file.progress);
        return cli_message_usage("--crop %d,%d,%d,%d reaches outside of the %d x %d pixels of '%s'",
            stats->crop_x, stats->crop_y, stats->crop_width, stats->crop_height, stats->width,
            stats->height, cli_job_name(drawing->file.job));
    }
    drawing->area = glint_render_desc_default();
    drawing->area.width = stats->width;
    drawing->area.height = stats->height;
    drawing->area.samples = options->samples;
    if (recipe != NULL) {
        if (options->samples == 0) drawing->area.samples = recipe->samples;
        drawing->area.light = recipe->light;
        drawing->area.sampling = recipe->sampling;
    }
    drawing->area.crop_x = stats->crop_x;
    drawing->area.crop_y = stats->crop_y;
    drawing->area.crop_width = stats->crop_width;
    drawing->area.crop_height = stats->crop_height;
    drawing->area.mistakes = options->mistakes;
    if (recipe != NULL && options->mistakes.set == 0) drawing->area.mistakes = recipe->mistakes;
    drawing->area.monitor = &drawing->file.monitor;
    drawing->area.show = options->show;
    drawing->area.shown_range = drawing->shown_range;
    return CLI_OK;
}

/* The light to show alone: by its name, else by its number. */
static CliStatus choose_light(Drawing *drawing) {
    const char *wanted = drawing->options->light, *text = wanted;
    GlintSceneInfo info;
    glint_scene_info(drawing->file.scene, &info);
    if (wanted == NULL) return CLI_OK;
    int count = (int)info.light_count;
    for (int i = 1; i <= count; i++) {
        GlintSource source;
        bool known =
            glint_scene_source(drawing->file.scene, GLINT_OBJECT_LIGHT, (uint32_t)i, &source);
        if (known && strcmp(source.name, wanted) == 0) drawing->area.light = i;
    }
    bool found = drawing->area.light > 0 ||
                 (cli_value_digits(&text, 1, count, &drawing->area.light) && *text == '\0');
    if (found) return CLI_OK;
    cli_progress_clear(&drawing->file.progress);
    return cli_message_usage("no light of '%s' is named '%s', and it has %d, from 1",
        cli_job_name(drawing->file.job), wanted, count);
}

/* Linux grants more memory than there is and kills the program later, so what cannot fit is
 * refused here. */
static bool allocate_pixels(Drawing *drawing) {
    uint64_t pixel_count =
        (uint64_t)drawing->stats.crop_width * (uint64_t)drawing->stats.crop_height;
    uint64_t size = pixel_count * 3 * sizeof(float);
    long page_count = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    bool known = page_count > 0 && page_size > 0;
    if (size > SIZE_MAX || (known && size / (uint64_t)page_size >= (uint64_t)page_count))
        return false;
    drawing->pixels = malloc((size_t)size);
    if (drawing->pixels == NULL) return false;
    GlintSceneInfo info;
    glint_scene_info(drawing->file.scene, &info);
    if (!cli_layers_init(&drawing->layers, drawing->options->layers, (size_t)pixel_count,
            (int)info.light_count)) {
        return false;
    }
    cli_layers_aim(&drawing->layers, &drawing->area);
    return true;
}

/* A picture with layers is drawn several times before it is written. */
static GlintStatus draw_layers(Drawing *drawing, const GlintSaveDesc *desc) {
    CliLayers *layers = &drawing->layers;
    GlintError *error = &drawing->file.error;
    if (!allocate_pixels(drawing)) {
        snprintf(error->message, sizeof error->message, "not enough memory for the picture");
        return GLINT_ERROR_MEMORY;
    }
    GlintStatus status = glint_render(drawing->file.scene, &drawing->area, drawing->pixels, error);
    if (status == GLINT_OK) {
        status = cli_layers_render(layers, drawing->file.scene, &drawing->area, error);
    }
    if (status != GLINT_OK) return status;
    GlintImage image = {.width = drawing->stats.crop_width,
        .height = drawing->stats.crop_height,
        .pixels = drawing->pixels};
    double began = cli_clock();
    status = cli_layers_save(layers, &image, drawing->file.job->picture, desc, error);
    drawing->stats.write_seconds = cli_clock() - began;
    return status;
}

static GlintStatus draw_plain(Drawing *drawing, const GlintSaveDesc *desc) {
    double began = cli_clock();
    GlintStatus status = glint_render_save(drawing->file.scene, &drawing->area,
        drawing->file.job->picture, desc, &drawing->file.error);
    GlintStats stats;
    glint_scene_stats(drawing->file.scene, &stats);
    drawing->stats.write_seconds = cli_clock() - began - stats.trace_seconds;
    return status;
}

/* The scene's name: of a picture drawn anew, that of the scene inside. */
static const char *title_of(const CliSceneFile *file) {
    return cli_path_base(
        file->recipe != NULL ? file->recipe->files[0].name : cli_job_name(file->job));
}

static GlintStatus draw_and_save(Drawing *drawing) {
    CliSceneFile *file = &drawing->file;
    GlintRecipe *recipe = NULL, own;
    GlintRecipeFile *files = NULL;
    GlintStatus status = GLINT_OK;
    if (drawing->options->show == GLINT_SHOW_PICTURE) {
        status = glint_scene_recipe(
            file->scene, &drawing->area, drawing->options->embed, &recipe, &file->error);
    }
    if (status != GLINT_OK) return status;
    const char *bad = drawing->options->embed ? cli_unpack_bad_name(recipe) : NULL;
    if (bad != NULL) {
        snprintf(file->error.message, sizeof file->error.message,
            "--embed needs names that are not absolute, and the scene names '%s'", bad);
        glint_recipe_destroy(recipe);
        return GLINT_ERROR_SCENE;
    }
    GlintSaveDesc save = glint_save_desc_default();
    save.title = title_of(file);
    save.thread_count = drawing->options->thread_count;
    save.monitor = &file->monitor;
    save.recipe = recipe;
    if (file->recipe != NULL && recipe != NULL) {
        /* The scene inside was unpacked to a place that is soon gone. */
        own = *recipe;
        files = malloc((size_t)own.file_count * sizeof *files);
        if (files != NULL) {
            memcpy(files, own.files, (size_t)own.file_count * sizeof *files);
            files[0].name = file->recipe->files[0].name;
            own.files = files;
            save.recipe = &own;
        }
    }
    status =
        drawing->options->layers == 0 ? draw_plain(drawing, &save) : draw_layers(drawing, &save);
    free(files);
    glint_recipe_destroy(recipe);
    return status;
}

static CliStatus draw(Drawing *drawing) {
    CliStatus refused = check_picture(drawing);
    if (refused != CLI_OK) return refused;

    GlintSceneDesc desc = glint_scene_desc_default();
    desc.dialect = drawing->options->dialect;
    desc.thread_count = drawing->options->thread_count;
    desc.isa = drawing->options->isa;
    desc.reverse_transforms = cli_scene_file_reverses(&drawing->options->mistakes);
    desc.keep_sources = drawing->options->embed || drawing->options->light != NULL;
    refused = cli_scene_file_load(&drawing->file, &desc);
    if (refused != CLI_OK) return refused;
    refused = choose_area(drawing);
    if (refused == CLI_OK) refused = choose_light(drawing);
    if (refused != CLI_OK) return refused;
    refused = cli_scene_file_commit(&drawing->file);
    if (refused != CLI_OK) return refused;
    GlintStatus status = draw_and_save(drawing);
    if (status == GLINT_OK) return CLI_OK;
    if (status == GLINT_ERROR_FILE && drawing->file.error.path[0] == '\0') {
        snprintf(drawing->file.error.path, sizeof drawing->file.error.path, "%s",
            drawing->file.job->picture);
    }
    return cli_scene_file_fail(&drawing->file, status, CLI_MACHINE);
}

/* ---------------------------------------------------------------- all scenes */

/* What the shades of a shown value mean. */
static void tell_range(const Drawing *drawing) {
    const char *name = cli_job_name(drawing->file.job);
    const double *range = drawing->shown_range;
    if (drawing->options->show == GLINT_SHOW_DEPTH) {
        fprintf(
            stderr, "%s: a distance of %.4g is white, %.4g is black\n", name, range[0], range[1]);
    } else if (drawing->options->show == GLINT_SHOW_COST) {
        fprintf(stderr, "%s: %.4g nodes, leaves and exact tests of a pixel are white\n", name,
            range[1]);
    }
}

static CliStatus announce(Drawing *drawing) {
    CliStats *stats = &drawing->stats;
    stats->job = drawing->file.job;
    stats->total_seconds = cli_clock() - drawing->file.progress.began;
    stats->resident_peak = cli_stats_resident_peak();
    glint_scene_info(drawing->file.scene, &stats->scene);
    if (drawing->options->samples > 0) stats->scene.samples = drawing->options->samples;
    glint_scene_stats(drawing->file.scene, &stats->library);
    CliStatsFormat format = drawing->options->stats;
    if (format == CLI_STATS_JSON) {
        cli_stats_print_json(stats);
    } else if (!drawing->options->quiet) {
        puts(drawing->file.job->picture);
    }
    CliStatus status = cli_message_flush_output();
    if (!drawing->options->quiet) tell_range(drawing);
    if (format == CLI_STATS_TEXT) cli_stats_print_text(stats);
    return status;
}

static CliStatus list_isa(void) {
    for (int i = 0; glint_isa_name(i) != NULL; i++) puts(glint_isa_name(i));
    return cli_message_flush_output();
}

static CliStatus list_mistakes(void) {
    for (int i = 0; i < GLINT_MISTAKE_COUNT; i++) {
        printf(
            "%-20s %s\n", glint_mistake_name((GlintMistake)i), glint_mistake_text((GlintMistake)i));
    }
    return cli_message_flush_output();
}

static CliStatus run(void *values, const CliOperands *operands) {
    const CliRenderOptions *options = values;
    if (options->list_isa) return list_isa();
    if (options->list_mistakes) return list_mistakes();
    CliJobs jobs;
    bool shows = options->show != GLINT_SHOW_PICTURE;
    if (options->layers != 0 && (shows || options->light != NULL)) {
        return cli_message_usage("--layers are of the whole picture, and --show shows none");
    }
    if (options->embed && shows) {
        return cli_message_usage(
            "--embed is for a picture that can be drawn again, not for --show");
    }
    CliStatus status = cli_jobs_init(&jobs, operands, options->output, options->picture_ending);
    bool progress = !options->quiet && cli_message_on_terminal();
    if (status < CLI_USAGE) {
        for (int i = 0; i < jobs.count && !cli_interrupt_seen(); i++) {
            Drawing drawing = {.options = options};
            cli_scene_file_begin(&drawing.file, &jobs.items[i], i, jobs.count, progress);
            CliStatus drawn = draw(&drawing);
            cli_progress_clear(&drawing.file.progress);
            if (drawn == CLI_OK && !cli_interrupt_seen()) drawn = announce(&drawing);
            status = cli_status_worse(status, drawn);
            free(drawing.pixels);
            cli_layers_reset(&drawing.layers);
            cli_scene_file_end(&drawing.file);
        }
    }
    cli_jobs_reset(&jobs);
    return status;
}

static CliRenderOptions defaults = {.dialect = GLINT_DIALECT_AUTO, .picture_ending = ".png"};

const CliVerb cli_verb_render = {.name = "render",
    .operands = "SCENE...",
    .summary = "draw scenes",
    .about = "Draws scenes. A SCENE is an XML file, a folder (all *.xml in it), or - for\n"
             "standard input. The picture of a.xml is a.xml.png beside it.",
    .notes = "--show takes normal, depth, uv (texture coordinates), id (a colour a surface),\n"
             "cost (what the rays of a pixel take), shadow (the part of the lights that is\n"
             "seen) or light:NAME (one light alone, by its name or number). The picture of\n"
             "a.xml is then a.xml.normal.png and so on.",
    .example_text = "draw one scene larger than it asks for, on four threads",
    .example = "glint --size 1920x1080 -t 4 -o big.png scenes/solids.xml",
    .options = cli_render_option_table,
    .option_count = CLI_RENDER_OPTION_COUNT,
    .values = &defaults,
    .run = run};
