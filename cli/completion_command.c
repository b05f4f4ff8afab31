/* SPDX-License-Identifier: MIT
 * What a shell needs to complete `glint ...`, made from the tables of the verbs. */
#include "glint/glint.h"

#include "message.h"
#include "value.h"
#include "verb.h"

#include <stdio.h>
#include <string.h>

/* ---------------------------------------------------------------- what can be completed */

/* What may follow an option. */
typedef enum Follows {
    FOLLOWS_NOTHING, /* a value that nobody can guess, or none */
    FOLLOWS_FILE,
    FOLLOWS_WORD /* one of those that each_word gives */
} Follows;

/* All that a build may have: the script may be made on another machine than it is used on. */
static const char *isa_at(int index) {
    static const char *const names[] = {"avx512", "avx2", "sse2", "portable", NULL};
    return names[index];
}

static const char *dialect_at(int index) {
    return index < GLINT_DIALECT_COUNT ? glint_dialect_name((GlintDialect)index) : NULL;
}

/* Options that mean the same in every verb, and whose values are more than a help line can hold. */
static const struct {
    const char *long_name;
    const char *(*name_at)(int index);
} named[] = {{"dialect", dialect_at}, {"isa", isa_at}};

static const char *(*names_of(const CliOption *option))(int index) {
    for (int i = 0; i < CLI_COUNT(named); i++) {
        if (strcmp(option->long_name, named[i].long_name) == 0) return named[i].name_at;
    }
    return NULL;
}

/* A file name is in capitals: FILE, FILE.png, FOLDER. */
static Follows follows(const CliOption *option) {
    if (option->form == CLI_FORM_NONE) return FOLLOWS_NOTHING;
    if (names_of(option) != NULL || strchr(option->argument, '|') != NULL) return FOLLOWS_WORD;
    bool file = strncmp(option->argument, "FILE", 4) == 0 ||
                strncmp(option->argument, "SCENE", 5) == 0 ||
                strncmp(option->argument, "FOLDER", 6) == 0;
    return file ? FOLLOWS_FILE : FOLLOWS_NOTHING;
}

/* "a|b|c" as "a b c" */
static void print_alternatives(const char *text) {
    for (; *text != '\0'; text++) putchar(*text == '|' ? ' ' : *text);
}

static bool takes_words(const CliVerb *verb) { return strchr(verb->operands, '|') != NULL; }

/* The words that may follow an option. */
static void print_words(const CliOption *option) {
    const char *(*name_at)(int index) = names_of(option);
    for (int i = 0; name_at != NULL && name_at(i) != NULL; i++) {
        printf("%s%s", i > 0 ? " " : "", name_at(i));
    }
    if (name_at == NULL) print_alternatives(option->argument);
}

/* Text within single quotes of a shell. */
static void print_quoted(const char *text) {
    putchar('\'');
    for (; *text != '\0'; text++) {
        if (*text == '\'') {
            fputs("'\\''", stdout);
        } else {
            putchar(*text);
        }
    }
    putchar('\'');
}

static void print_verbs(const char *between) {
    for (int i = 0; cli_verb_at(i) != NULL; i++) {
        printf("%s%s", i > 0 ? between : "", cli_verb_at(i)->name);
    }
}

/* ---------------------------------------------------------------- bash */

static void print_bash_verb(const CliVerb *verb) {
    const CliOption *option;
    printf("    %s)\n        case $previous in\n", verb->name);
    for (int i = 0; (option = cli_verb_option_at(verb, i)) != NULL; i++) {
        if (option->form != CLI_FORM_REQUIRED) continue;
        printf("        --%s", option->long_name);
        if (option->short_name != 0) printf(" | -%c", option->short_name);
        switch (follows(option)) {
        case FOLLOWS_FILE: puts(") ;;"); break;
        case FOLLOWS_WORD:
            printf(") words='");
            print_words(option);
            puts("' ;;");
            break;
        case FOLLOWS_NOTHING: puts(") return ;;"); break;
        }
    }
    printf("        *)\n");
    if (takes_words(verb)) {
        printf("            words='");
        print_alternatives(verb->operands);
        puts("'");
    }
    printf("            options='");
    for (int i = 0; (option = cli_verb_option_at(verb, i)) != NULL; i++) {
        printf("%s--%s", i > 0 ? " " : "", option->long_name);
    }
    puts("'\n            ;;\n        esac\n        ;;");
}

static void print_bash(void) {
    puts("# Completion of glint for bash; made by `glint completion bash`.\n"
         "_glint() {\n"
         "    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
         "    local verb=${COMP_WORDS[1]} words= options=\n"
         "    COMPREPLY=()");
    printf("    case \" ");
    print_verbs(" ");
    puts(" \" in\n"
         "    *\" $verb \"*) [ \"$COMP_CWORD\" -gt 1 ] || verb=render ;;\n"
         "    *) verb=render ;;\n"
         "    esac\n"
         "    case $verb in");
    for (int i = 0; cli_verb_at(i) != NULL; i++) print_bash_verb(cli_verb_at(i));
    printf("    esac\n    if [ \"$COMP_CWORD\" -eq 1 ]; then words='");
    print_verbs(" ");
    puts("'; fi\n"
         "    case $current in\n"
         "    -*) mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$current\") ;;\n"
         "    *)\n"
         "        [ -z \"$words\" ] ||\n"
         "            mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
         "        [ -n \"$words\" ] && [ \"$COMP_CWORD\" -ne 1 ] && return\n"
         "        compopt -o filenames 2>/dev/null\n"
         "        local name\n"
         "        while IFS= read -r name; do\n"
         "            COMPREPLY+=(\"$name\")\n"
         "        done < <(compgen -f -- \"$current\")\n"
         "        ;;\n"
         "    esac\n"
         "}\n"
         "complete -F _glint glint");
}

/* ---------------------------------------------------------------- zsh */

/* In _arguments a colon ends a part and brackets enclose the help. */
static void print_zsh_text(const char *text) {
    for (; *text != '\0'; text++) {
        if (strchr(":[]\\", *text) != NULL) putchar('\\');
        if (*text == '\'') {
            fputs("'\\''", stdout);
        } else {
            putchar(*text);
        }
    }
}

static void print_zsh_option(const CliOption *option) {
    bool required = option->form == CLI_FORM_REQUIRED;
    printf("            ");
    if (option->short_name != 0) {
        printf("{-%c%s,--%s%s}'", option->short_name, required ? "+" : "", option->long_name,
            required ? "=" : "");
    } else {
        printf("'--%s%s", option->long_name, required ? "=" : "");
    }
    putchar('[');
    print_zsh_text(option->help);
    putchar(']');
    if (required) {
        putchar(':');
        print_zsh_text(option->argument);
        putchar(':');
        if (follows(option) == FOLLOWS_FILE) fputs("_files", stdout);
        if (follows(option) == FOLLOWS_WORD) {
            putchar('(');
            print_words(option);
            putchar(')');
        }
    }
    puts("' \\");
}

static void print_zsh(void) {
    puts("#compdef glint\n"
         "# Completion of glint for zsh; made by `glint completion zsh`.\n"
         "_glint() {\n"
         "    local verb=render\n"
         "    local -a verbs\n"
         "    verbs=(");
    for (int i = 0; cli_verb_at(i) != NULL; i++) {
        printf("        '%s:", cli_verb_at(i)->name);
        print_zsh_text(cli_verb_at(i)->summary);
        puts("'");
    }
    puts("    )\n"
         "    if (( CURRENT == 2 )) && [[ $words[2] != -* ]]; then\n"
         "        _describe verb verbs\n"
         "    elif (( ${verbs[(I)$words[2]:*]} )); then\n"
         "        verb=$words[2]\n"
         "        shift words\n"
         "        (( CURRENT-- ))\n"
         "    fi\n"
         "    case $verb in");
    for (int i = 0; cli_verb_at(i) != NULL; i++) {
        const CliVerb *verb = cli_verb_at(i);
        printf("    %s)\n        _arguments -s \\\n", verb->name);
        const CliOption *option;
        for (int k = 0; (option = cli_verb_option_at(verb, k)) != NULL; k++) {
            print_zsh_option(option);
        }
        if (takes_words(verb)) {
            printf("            ':word:(");
            print_alternatives(verb->operands);
            puts(")'\n        ;;");
        } else {
            puts("            '*:file:_files'\n        ;;");
        }
    }
    puts("    esac\n"
         "}\n"
         "_glint \"$@\"");
}

/* ---------------------------------------------------------------- fish */

static void print_fish_option(const CliVerb *verb, bool plain, const CliOption *option) {
    printf("complete -c glint -n '__glint_verb %s%s' -l %s", verb->name, plain ? " plain" : "",
        option->long_name);
    if (option->short_name != 0) printf(" -s %c", option->short_name);
    if (option->form == CLI_FORM_REQUIRED) {
        printf(follows(option) == FOLLOWS_FILE ? " -r -F" : " -x");
        if (follows(option) == FOLLOWS_WORD) {
            printf(" -a '");
            print_words(option);
            putchar('\'');
        }
    }
    printf(" -d ");
    print_quoted(option->help);
    putchar('\n');
}

static void print_fish(void) {
    printf("# Completion of glint for fish; made by `glint completion fish`.\n"
           "function __glint_verb\n"
           "    set -l words (commandline -opc)\n"
           "    if test (count $words) -gt 1; and contains -- $words[2] ");
    print_verbs(" ");
    puts("\n"
         "        test $words[2] = $argv[1]\n"
         "    else\n"
         "        test \"$argv[2]\" = plain\n"
         "    end\n"
         "end\n"
         "function __glint_first\n"
         "    test (count (commandline -opc)) -eq 1\n"
         "end");
    for (int i = 0; cli_verb_at(i) != NULL; i++) {
        printf("complete -c glint -n __glint_first -a %s -d ", cli_verb_at(i)->name);
        print_quoted(cli_verb_at(i)->summary);
        putchar('\n');
    }
    for (int i = 0; cli_verb_at(i) != NULL; i++) {
        const CliVerb *verb = cli_verb_at(i);
        if (takes_words(verb)) {
            printf("complete -c glint -n '__glint_verb %s' -f -a '", verb->name);
            print_alternatives(verb->operands);
            puts("'");
        }
        const CliOption *option;
        for (int k = 0; (option = cli_verb_option_at(verb, k)) != NULL; k++) {
            print_fish_option(verb, i == 0, option);
        }
    }
}

/* ---------------------------------------------------------------- the verb */

static const char *shell_at(int index) {
    static const char *const names[] = {"bash", "zsh", "fish", NULL};
    return names[index];
}

static CliStatus run(void *values, const CliOperands *operands) {
    (void)values;
    if (operands->count != 1) return cli_message_usage("name one shell: bash, zsh or fish");
    int shell = 0;
    CliStatus status = cli_value_name("completion", operands->items[0], shell_at, &shell);
    if (status != CLI_OK) return status;
    switch (shell) {
    case 0: print_bash(); break;
    case 1: print_zsh(); break;
    default: print_fish(); break;
    }
    return cli_message_flush_output();
}

const CliVerb cli_verb_completion = {.name = "completion",
    .operands = "bash|zsh|fish",
    .summary = "print what a shell needs to complete commands",
    .about = "Prints a script that makes the shell complete verbs, options and their values.\n"
             "An installed Glint has put it where the shells look already.",
    .example_text = "complete in this bash",
    .example = "source <(glint completion bash)",
    .run = run};
