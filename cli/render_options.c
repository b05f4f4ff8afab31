/* SPDX-License-Identifier: MIT
 * What the values of the options mean, and their table. */
#include "render_options.h"

#include "message.h"
#include "value.h"

#include <stdio.h>
#include <string.h>

static CliStatus set_output(void *values, const char *value) {
    CliRenderOptions *options = values;
    options->output = value;
    return value[0] != '\0' ? CLI_OK : cli_message_usage("--output takes the name of a file");
}

static CliStatus set_size(void *values, const char *value) {
    CliRenderOptions *options = values;
    return cli_value_size("size", value, &options->width, &options->height);
}

static CliStatus set_crop(void *values, const char *value) {
    CliRenderOptions *options = values;
    const char *text = value;
    if (cli_value_digits(&text, 0, CLI_SIDE_LIMIT, &options->crop_x) &&
        cli_value_letter(&text, ",") &&
        cli_value_digits(&text, 0, CLI_SIDE_LIMIT, &options->crop_y) &&
        cli_value_letter(&text, ",") &&
        cli_value_digits(&text, 1, CLI_SIDE_LIMIT, &options->crop_width) &&
        cli_value_letter(&text, ",") &&
        cli_value_digits(&text, 1, CLI_SIDE_LIMIT, &options->crop_height) && *text == '\0') {
        return CLI_OK;
    }
    return cli_message_usage(
        "--crop takes the left, the top, the width and the height of a part of the picture, "
        "such as 0,0,64,64, not '%s'",
        value);
}

static CliStatus set_samples(void *values, const char *value) {
    enum { SAMPLES_LIMIT = 65536 };
    CliRenderOptions *options = values;
    return cli_value_number("samples", value, 1, SAMPLES_LIMIT, &options->samples);
}

static const char *layer_name_at(int index) {
    /* In the order of the bits of CliLayerKind. */
    static const char *const names[] = {
        "depth", "normal", "albedo", "surface", "lights", "all", NULL};
    return names[index];
}

/* Names with commas between them. */
static CliStatus set_layers(void *values, const char *value) {
    CliRenderOptions *options = values;
    for (const char *name = value;; name++) {
        char word[32];
        size_t size = strcspn(name, ",");
        snprintf(word, sizeof word, "%.*s", (int)size, name);
        int index;
        CliStatus status = cli_value_name("layers", word, layer_name_at, &index);
        if (status != CLI_OK) return status;
        bool all = layer_name_at(index + 1) == NULL;
        options->layers |= all ? (1u << index) - 1 : 1u << index;
        name += size;
        if (*name == '\0') return CLI_OK;
    }
}

/* In the order of GlintShow. */
static const struct {
    const char *name, *ending;
} shows[GLINT_SHOW_COUNT] = {{"picture", ".png"}, {"normal", ".normal.png"},
    {"depth", ".depth.png"}, {"uv", ".uv.png"}, {"id", ".id.png"}, {"cost", ".cost.png"},
    {"shadow", ".shadow.png"}};

static const char *show_name_at(int index) {
    if (index < GLINT_SHOW_COUNT) return shows[index].name;
    return index == GLINT_SHOW_COUNT ? "light:NAME" : NULL;
}

static CliStatus set_show(void *values, const char *value) {
    static const char light[] = "light:";
    CliRenderOptions *options = values;
    options->show = GLINT_SHOW_PICTURE;
    options->light = NULL;
    if (strncmp(value, light, strlen(light)) == 0 && value[strlen(light)] != '\0') {
        options->light = value + strlen(light);
        options->picture_ending = ".light.png";
        return CLI_OK;
    }
    int index = 0;
    CliStatus status = cli_value_name("show", value, show_name_at, &index);
    if (status != CLI_OK) return status;
    options->show = (GlintShow)index;
    options->picture_ending = shows[index].ending;
    return CLI_OK;
}

static CliStatus set_break(void *values, const char *value) {
    CliRenderOptions *options = values;
    options->list_mistakes = strcmp(value, "list") == 0;
    return options->list_mistakes ? CLI_OK : cli_value_mistakes("break", value, &options->mistakes);
}

static CliStatus set_embed(void *values, const char *value) {
    CliRenderOptions *options = values;
    (void)value;
    options->embed = true;
    return CLI_OK;
}

static CliStatus set_dialect(void *values, const char *value) {
    CliRenderOptions *options = values;
    return cli_value_dialect(value, &options->dialect);
}

static CliStatus set_threads(void *values, const char *value) {
    CliRenderOptions *options = values;
    return cli_value_threads(value, &options->thread_count);
}

static CliStatus set_isa(void *values, const char *value) {
    CliRenderOptions *options = values;
    return cli_value_isa(value, &options->isa);
}

static CliStatus set_list_isa(void *values, const char *value) {
    CliRenderOptions *options = values;
    (void)value;
    options->list_isa = true;
    return CLI_OK;
}

static const char *stats_name_at(int index) {
    static const char *const names[] = {"text", "json", NULL};
    return names[index];
}

static CliStatus set_stats(void *values, const char *value) {
    CliRenderOptions *options = values;
    int index = 0;
    CliStatus status =
        value == NULL ? CLI_OK : cli_value_name("stats", value, stats_name_at, &index);
    options->stats = index == 0 ? CLI_STATS_TEXT : CLI_STATS_JSON;
    return status;
}

static CliStatus set_quiet(void *values, const char *value) {
    CliRenderOptions *options = values;
    (void)value;
    options->quiet = true;
    return CLI_OK;
}

static const char picture[] = "The picture", machine[] = "The machine", messages[] = "Messages";

const CliOption cli_render_option_table[CLI_RENDER_OPTION_COUNT] = {
    {'o', "output", "FILE", CLI_FORM_REQUIRED, picture,
        "write to FILE (.png, .pfm or .exr), or into a folder", set_output},
    {0, "size", "WxH", CLI_FORM_REQUIRED, picture, "draw W x H pixels, whatever the scene says",
        set_size},
    {0, "crop", "X,Y,W,H", CLI_FORM_REQUIRED, picture, "draw only W x H pixels from X,Y (top left)",
        set_crop},
    {0, "samples", "N", CLI_FORM_REQUIRED, picture,
        "draw N samples a pixel, whatever the scene says", set_samples},
    {0, "layers", "A,B", CLI_FORM_REQUIRED, picture,
        "add depth, normal, albedo, surface, lights, or all", set_layers},
    {0, "show", "WHAT", CLI_FORM_REQUIRED, picture,
        "not the picture, but what explains it (see below)", set_show},
    {0, "break", "A,B", CLI_FORM_REQUIRED, picture,
        "draw with typical mistakes; --break list names them", set_break},
    {0, "embed", NULL, CLI_FORM_NONE, picture, "put the scene and its files into the PNG",
        set_embed},
    {0, "dialect", "NAME", CLI_FORM_REQUIRED, picture, "follow the rules of a year (see below)",
        set_dialect},
    {'t', "threads", "N", CLI_FORM_REQUIRED, machine, "draw with N threads (default: one a core)",
        set_threads},
    {0, "isa", "NAME", CLI_FORM_REQUIRED, machine, "use this instruction set, not the fastest",
        set_isa},
    {0, "list-isa", NULL, CLI_FORM_NONE, machine, "list the instruction sets, fastest first",
        set_list_isa},
    {0, "stats", "text|json", CLI_FORM_OPTIONAL, messages, "tell times, rays, tree and memory",
        set_stats},
    {'q', "quiet", NULL, CLI_FORM_NONE, messages, "no progress, and no names of pictures",
        set_quiet},
};
