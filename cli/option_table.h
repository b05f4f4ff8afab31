/* SPDX-License-Identifier: MIT
 * Every option of the program, once: the parser, the help on the screen, the man page and the table
 * in the documentation are all made from this list.
 *
 *   X(id, short name or 0, long name, argument or null, form, group, help line) */
#pragma once

#define CLI_OPTION_LIST(X)                                                                         \
    X(OUTPUT, 'o', "output", "FILE", REQUIRED, PICTURE,                                            \
        "write to FILE (.png, .pfm or .exr), or into a folder")                                    \
    X(SIZE, 0, "size", "WxH", REQUIRED, PICTURE, "draw W x H pixels, whatever the scene says")     \
    X(CROP, 0, "crop", "X,Y,W,H", REQUIRED, PICTURE, "draw only W x H pixels from X,Y (top left)") \
    X(SAMPLES, 0, "samples", "N", REQUIRED, PICTURE,                                               \
        "draw N samples a pixel, whatever the scene says")                                         \
    X(LAYERS, 0, "layers", "A,B", REQUIRED, PICTURE,                                               \
        "add depth, normal, albedo, surface, lights, or all")                                      \
    X(DIALECT, 0, "dialect", "NAME", REQUIRED, PICTURE, "follow the rules of a year (see below)")  \
    X(THREADS, 't', "threads", "N", REQUIRED, MACHINE,                                             \
        "draw with N threads (default: one a core)")                                               \
    X(ISA, 0, "isa", "NAME", REQUIRED, MACHINE, "use this instruction set, not the fastest")       \
    X(LIST_ISA, 0, "list-isa", NULL, NONE, MACHINE, "list the instruction sets, fastest first")    \
    X(STATS, 0, "stats", "text|json", OPTIONAL, MESSAGES, "tell times, rays, tree and memory")     \
    X(QUIET, 'q', "quiet", NULL, NONE, MESSAGES, "no progress, and no names of pictures")          \
    X(HELP, 'h', "help", "man|markdown", HIDDEN, MESSAGES, "show this help")                       \
    X(VERSION, 'V', "version", NULL, NONE, MESSAGES, "show the version")

typedef enum CliOptionId {
#define CLI_OPTION_ENUM(id, short_name, long_name, argument, form, group, help) CLI_OPTION_##id,
    CLI_OPTION_LIST(CLI_OPTION_ENUM)
#undef CLI_OPTION_ENUM
        CLI_OPTION_COUNT
} CliOptionId;

typedef enum CliOptionForm {
    CLI_FORM_NONE,     /* --option */
    CLI_FORM_REQUIRED, /* --option VALUE, --option=VALUE, -oVALUE */
    CLI_FORM_OPTIONAL, /* --option, --option=VALUE */
    CLI_FORM_HIDDEN    /* the same, but the help does not mention the value */
} CliOptionForm;

typedef enum CliOptionGroup {
    CLI_GROUP_PICTURE,
    CLI_GROUP_MACHINE,
    CLI_GROUP_MESSAGES,
    CLI_GROUP_COUNT
} CliOptionGroup;

typedef struct CliOption {
    CliOptionId id;
    char short_name; /* 0: none */
    const char *long_name;
    const char *argument; /* null: takes none */
    CliOptionForm form;
    CliOptionGroup group;
    const char *help;
} CliOption;

/* CLI_OPTION_COUNT rows in the order of the list. */
extern const CliOption cli_option_table[];

/* The heading of a group, without a colon. */
const char *cli_option_group_title(CliOptionGroup group);
