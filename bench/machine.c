/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE
#define _POSIX_C_SOURCE 200809L
#include "machine.h"

#include "glint/glint.h"
#include "message.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

/* The model as the kernel names it; where it names none (ARM) the architecture. */
static void model_name(char *text, size_t size) {
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[256];
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        const char *value = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || value == NULL) continue;
        line[strcspn(line, "\n")] = '\0';
        message_format(text, size, "%s", value + 1 + (value[1] == ' '));
        fclose(file);
        return;
    }
    if (file != NULL) fclose(file);
    struct utsname system;
    message_format(text, size, "%s", uname(&system) == 0 ? system.machine : "unknown");
}

void machine_describe(char *text, size_t size) {
    char model[256];
    model_name(model, sizeof model);
    message_format(
        text, size, "%s, %s, %ld cores", model, glint_isa_name(0), sysconf(_SC_NPROCESSORS_ONLN));
}

void machine_file_name(char *text, size_t size) {
    char model[256];
    model_name(model, sizeof model);
    size_t used = 0;
    for (const char *from = model; *from != '\0' && *from != '@'; from++) {
        /* (R), (TM) and the like say nothing. */
        if (*from == '(') {
            from += strcspn(from, ")");
            if (*from == '\0') break;
        } else if (isalnum((unsigned char)*from)) {
            model[used++] = (char)tolower((unsigned char)*from);
        } else if (used > 0 && model[used - 1] != '-') {
            model[used++] = '-';
        }
    }
    while (used > 0 && model[used - 1] == '-') used--;
    message_format(text, size, "%.*s-%s", (int)used, model, glint_isa_name(0));
}
