/* SPDX-License-Identifier: MIT
 * `glint why SCENE X,Y`: reads the scene, explains, and puts the answer on standard output or into
 * a file. An answer is made in memory first: what fails leaves no half of it. */
#define _POSIX_C_SOURCE 200809L
#include "why.h"

#include "interrupt.h"
#include "message.h"
#include "scene_file.h"
#include "value.h"
#include "verb.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct WhyOptions {
    CliWhyFormat format;
    const char *output; /* null: standard output, of a page: beside the scene */
    GlintDialect dialect;
    int width, height; /* 0: the scene's */
    int samples;       /* per pixel; 0: the scene's */
    int sample;        /* in detail, from 1; 0: the first */
    int region[4];
    int step;
} WhyOptions;

/* ---------------------------------------------------------------- options */

static const char *format_name_at(int index) {
    /* In the order of CliWhyFormat. */
    static const char *const names[] = {"text", "json", "obj", "html", NULL};
    return names[index];
}

static CliStatus set_format(void *values, const char *value) {
    WhyOptions *options = values;
    int index = 0;
    CliStatus status = cli_value_name("format", value, format_name_at, &index);
    options->format = (CliWhyFormat)index;
    return status;
}

static CliStatus set_output(void *values, const char *value) {
    WhyOptions *options = values;
    options->output = value;
    return value[0] != '\0' ? CLI_OK : cli_message_usage("--output takes the name of a file");
}

static CliStatus set_size(void *values, const char *value) {
    WhyOptions *options = values;
    return cli_value_size("size", value, &options->width, &options->height);
}

enum { SAMPLES_LIMIT = 65536, STEP_LIMIT = 1024 };

static CliStatus set_samples(void *values, const char *value) {
    WhyOptions *options = values;
    return cli_value_number("samples", value, 1, SAMPLES_LIMIT, &options->samples);
}

static CliStatus set_sample(void *values, const char *value) {
    WhyOptions *options = values;
    return cli_value_number("sample", value, 1, SAMPLES_LIMIT, &options->sample);
}

static CliStatus set_dialect(void *values, const char *value) {
    WhyOptions *options = values;
    return cli_value_dialect(value, &options->dialect);
}

/* Numbers with commas between them; the later half of a region at least 1. */
static bool read_numbers(const char *text, int count, int *numbers) {
    for (int i = 0; i < count; i++) {
        int low = i >= 2 ? 1 : 0;
        if (i > 0 && !cli_value_letter(&text, ",")) return false;
        if (!cli_value_digits(&text, low, CLI_SIDE_LIMIT, &numbers[i])) return false;
    }
    return *text == '\0';
}

static CliStatus set_region(void *values, const char *value) {
    WhyOptions *options = values;
    if (read_numbers(value, 4, options->region)) return CLI_OK;
    return cli_message_usage("--region takes the left, the top, the width and the height of a part "
                             "of the picture, such as 0,0,64,64, not '%s'",
        value);
}

static CliStatus set_step(void *values, const char *value) {
    WhyOptions *options = values;
    return cli_value_number("step", value, 1, STEP_LIMIT, &options->step);
}

static const char pixel[] = "The pixel", answer[] = "The answer";

static const CliOption option_table[] = {
    {0, "size", "WxH", CLI_FORM_REQUIRED, pixel, "of a picture of W x H, whatever the scene says",
        set_size},
    {0, "samples", "N", CLI_FORM_REQUIRED, pixel, "with N samples a pixel, likewise", set_samples},
    {0, "sample", "K", CLI_FORM_REQUIRED, pixel, "tell the rays of its K-th sample (default: 1)",
        set_sample},
    {0, "dialect", "NAME", CLI_FORM_REQUIRED, pixel, "follow the rules of a year (see below)",
        set_dialect},
    {0, "format", "text|json|obj|html", CLI_FORM_REQUIRED, answer,
        "obj: for a viewer; html: a page to click in", set_format},
    {'o', "output", "FILE", CLI_FORM_REQUIRED, answer, "write to FILE", set_output},
    {0, "region", "X,Y,W,H", CLI_FORM_REQUIRED, answer, "html: these pixels only (default: all)",
        set_region},
    {0, "step", "N", CLI_FORM_REQUIRED, answer, "html: every N-th pixel (default: as many as fit)",
        set_step},
};

/* ---------------------------------------------------------------- what is asked */

/* The operands: a scene and, but for a page, a pixel. */
static CliStatus read_operands(
    const CliOperands *operands, CliWhyFormat format, CliOperands *scene, CliWhy *why) {
    int place[2];
    *scene = (CliOperands){operands->items, 1};
    if (operands->count == 0) return cli_message_usage("no scene given");
    if (operands->count > 2) {
        return cli_message_usage(
            "why takes one scene and one pixel, not %d words", operands->count);
    }
    if (operands->count == 1) {
        return format == CLI_WHY_HTML
                   ? CLI_OK
                   : cli_message_usage("which pixel? Say so behind the scene, as X,Y");
    }
    if (!read_numbers(operands->items[1], 2, place)) {
        return cli_message_usage(
            "a pixel is X,Y, counted from 0 at the top left, not '%s'", operands->items[1]);
    }
    why->x = place[0];
    why->y = place[1];
    return CLI_OK;
}

/* The samples of a pixel are a grid of as many rows as columns: round(sqrt). */
static int grid_of(int samples) {
    int n = 1;
    while ((n + 1) * (n + 1) <= samples + n) n++;
    return n * n;
}

/* Whether pixel, sample and region lie in the picture, now that its size is known. */
static CliStatus check_place(CliWhy *why, const WhyOptions *options) {
    glint_scene_info(why->scene, &why->info);
    why->width = options->width > 0 ? options->width : why->info.width;
    why->height = options->height > 0 ? options->height : why->info.height;
    if (why->x >= why->width || why->y >= why->height) {
        return cli_message_usage("there is no pixel %d,%d: the picture has %d x %d, so X is 0 to "
                                 "%d from the left and Y 0 to %d from the top",
            why->x, why->y, why->width, why->height, why->width - 1, why->height - 1);
    }
    why->samples = grid_of(options->samples > 0 ? options->samples : why->info.samples);
    if (options->sample > why->samples) {
        return cli_message_usage(
            "there is no sample %d: the pixel has %d", options->sample, why->samples);
    }
    if ((int64_t)options->region[0] + options->region[2] > why->width ||
        (int64_t)options->region[1] + options->region[3] > why->height) {
        return cli_message_usage(
            "--region reaches outside of the %d x %d pixels", why->width, why->height);
    }
    memcpy(why->region, options->region, sizeof why->region);
    why->step = options->step;
    why->dialect = options->dialect;
    why->sample = options->sample > 0 ? options->sample - 1 : 0;
    return CLI_OK;
}

/* ---------------------------------------------------------------- the answer */

/* One user serves both callbacks of the library. */
typedef struct Listener {
    CliWhy *why;
    void (*sample)(void *user, const GlintExplainSample *sample);
    void *user;
} Listener;

static void on_sample(void *user, const GlintExplainSample *sample) {
    const Listener *listener = user;
    listener->sample(listener->user, sample);
}

static void on_pixel(void *user, const GlintExplainPixel *told) {
    const Listener *listener = user;
    listener->why->pixel = *told;
}

GlintStatus cli_why_explain(
    CliWhy *why, void (*sample)(void *user, const GlintExplainSample *sample), void *user) {
    Listener listener = {why, sample, user};
    const GlintExplainSink sink = {on_sample, on_pixel, &listener, 0};
    GlintRenderDesc desc = why->desc;
    desc.crop_x = why->x, desc.crop_y = why->y;
    desc.crop_width = desc.crop_height = 1;
    /* A page asks for many pixels and tells of the progress itself. */
    GlintMonitor monitor = *why->desc.monitor;
    monitor.progress = NULL;
    desc.monitor = &monitor;
    return glint_explain(why->scene, &desc, &sink, &why->error);
}

/* Under a temporary name first, so that the file appears whole or not at all. */
static CliStatus save(const char *path, const char *bytes, size_t size) {
    struct stat info;
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode)) {
        FILE *device = fopen(path, "w"); /* or a pipe: written in place */
        bool written = device != NULL && fwrite(bytes, 1, size, device) == size;
        if (device != NULL) written &= fclose(device) == 0;
        if (!written) cli_message_error("cannot write '%s': %s", path, strerror(errno));
        return written ? CLI_OK : CLI_MACHINE;
    }
    size_t room = strlen(path) + sizeof ".XXXXXX";
    char *name = malloc(room);
    if (name == NULL) {
        cli_message_error("not enough memory");
        return CLI_MACHINE;
    }
    snprintf(name, room, "%s.XXXXXX", path);
    int file = mkstemp(name);
    FILE *out = file >= 0 ? fdopen(file, "w") : NULL;
    bool good = out != NULL && fwrite(bytes, 1, size, out) == size;
    mode_t mask = umask(0);
    umask(mask);
    good = good && fchmod(file, 0666 & ~mask) == 0;
    if (out != NULL) good = fclose(out) == 0 && good;
    good = good && rename(name, path) == 0;
    if (!good) {
        cli_message_error("cannot write '%s': %s", path, strerror(errno));
        if (file >= 0) unlink(name);
    }
    free(name);
    return good ? CLI_OK : CLI_MACHINE;
}

/* Where a page goes that is given no name: beside the scene. */
static char *page_name(const char *scene) {
    size_t room = strlen(scene) + sizeof ".why.html";
    char *name = malloc(room);
    if (name != NULL) snprintf(name, room, "%s.why.html", scene);
    return name;
}

static CliStatus deliver(
    const CliWhy *why, const WhyOptions *options, const char *bytes, size_t size) {
    if (options->output == NULL && options->format != CLI_WHY_HTML) {
        fwrite(bytes, 1, size, stdout);
        return cli_message_flush_output();
    }
    char *own = options->output == NULL ? page_name(why->name) : NULL;
    const char *path = options->output != NULL ? options->output : own;
    if (path == NULL) {
        cli_message_error("not enough memory");
        return CLI_MACHINE;
    }
    CliStatus status = save(path, bytes, size);
    if (status == CLI_OK) puts(path);
    free(own);
    return status == CLI_OK ? cli_message_flush_output() : status;
}

static GlintStatus write_form(CliWhy *why, CliWhyFormat format) {
    switch (format) {
    case CLI_WHY_TEXT: return cli_why_text(why);
    case CLI_WHY_JSON: return cli_why_json(why);
    case CLI_WHY_OBJ: return cli_why_obj(why);
    case CLI_WHY_HTML: break;
    }
    return cli_why_html(why);
}

static CliStatus explain(CliWhy *why, CliSceneFile *file, const WhyOptions *options) {
    why->desc = glint_render_desc_default();
    why->desc.width = options->width;
    why->desc.height = options->height;
    why->desc.samples = options->samples;
    why->desc.monitor = &file->monitor;
    char *bytes = NULL;
    size_t size = 0;
    why->out = open_memstream(&bytes, &size);
    GlintStatus status = GLINT_ERROR_MEMORY;
    if (why->out != NULL) {
        status = write_form(why, options->format);
        bool whole = !ferror(why->out);
        if (fclose(why->out) != 0 || !whole) status = GLINT_ERROR_MEMORY;
    }
    cli_progress_clear(&file->progress);
    CliStatus answered;
    if (status == GLINT_OK) {
        answered = deliver(why, options, bytes, size);
    } else {
        file->error = why->error;
        answered = cli_scene_file_fail(file, status, CLI_MACHINE);
    }
    free(bytes);
    return answered;
}

static CliStatus run(void *values, const CliOperands *operands) {
    const WhyOptions *options = values;
    CliWhy why = {.x = -1, .y = -1};
    CliOperands scene;
    CliStatus status = read_operands(operands, options->format, &scene, &why);
    if (status != CLI_OK) return status;
    CliJobs jobs;
    status = cli_jobs_init_plain(&jobs, &scene);
    if (status == CLI_OK && jobs.count != 1) {
        status = cli_message_usage("why takes one scene, not the folder '%s'", scene.items[0]);
    }
    if (status == CLI_OK) {
        CliSceneFile file;
        bool progress = options->format == CLI_WHY_HTML && cli_message_on_terminal();
        cli_scene_file_begin(&file, &jobs.items[0], 0, 1, progress);
        GlintSceneDesc desc = glint_scene_desc_default();
        desc.dialect = options->dialect;
        desc.keep_sources = true;
        status = cli_scene_file_load(&file, &desc);
        why.scene = file.scene;
        why.name = cli_job_name(file.job);
        if (status == CLI_OK) status = cli_scene_file_commit(&file);
        if (status == CLI_OK && !cli_interrupt_seen()) status = check_place(&why, options);
        if (status == CLI_OK && !cli_interrupt_seen()) status = explain(&why, &file, options);
        cli_scene_file_end(&file);
    }
    cli_jobs_reset(&jobs);
    return status;
}

static WhyOptions defaults = {.dialect = GLINT_DIALECT_AUTO};

const CliVerb cli_verb_why = {.name = "why",
    .operands = "SCENE X,Y",
    .summary = "tell why a pixel has its colour",
    .about = "Tells why the pixel X,Y, counted from 0 at the top left, has its colour: every\n"
             "ray that was traced for it, what it met, what each light did there and what\n"
             "was in its way, and the sum of all that, which is the pixel to the last bit.\n"
             "SCENE is an XML file, or - for standard input.\n"
             "\n"
             "--format html makes SCENE.why.html, a page with the picture: a click on a\n"
             "pixel shows its rays. It needs no pixel.",
    .notes = NULL,
    .example_text = "why is this pixel as it is?",
    .example = "glint why scenes/solids.xml 450,300",
    .options = option_table,
    .option_count = CLI_COUNT(option_table),
    .values = &defaults,
    .run = run};
