/* SPDX-License-Identifier: MIT
 * Values of the old text, and new ones. */
#include "format/upgrade.h"

#include "reader/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

size_t gi_upgrade_child(const GiUpgrade *upgrade, size_t token, GiSlot slot) {
    const GiDocument *document = upgrade->document;
    size_t found = GI_NO_TOKEN;
    for (size_t i = gi_document_first_child(document, token); i != GI_NO_TOKEN;
         i = gi_document_next_child(document, i)) {
        const GiElement *element = document->tokens.data[i].element;
        if (element != NULL && element->slot == slot) found = i;
    }
    return found;
}

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n'; }

bool gi_upgrade_numbers(const GiUpgrade *upgrade, size_t token, int count, double *values) {
    const GiDocument *document = upgrade->document;
    size_t target = upgrade->targets.data[token];
    const GiToken *start = &document->tokens.data[target];
    /* The usual case only: text without comments and references. */
    if (start->match != target + 2 || start[1].kind != GI_TOKEN_TEXT) return false;
    GiSpan text = gi_document_span(document, target + 1);
    size_t at = 0;
    for (int i = 0; i < count; i++) {
        size_t used;
        while (at < text.size && is_blank(text.data[at])) at++;
        if (gi_number_read(text.data + at, text.size - at, &values[i], &used) != GI_NUMBER_OK)
            return false;
        at += used;
    }
    return true;
}

GiSpan gi_upgrade_content(const GiUpgrade *upgrade, size_t token) {
    const GiDocument *document = upgrade->document;
    const GiToken *start = &document->tokens.data[upgrade->targets.data[token]];
    size_t end = document->tokens.data[start->match].begin;
    if (start->kind == GI_TOKEN_EMPTY) return (GiSpan){"", 0};
    return (GiSpan){document->text.data + start->end, end - start->end};
}

/* The shortest text that reads back as the number. The point does not depend on the language of
 * the machine. */
static int format_number(double value, char *text, size_t size) {
    int length = 0;
    for (int digits = 6; digits <= 17; digits++) {
        double again;
        size_t used;
        length = snprintf(text, size, "%.*g", digits, value);
        for (int i = 0; i < length; i++) {
            if (strchr("0123456789+-e", text[i]) == NULL) text[i] = '.';
        }
        if (gi_number_read(text, (size_t)length, &again, &used) == GI_NUMBER_OK && again == value)
            break;
    }
    return length;
}

void gi_upgrade_format(const double values[3], char text[GI_UPGRADE_TEXT_SIZE]) {
    size_t length = 0;
    for (int i = 0; i < 3; i++) {
        if (i > 0) text[length++] = ' ';
        length += (size_t)format_number(values[i], text + length, 40);
    }
}

bool gi_upgrade_scale(GiUpgrade *upgrade, size_t token, GiSlot slot, const char *child_name,
    const double fallback[3], double factor) {
    double values[3] = {fallback[0], fallback[1], fallback[2]};
    size_t child = gi_upgrade_child(upgrade, token, slot);
    if (child != GI_NO_TOKEN && !gi_upgrade_numbers(upgrade, child, 3, values)) return false;
    for (int i = 0; i < 3; i++) {
        values[i] *= factor;
        if (!isfinite(values[i])) return false;
    }
    char number[GI_UPGRADE_TEXT_SIZE], text[GI_UPGRADE_TEXT_SIZE + 80];
    gi_upgrade_format(values, number);
    snprintf(text, sizeof text, "<%s>%s</%s>", child_name, number, child_name);
    const GiDocument *document = upgrade->document;
    bool named =
        child != GI_NO_TOKEN && gi_document_attribute_value(document, child, "name").data != NULL;
    if (child == GI_NO_TOKEN || named) {
        /* Others may mean the value by its name, which stays; the last of several counts. */
        const char *const children[] = {text};
        gi_edit_append(&upgrade->edits, token, gi_upgrade_name(upgrade, token), children, 1);
    } else {
        const GiToken *old = &document->tokens.data[child];
        gi_edit_replace(
            &upgrade->edits, old->begin, document->tokens.data[old->match].end, gi_span(text));
    }
    return true;
}
