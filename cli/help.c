/* SPDX-License-Identifier: MIT
 * Three layouts of one table. The screen has 80 columns and at most 40 lines. */
#include "help.h"

#include "option_table.h"

#include <stdio.h>

static const char about[] =
    "draws scenes of spheres, boxes, cones and other solids, exactly and fast";

/* "-o, --output FILE", or "    --size WxH". */
static void option_text(const CliOption *option, char *buffer, size_t size) {
    int length = option->short_name != 0 ? snprintf(buffer, size, "-%c, ", option->short_name)
                                         : snprintf(buffer, size, "    ");
    length += snprintf(buffer + length, size - (size_t)length, "--%s", option->long_name);
    size_t left = size - (size_t)length;
    if (option->form == CLI_FORM_REQUIRED) {
        length += snprintf(buffer + length, left, " %s", option->argument);
    } else if (option->form == CLI_FORM_OPTIONAL) {
        length += snprintf(buffer + length, left, "[=%s]", option->argument);
    }
}

static void print_dialects(const char *between) {
    for (int i = 0; i < GLINT_DIALECT_COUNT; i++) {
        printf("%s%s", i > 0 ? between : "", glint_dialect_name((GlintDialect)i));
    }
}

static void print_screen(void) {
    puts("usage: glint [OPTIONS] SCENE...\n"
         "\n"
         "Draws scenes. A SCENE is an XML file, a folder (all *.xml in it), or - for\n"
         "standard input. The picture of a.xml is a.xml.png beside it.");
    for (int group = 0; group < CLI_GROUP_COUNT; group++) {
        printf("\n%s:\n", cli_option_group_title((CliOptionGroup)group));
        for (int i = 0; i < CLI_OPTION_COUNT; i++) {
            const CliOption *option = &cli_option_table[i];
            if (option->group != (CliOptionGroup)group) continue;
            char text[64];
            option_text(option, text, sizeof text);
            printf("  %-25s %s\n", text, option->help);
        }
    }
    printf("\nDialects: ");
    print_dialects(" ");
    puts("\n"
         "Exit status: 0 all drawn, 1 a scene is wrong, 2 wrong use, 3 memory or disk\n"
         "\n"
         "Example: draw one scene larger than it asks for, on four threads\n"
         "  glint --size 1920x1080 -t 4 -o big.png scenes/solids.xml");
}

/* In troff a bare hyphen may become a typographic one, which cannot be pasted into a shell. */
static void print_troff(const char *text) {
    for (; *text != '\0'; text++) {
        if (*text == '-' || *text == '\\') putchar('\\');
        putchar(*text == '\\' ? 'e' : *text);
    }
}

static void print_troff_option(const CliOption *option) {
    printf(".TP\n");
    if (option->short_name != 0) printf("\\fB\\-%c\\fR, ", option->short_name);
    printf("\\fB\\-\\-");
    print_troff(option->long_name);
    printf("\\fR");
    if (option->form == CLI_FORM_REQUIRED) printf(" \\fI%s\\fR", option->argument);
    if (option->form == CLI_FORM_OPTIONAL) printf("[=\\fI%s\\fR]", option->argument);
    printf("\n");
    print_troff(option->help);
    printf("\n");
}

static void print_man(void) {
    printf(".TH GLINT 1 \"\" \"glint %s\" \"User Commands\"\n", glint_version_text());
    printf(".SH NAME\nglint \\- %s\n", about);
    puts(".SH SYNOPSIS\n"
         ".B glint\n"
         "[\\fIOPTIONS\\fR] \\fISCENE\\fR...\n"
         ".br\n"
         ".B glint render\n"
         "[\\fIOPTIONS\\fR] \\fISCENE\\fR...\n"
         ".SH DESCRIPTION\n"
         "Each \\fISCENE\\fR is an XML file, a folder (all *.xml in it, sorted by name, without\n"
         "subfolders) or \\fB\\-\\fR for standard input. The picture of \\fIa.xml\\fR is\n"
         "\\fIa.xml.png\\fR beside it, that of standard input is \\fIstdin.png\\fR. The name of "
         "each\n"
         "finished picture is printed. A picture appears whole or not at all. Mistakes in a scene\n"
         "are reported with line and column, and do not stop the other scenes.\n"
         ".SH OPTIONS");
    for (int group = 0; group < CLI_GROUP_COUNT; group++) {
        printf(".SS %s\n", cli_option_group_title((CliOptionGroup)group));
        for (int i = 0; i < CLI_OPTION_COUNT; i++) {
            if (cli_option_table[i].group == (CliOptionGroup)group) {
                print_troff_option(&cli_option_table[i]);
            }
        }
    }
    printf(".SH DIALECTS\n");
    print_dialects(", ");
    puts(
        ".\n"
        "The first finds the dialect from the content of the scene.\n"
        ".SH EXIT STATUS\n"
        ".TP\n0\nall pictures are drawn\n"
        ".TP\n1\na scene is wrong or cannot be read\n"
        ".TP\n2\nthe command line is wrong\n"
        ".TP\n3\nmemory, disk or threads ran out\n"
        ".PP\n"
        "The largest that applies is given. After an interrupt the program dies of the signal and\n"
        "leaves no unfinished picture.\n"
        ".SH ENVIRONMENT\n"
        ".TP\n.B NO_COLOR\nset and not empty: no colours in messages\n"
        ".SH EXAMPLES\n"
        ".TP\nglint scenes\ndraw every scene of a folder\n"
        ".TP\nglint \\-\\-size 1920x1080 \\-t 4 \\-o big.png scenes/solids.xml\n"
        "draw one scene larger than it asks for, on four threads\n"
        ".TP\nglint \\-\\-stats=json scenes | jq .seconds.trace\n"
        "how long each scene of a folder takes");
}

static void print_markdown(void) {
    puts("| option | what it does |\n"
         "| --- | --- |");
    for (int i = 0; i < CLI_OPTION_COUNT; i++) {
        const CliOption *option = &cli_option_table[i];
        char text[64];
        option_text(option, text, sizeof text);
        /* A bar would end the cell, even inside code. */
        printf("| `");
        for (const char *letter = text + (option->short_name != 0 ? 0 : 4); *letter != '\0';
             letter++) {
            if (*letter == '|') putchar('\\');
            putchar(*letter);
        }
        printf("` | %s |\n", option->help);
    }
}

void cli_help_print(CliHelpFormat format) {
    switch (format) {
    case CLI_HELP_SCREEN: print_screen(); break;
    case CLI_HELP_MAN: print_man(); break;
    case CLI_HELP_MARKDOWN: print_markdown(); break;
    }
}
