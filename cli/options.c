/* SPDX-License-Identifier: MIT
 * The parser of the command line. It knows the options only through the table; what a value means
 * is decided in one switch. The first mistake is reported, by name and with what is allowed. */
#include "options.h"

#include "message.h"
#include "option_table.h"
#include "suggest.h"

#include <stdio.h>
#include <string.h>

enum { SIDE_LIMIT = 1 << 28, PIXEL_LIMIT = 1 << 28, THREAD_LIMIT = 1024, SAMPLES_LIMIT = 65536 };

/* A whole number from low to high at *text, which moves behind it. */
static bool parse_number(const char **text, int low, int high, int *value) {
    const char *digit = *text;
    int64_t number = 0;
    for (; *digit >= '0' && *digit <= '9'; digit++) {
        number = number * 10 + (*digit - '0');
        if (number > high) return false;
    }
    if (digit == *text || number < low) return false;
    *text = digit;
    *value = (int)number;
    return true;
}

static bool parse_letter(const char **text, const char *letters) {
    if (**text == '\0' || strchr(letters, **text) == NULL) return false;
    ++*text;
    return true;
}

static CliStatus set_threads(CliOptions *options, const char *value) {
    const char *text = value;
    if (parse_number(&text, 1, THREAD_LIMIT, &options->thread_count) && *text == '\0')
        return CLI_OK;
    return cli_message_usage(
        "--threads takes a number from 1 to %d, not '%s'", (int)THREAD_LIMIT, value);
}

static CliStatus set_size(CliOptions *options, const char *value) {
    const char *text = value;
    if (parse_number(&text, 1, SIDE_LIMIT, &options->width) && parse_letter(&text, "xX") &&
        parse_number(&text, 1, SIDE_LIMIT, &options->height) && *text == '\0' &&
        (int64_t)options->width * options->height <= PIXEL_LIMIT) {
        return CLI_OK;
    }
    return cli_message_usage(
        "--size takes two numbers of pixels, such as 640x480, at most 2^28 together, not '%s'",
        value);
}

static CliStatus set_crop(CliOptions *options, const char *value) {
    const char *text = value;
    if (parse_number(&text, 0, SIDE_LIMIT, &options->crop_x) && parse_letter(&text, ",") &&
        parse_number(&text, 0, SIDE_LIMIT, &options->crop_y) && parse_letter(&text, ",") &&
        parse_number(&text, 1, SIDE_LIMIT, &options->crop_width) && parse_letter(&text, ",") &&
        parse_number(&text, 1, SIDE_LIMIT, &options->crop_height) && *text == '\0') {
        return CLI_OK;
    }
    return cli_message_usage(
        "--crop takes the left, the top, the width and the height of a part of the picture, "
        "such as 0,0,64,64, not '%s'",
        value);
}

/* "a, b or c" from a function that lists names. */
static void list_names(const char *(*name_at)(int index), char *buffer, size_t size) {
    buffer[0] = '\0';
    size_t used = 0;
    for (int i = 0; name_at(i) != NULL && used < size; i++) {
        const char *between = i == 0 ? "" : name_at(i + 1) == NULL ? " or " : ", ";
        used += (size_t)snprintf(buffer + used, size - used, "%s%s", between, name_at(i));
    }
}

static CliStatus refuse_name(
    const char *option, const char *value, const char *(*name_at)(int index)) {
    char allowed[256];
    list_names(name_at, allowed, sizeof allowed);
    CliSuggestion suggestion;
    cli_suggestion_begin(&suggestion, value);
    for (int i = 0; name_at(i) != NULL; i++) cli_suggestion_add(&suggestion, name_at(i));
    if (suggestion.best != NULL) {
        return cli_message_usage(
            "--%s takes %s, not '%s'; did you mean '%s'?", option, allowed, value, suggestion.best);
    }
    return cli_message_usage("--%s takes %s, not '%s'", option, allowed, value);
}

static const char *dialect_name_at(int index) {
    return index < GLINT_DIALECT_COUNT ? glint_dialect_name((GlintDialect)index) : NULL;
}

static CliStatus set_dialect(CliOptions *options, const char *value) {
    if (glint_dialect_from_name(value, &options->dialect)) return CLI_OK;
    return refuse_name("dialect", value, dialect_name_at);
}

static CliStatus set_isa(CliOptions *options, const char *value) {
    for (int i = 0; glint_isa_name(i) != NULL; i++) {
        if (strcmp(value, glint_isa_name(i)) == 0) {
            options->isa = glint_isa_name(i);
            return CLI_OK;
        }
    }
    return refuse_name("isa", value, glint_isa_name);
}

static const char *stats_name_at(int index) {
    static const char *const names[] = {"text", "json", NULL};
    return names[index];
}

static const char *help_name_at(int index) {
    static const char *const names[] = {"man", "markdown", NULL};
    return names[index];
}

static CliStatus set_samples(CliOptions *options, const char *value) {
    const char *text = value;
    if (parse_number(&text, 1, SAMPLES_LIMIT, &options->samples) && *text == '\0') return CLI_OK;
    return cli_message_usage(
        "--samples takes a number from 1 to %d, not '%s'", (int)SAMPLES_LIMIT, value);
}

static const char *layer_name_at(int index) {
    /* In the order of the bits of CliLayerKind. */
    static const char *const names[] = {
        "depth", "normal", "albedo", "surface", "lights", "all", NULL};
    return names[index];
}

/* Names with commas between them. */
static CliStatus set_layers(CliOptions *options, const char *value) {
    for (const char *name = value;; name++) {
        size_t size = strcspn(name, ",");
        int index = 0;
        while (layer_name_at(index) != NULL && (strlen(layer_name_at(index)) != size ||
                                                   strncmp(layer_name_at(index), name, size) != 0))
            index++;
        if (layer_name_at(index) == NULL) {
            char word[32];
            snprintf(word, sizeof word, "%.*s", (int)size, name);
            return refuse_name("layers", word, layer_name_at);
        }
        bool all = layer_name_at(index + 1) == NULL;
        options->layers |= all ? (1u << index) - 1 : 1u << index;
        name += size;
        if (*name == '\0') return CLI_OK;
    }
}

static CliStatus set_stats(CliOptions *options, const char *value) {
    options->stats = CLI_STATS_TEXT;
    if (value == NULL || strcmp(value, "text") == 0) return CLI_OK;
    options->stats = CLI_STATS_JSON;
    return strcmp(value, "json") == 0 ? CLI_OK : refuse_name("stats", value, stats_name_at);
}

static CliStatus set_help(CliOptions *options, const char *value) {
    options->action = CLI_ACTION_HELP;
    if (value == NULL) return CLI_OK;
    options->help = CLI_HELP_MAN;
    if (strcmp(value, "man") == 0) return CLI_OK;
    options->help = CLI_HELP_MARKDOWN;
    return strcmp(value, "markdown") == 0 ? CLI_OK : refuse_name("help", value, help_name_at);
}

static CliStatus apply(CliOptions *options, CliOptionId id, const char *value) {
    switch (id) {
    case CLI_OPTION_OUTPUT:
        options->output = value;
        return value[0] != '\0' ? CLI_OK : cli_message_usage("--output takes the name of a file");
    case CLI_OPTION_SIZE: return set_size(options, value);
    case CLI_OPTION_CROP: return set_crop(options, value);
    case CLI_OPTION_SAMPLES: return set_samples(options, value);
    case CLI_OPTION_LAYERS: return set_layers(options, value);
    case CLI_OPTION_DIALECT: return set_dialect(options, value);
    case CLI_OPTION_THREADS: return set_threads(options, value);
    case CLI_OPTION_ISA: return set_isa(options, value);
    case CLI_OPTION_LIST_ISA: options->action = CLI_ACTION_LIST_ISA; return CLI_OK;
    case CLI_OPTION_STATS: return set_stats(options, value);
    case CLI_OPTION_QUIET: options->quiet = true; return CLI_OK;
    case CLI_OPTION_HELP: return set_help(options, value);
    case CLI_OPTION_VERSION: options->action = CLI_ACTION_VERSION; return CLI_OK;
    case CLI_OPTION_COUNT: break;
    }
    return CLI_USAGE;
}

static CliStatus refuse_long(const char *name, size_t size) {
    char word[64];
    snprintf(word, sizeof word, "%.*s", (int)size, name);
    CliSuggestion suggestion;
    cli_suggestion_begin(&suggestion, word);
    for (int i = 0; i < CLI_OPTION_COUNT; i++) {
        cli_suggestion_add(&suggestion, cli_option_table[i].long_name);
    }
    if (suggestion.best != NULL) {
        return cli_message_usage(
            "unknown option '--%s'; did you mean '--%s'?", word, suggestion.best);
    }
    return cli_message_usage("unknown option '--%s'", word);
}

/* The arguments still to be read; an option may take the one after it as its value. */
typedef struct Cursor {
    int argc, index;
    char **argv;
} Cursor;

static CliStatus missing_value(const CliOption *option) {
    return cli_message_usage(
        "--%s needs a value: --%s %s", option->long_name, option->long_name, option->argument);
}

/* --name, --name=value or --name value */
static CliStatus parse_long(Cursor *cursor, CliOptions *options) {
    const char *name = cursor->argv[cursor->index] + 2;
    size_t size = strcspn(name, "=");
    const char *value = name[size] == '=' ? name + size + 1 : NULL;
    for (int i = 0; i < CLI_OPTION_COUNT; i++) {
        const CliOption *option = &cli_option_table[i];
        if (strlen(option->long_name) != size || strncmp(option->long_name, name, size) != 0)
            continue;
        if (option->form == CLI_FORM_NONE && value != NULL) {
            return cli_message_usage("--%s takes no value", option->long_name);
        }
        if (option->form == CLI_FORM_REQUIRED && value == NULL) {
            if (cursor->index + 1 == cursor->argc) return missing_value(option);
            value = cursor->argv[++cursor->index];
        }
        return apply(options, option->id, value);
    }
    return refuse_long(name, size);
}

/* -q, -t4, -t 4, and several letters together: -qt4 */
static CliStatus parse_short(Cursor *cursor, CliOptions *options) {
    const char *letters = cursor->argv[cursor->index] + 1;
    while (*letters != '\0') {
        const CliOption *option = NULL;
        for (int i = 0; i < CLI_OPTION_COUNT; i++) {
            if (cli_option_table[i].short_name == *letters) option = &cli_option_table[i];
        }
        if (option == NULL) {
            int length = 1; /* a letter outside of ASCII is several bytes */
            while (((unsigned char)letters[length] & 0xc0) == 0x80) length++;
            return cli_message_usage("unknown option '-%.*s'", length, letters);
        }
        letters++;
        const char *value = NULL;
        if (option->form == CLI_FORM_REQUIRED) {
            value = letters;
            if (*value == '\0') {
                if (cursor->index + 1 == cursor->argc) return missing_value(option);
                value = cursor->argv[++cursor->index];
            }
            letters = "";
        }
        CliStatus status = apply(options, option->id, value);
        if (status != CLI_OK) return status;
    }
    return CLI_OK;
}

/* What no single option can see. */
static CliStatus check(const CliOptions *options) {
    if (options->action != CLI_ACTION_RENDER) return CLI_OK;
    if (options->scene_count == 0) return cli_message_usage("no scene given");
    int standard_inputs = 0;
    for (int i = 0; i < options->scene_count; i++) {
        if (options->scenes[i][0] == '\0') return cli_message_usage("a scene has an empty name");
        standard_inputs += strcmp(options->scenes[i], "-") == 0;
    }
    if (standard_inputs > 1) return cli_message_usage("standard input can be read only once");
    return CLI_OK;
}

CliStatus cli_options_parse(int argc, char **argv, CliOptions *options) {
    *options = (CliOptions){.dialect = GLINT_DIALECT_AUTO, .scenes = argv};
    Cursor cursor = {.argc = argc, .index = 1, .argv = argv};
    if (argc > 1 && strcmp(argv[1], "render") == 0) cursor.index = 2;
    bool options_ended = false;
    for (; cursor.index < argc; cursor.index++) {
        char *argument = argv[cursor.index];
        CliStatus status = CLI_OK;
        if (options_ended || argument[0] != '-' || argument[1] == '\0') {
            options->scenes[options->scene_count++] = argument;
        } else if (argument[1] != '-') {
            status = parse_short(&cursor, options);
        } else if (argument[2] != '\0') {
            status = parse_long(&cursor, options);
        } else {
            options_ended = true;
        }
        if (status != CLI_OK) return status;
    }
    return check(options);
}
