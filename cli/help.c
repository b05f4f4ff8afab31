/* SPDX-License-Identifier: MIT
 * Layouts of the tables. The screen has 80 columns and at most 40 lines. */
#include "help.h"

#include "glint/glint.h"

#include <stdio.h>
#include <string.h>

static const char about[] =
    "draws scenes of spheres, boxes, cones and other solids, exactly and fast";

static const char exit_status[] =
    "Exit status: 0 done, 1 wrong scene or picture, 2 wrong use, 3 memory or disk";

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

static bool has_option(const CliVerb *verb, const char *long_name) {
    const CliOption *option;
    for (int i = 0; (option = cli_verb_option_at(verb, i)) != NULL; i++) {
        if (strcmp(option->long_name, long_name) == 0) return true;
    }
    return false;
}

static void print_dialects(const char *between) {
    for (int i = 0; i < GLINT_DIALECT_COUNT; i++) {
        printf("%s%s", i > 0 ? between : "", glint_dialect_name((GlintDialect)i));
    }
}

/* ---------------------------------------------------------------- the screen */

static void print_overview(void) {
    puts("usage: glint VERB [OPTIONS] ...\n"
         "       glint [OPTIONS] SCENE...      the same as glint render\n");
    const CliVerb *verb;
    for (int i = 0; (verb = cli_verb_at(i)) != NULL; i++) {
        printf("  %-10s %s\n", verb->name, verb->summary);
    }
    printf("\nglint VERB --help tells what a verb takes.\n%s\n", exit_status);
    verb = cli_verb_at(0);
    printf("\nExample: %s\n  %s\n", verb->example_text, verb->example);
}

/* The options, and a heading wherever another group begins. */
static void print_options(const CliVerb *verb) {
    const char *group = "";
    const CliOption *option;
    for (int i = 0; (option = cli_verb_option_at(verb, i)) != NULL; i++) {
        if (strcmp(group, option->group) != 0) printf("\n%s:\n", option->group);
        group = option->group;
        char text[64];
        option_text(option, text, sizeof text);
        bool fits = strlen(text) <= 25;
        printf("  %-25s%s%s\n", text, fits ? " " : "\n                            ", option->help);
    }
}

static void print_screen(const CliVerb *verb) {
    const char *blank = verb->operands[0] != '\0' ? " " : "";
    printf("usage: glint %s [OPTIONS]%s%s\n\n%s\n", verb->name, blank, verb->operands, verb->about);
    print_options(verb);
    putchar('\n');
    if (has_option(verb, "dialect")) {
        printf("Dialects: ");
        print_dialects(" ");
        putchar('\n');
    }
    puts(exit_status);
    if (verb->notes != NULL) printf("\n%s\n", verb->notes);
    printf("\nExample: %s\n  %s\n", verb->example_text, verb->example);
}

/* ---------------------------------------------------------------- the manual */

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

static void print_man_name(const CliVerb *verb) {
    if (verb == NULL) {
        printf(".TH GLINT 1 \"\" \"glint %s\" \"User Commands\"\n", glint_version_text());
        printf(".SH NAME\nglint \\- %s\n", about);
        puts(".SH SYNOPSIS\n.B glint\n\\fIVERB\\fR [\\fIOPTIONS\\fR] ...\n.br\n"
             ".B glint\n[\\fIOPTIONS\\fR] \\fISCENE\\fR...");
        return;
    }
    printf(".TH GLINT\\-");
    for (const char *letter = verb->name; *letter != '\0'; letter++) putchar(*letter - 'a' + 'A');
    printf(" 1 \"\" \"glint %s\" \"User Commands\"\n", glint_version_text());
    printf(".SH NAME\nglint\\-%s \\- %s\n", verb->name, verb->summary);
    printf(".SH SYNOPSIS\n.B glint %s\n[\\fIOPTIONS\\fR] ", verb->name);
    print_troff(verb->operands);
    putchar('\n');
}

static void print_man_paragraphs(const char *text) {
    bool line_begins = true;
    for (; *text != '\0'; text++) {
        if (line_begins && *text == '\n') {
            puts(".PP");
            continue;
        }
        if (line_begins && (*text == '.' || *text == '\'')) printf("\\&");
        char letter[2] = {*text, '\0'};
        print_troff(letter);
        line_begins = *text == '\n';
    }
    putchar('\n');
}

static void print_man_options(const CliVerb *verb) {
    const char *group = "";
    const CliOption *option;
    printf(".SH OPTIONS\n");
    for (int i = 0; (option = cli_verb_option_at(verb, i)) != NULL; i++) {
        if (strcmp(group, option->group) != 0) printf(".SS %s\n", option->group);
        group = option->group;
        print_troff_option(option);
    }
}

static void print_man_example(const CliVerb *verb) {
    printf(".TP\n");
    print_troff(verb->example);
    printf("\n%s\n", verb->example_text);
}

static void print_man(const CliVerb *named) {
    print_man_name(named);
    printf(".SH DESCRIPTION\n");
    const CliVerb *verb = named != NULL ? named : cli_verb_at(0);
    if (named == NULL) {
        puts("Without a verb the program does what \\fBglint render\\fR does. The verbs are:");
        for (int i = 0; cli_verb_at(i) != NULL; i++) {
            printf(".TP\n\\fBglint %s\\fR\n", cli_verb_at(i)->name);
            printf(
                "%s; see \\fBglint\\-%s\\fR(1)\n", cli_verb_at(i)->summary, cli_verb_at(i)->name);
        }
        printf(".PP\n");
    }
    print_man_paragraphs(verb->about);
    print_man_options(verb);
    if (verb->notes != NULL) {
        printf(".SH NOTES\n");
        print_man_paragraphs(verb->notes);
    }
    printf(".SH DIALECTS\n");
    print_dialects(", ");
    puts(
        ".\nThe first finds the dialect from the content of the scene.\n"
        ".SH EXIT STATUS\n"
        ".TP\n0\ndone\n"
        ".TP\n1\na scene or picture is wrong or cannot be read\n"
        ".TP\n2\nthe command line is wrong\n"
        ".TP\n3\nmemory, disk or threads ran out\n"
        ".PP\n"
        "The largest that applies is given. After an interrupt the program dies of the signal and\n"
        "leaves no unfinished picture.\n"
        ".SH ENVIRONMENT\n"
        ".TP\n.B NO_COLOR\nset and not empty: no colours in messages\n"
        ".SH EXAMPLES");
    print_man_example(verb);
    for (int i = 0; named == NULL && cli_verb_at(i + 1) != NULL; i++) {
        print_man_example(cli_verb_at(i + 1));
    }
}

/* ---------------------------------------------------------------- the documentation */

static void print_markdown(const CliVerb *verb) {
    puts("| option | what it does |\n"
         "| --- | --- |");
    const CliOption *option;
    for (int i = 0; (option = cli_verb_option_at(verb, i)) != NULL; i++) {
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

void cli_help_print(const CliArguments *arguments) {
    const CliVerb *named = arguments->named ? arguments->verb : NULL;
    switch (arguments->answer) {
    case CLI_ANSWER_RUN: break;
    case CLI_ANSWER_HELP:
        if (named != NULL) {
            print_screen(named);
        } else {
            print_overview();
        }
        break;
    case CLI_ANSWER_MAN: print_man(named); break;
    case CLI_ANSWER_MARKDOWN: print_markdown(arguments->verb); break;
    case CLI_ANSWER_VERSION: printf("glint %s\n", glint_version_text()); break;
    }
}
