/* SPDX-License-Identifier: MIT
 * The findings of one file: collected while it is read, handed out at the end in the order of the
 * file. The first hundred are kept; the rest are counted. */
#pragma once

#include "base/array.h"
#include "base/error.h"
#include "reader/window.h"

/* The rules of errors, as in check/rule.h. */
#define GI_RULE_SYNTAX "syntax"
#define GI_RULE_SCENE  "scene"
#define GI_RULE_FILE   "file"

enum { GI_REPORT_LIMIT = 100, GI_QUOTE_SIZE = 200 };

typedef struct GiFinding {
    GiPlace place;
    int length; /* of the token, in characters */
    bool shown; /* the excerpt is taken */
    int caret;
    const char *rule;
    char message[400];
    char excerpt[GI_EXCERPT_SIZE];
} GiFinding;

typedef struct GiReport {
    GiMemory *memory;
    GiWindow *window;
    GI_ARRAY(GiFinding) findings;
    int64_t error_count;
    bool out_of_memory;
    const char *rule; /* what the next findings are of, a name that lives for ever */
    GiPlace root;     /* the scene element: its line is kept for what is missing at the end */
    char root_excerpt[GI_EXCERPT_SIZE];
    bool root_shown; /* the line is taken */
    int root_caret;
} GiReport;

void gi_report_init(GiReport *report, GiMemory *memory, GiWindow *window);
void gi_report_reset(GiReport *report);

/* True once further errors are only counted: then do not bother with costly messages. */
static inline bool gi_report_is_full(const GiReport *report) {
    return report->error_count >= GI_REPORT_LIMIT;
}

GI_PRINTF(4, 5)
void gi_report_add(GiReport *report, GiPlace place, int length, const char *format, ...);

/* Where the root element is; its line is kept when its bytes go. */
void gi_report_keep_root(GiReport *report, GiPlace place);

/* Takes the excerpts that need bytes before `end`; called before bytes are let go. */
void gi_report_capture(GiReport *report, int64_t end);

/* Hands everything to the callback (when there is one) and the first error to *error. */
void gi_report_emit(GiReport *report, const char *path, GlintDiagnosticFn diagnostic, void *user,
    GlintError *error);

/* Text of the user's for a message: at most 40 characters, without control characters. Returns
 * buffer, which has GI_QUOTE_SIZE bytes. */
const char *gi_quote(char *buffer, const char *text, size_t size);

/* Characters of UTF-8 text. */
int gi_text_length(const char *text, size_t size);
