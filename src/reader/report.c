/* SPDX-License-Identifier: MIT */
#include "reader/report.h"

#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void gi_report_init(GiReport *report, GiMemory *memory, GiWindow *window) {
    memset(report, 0, sizeof *report);
    report->memory = memory;
    report->window = window;
    report->rule = GI_RULE_SCENE;
}

void gi_report_reset(GiReport *report) { gi_array_free(report->memory, &report->findings); }

void gi_report_add(GiReport *report, GiPlace place, int length, const char *format, ...) {
    if (report->error_count++ >= GI_REPORT_LIMIT) return;
    if (!gi_array_reserve(report->memory, &report->findings, 1)) {
        report->out_of_memory = true;
        return;
    }
    GiFinding *finding = &report->findings.data[report->findings.count++];
    gi_window_locate(report->window, &place);
    *finding = (GiFinding){.place = place, .length = length > 0 ? length : 1, .rule = report->rule};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(finding->message, sizeof finding->message, format, arguments);
    va_end(arguments);
}

void gi_report_keep_root(GiReport *report, GiPlace place) {
    gi_window_locate(report->window, &place);
    report->root = place;
}

void gi_report_capture(GiReport *report, int64_t end) {
    if (report->root.line != 0 && !report->root_shown && report->root.offset < end) {
        report->root_shown = true;
        gi_window_excerpt(
            report->window, report->root.offset, report->root_excerpt, &report->root_caret);
    }
    for (size_t i = 0; i < report->findings.count; i++) {
        GiFinding *finding = &report->findings.data[i];
        if (finding->shown || finding->place.offset >= end) continue;
        finding->shown = true;
        if (report->root_shown && finding->place.offset == report->root.offset) {
            memcpy(finding->excerpt, report->root_excerpt, sizeof finding->excerpt);
            finding->caret = report->root_caret;
        } else if (gi_window_holds(report->window, finding->place.offset)) {
            gi_window_excerpt(
                report->window, finding->place.offset, finding->excerpt, &finding->caret);
        } else {
            finding->caret = -1;
        }
    }
}

static int compare_findings(const void *a, const void *b) {
    const GiFinding *left = a, *right = b;
    int64_t l = left->place.offset, r = right->place.offset;
    return l != r ? (l < r ? -1 : 1) : strcmp(left->message, right->message);
}

void gi_report_emit(GiReport *report, const char *path, GlintDiagnosticFn diagnostic, void *user,
    GlintError *error) {
    size_t count = report->findings.count;
    if (count == 0) return;
    qsort(report->findings.data, count, sizeof(GiFinding), compare_findings);
    const GiFinding *first = &report->findings.data[0];
    gi_error_set_path(error, GLINT_ERROR_SCENE, path, "%s", first->message);
    if (error != NULL) {
        error->line = (int)(first->place.line < INT_MAX ? first->place.line : INT_MAX);
        error->column = (int)(first->place.column < INT_MAX ? first->place.column : INT_MAX);
    }
    if (diagnostic == NULL) return;
    for (size_t i = 0; i < count; i++) {
        const GiFinding *finding = &report->findings.data[i];
        bool has_excerpt = finding->shown && finding->caret >= 0;
        int room = has_excerpt
                       ? gi_text_length(finding->excerpt, strlen(finding->excerpt)) - finding->caret
                       : 1;
        int length = finding->length < room ? finding->length : room;
        diagnostic(user, &(GlintDiagnostic){
                             .severity = GLINT_SEVERITY_ERROR,
                             .path = path,
                             .line = finding->place.line,
                             .column = finding->place.column,
                             .message = finding->message,
                             .excerpt = has_excerpt ? finding->excerpt : NULL,
                             .caret = has_excerpt ? finding->caret : 0,
                             .caret_length = length > 0 ? length : 1,
                             .rule = finding->rule,
                         });
    }
    int64_t more = report->error_count - (int64_t)count;
    if (more > 0) {
        char message[64];
        snprintf(message, sizeof message, "%lld more error%s in this file", (long long)more,
            more == 1 ? "" : "s");
        diagnostic(user, &(GlintDiagnostic){
                             .severity = GLINT_SEVERITY_ERROR,
                             .path = path,
                             .message = message,
                             .caret_length = 1,
                             .rule = GI_RULE_SCENE,
                         });
    }
}

/* ---------------------------------------------------------------- text */

const char *gi_quote(char *buffer, const char *text, size_t size) {
    enum { CHARACTERS = 40 };
    size_t length = 0, i = 0;
    for (int count = 0; i < size && text[i] != '\0' && length + 8 < GI_QUOTE_SIZE; count++) {
        if (count == CHARACTERS) {
            memcpy(buffer + length, "...", 3);
            length += 3;
            break;
        }
        unsigned char c = (unsigned char)text[i],
                      next = i + 1 < size ? (unsigned char)text[i + 1] : 0;
        bool control = c < 0x20 || c == 0x7f || (c == 0xc2 && next < 0xa0);
        if (control) {
            buffer[length++] = '?';
            i += c == 0xc2 ? 2 : 1;
            continue;
        }
        do {
            buffer[length++] = text[i++];
        } while (i < size && ((unsigned char)text[i] & 0xc0) == 0x80 && length + 8 < GI_QUOTE_SIZE);
    }
    buffer[length] = '\0';
    return buffer;
}

int gi_text_length(const char *text, size_t size) {
    int count = 0;
    for (size_t i = 0; i < size && count < INT_MAX; i++)
        count += ((unsigned char)text[i] & 0xc0) != 0x80;
    return count;
}
