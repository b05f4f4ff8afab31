/* SPDX-License-Identifier: MIT
 * A finding as a compiler would print it. */
#include "glint/glint.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Writes as much as fits and counts all of it. */
typedef struct Output {
    char *buffer;
    size_t size, length;
} Output;

static void put(Output *output, const char *text, size_t size) {
    if (output->length < output->size) {
        size_t room = output->size - output->length;
        memcpy(output->buffer + output->length, text, size < room ? size : room);
    }
    output->length += size;
}

static void put_text(Output *output, const char *text) { put(output, text, strlen(text)); }

static void put_number(Output *output, int64_t number) {
    char text[32];
    snprintf(text, sizeof text, ":%lld", (long long)number);
    put_text(output, text);
}

static const char *const severity_texts[] = {[GLINT_SEVERITY_ERROR] = ": error: ",
    [GLINT_SEVERITY_WARNING] = ": warning: ",
    [GLINT_SEVERITY_NOTE] = ": note: "};

size_t glint_diagnostic_format(const GlintDiagnostic *diagnostic, char *buffer, size_t size) {
    Output output = {.buffer = buffer, .size = size > 0 ? size - 1 : 0};
    put_text(&output, diagnostic->path != NULL ? diagnostic->path : "");
    if (diagnostic->line > 0) {
        put_number(&output, diagnostic->line);
        put_number(&output, diagnostic->column);
    }
    put_text(&output, severity_texts[diagnostic->severity]);
    put_text(&output, diagnostic->message);
    if (diagnostic->severity != GLINT_SEVERITY_ERROR && diagnostic->rule != NULL) {
        put_text(&output, " [");
        put_text(&output, diagnostic->rule);
        put_text(&output, "]");
    }
    put_text(&output, "\n");
    if (diagnostic->excerpt != NULL) {
        put_text(&output, diagnostic->excerpt);
        put_text(&output, "\n");
        /* Tabs are repeated, so that the caret stands right whatever their width. */
        int before = 0;
        for (const char *p = diagnostic->excerpt; *p != '\0' && before < diagnostic->caret; p++) {
            if (((unsigned char)*p & 0xc0) == 0x80) continue;
            put_text(&output, *p == '\t' ? "\t" : " ");
            before++;
        }
        put_text(&output, "^");
        for (int i = 1; i < diagnostic->caret_length; i++) put_text(&output, "~");
        put_text(&output, "\n");
    }
    if (diagnostic->hint != NULL) {
        put_text(&output, "  hint: ");
        put_text(&output, diagnostic->hint);
        put_text(&output, "\n");
    }
    if (size > 0) buffer[output.length < size ? output.length : size - 1] = '\0';
    return output.length;
}
