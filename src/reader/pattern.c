/* SPDX-License-Identifier: MIT */
#include "reader/pattern.h"

enum { SIZE_LIMIT = 4096 };

static bool is_kind(const GiTapeEntry *entry, const GiTapeEntry *end, GiTokenKind kind) {
    return entry < end && entry->token.kind == kind;
}

/* A child: numbers between its tags, or a tag with one attribute. Returns its end, or null. */
static const GiTapeEntry *learn_child(
    GiPattern *pattern, uint32_t begin, const GiTapeEntry *entry, const GiTapeEntry *end) {
    if (!is_kind(entry, end, GI_TOKEN_START) || pattern->hole_count == GI_HOLE_LIMIT) return NULL;
    int attributes = (entry++)->token.count;
    if (attributes > 1 || end - entry <= 2 * attributes) return NULL;
    const GiTapeEntry *content = entry + attributes;
    if (attributes == 0 && content->token.kind != GI_TOKEN_NUMBERS) return NULL;
    GiToken hole = content->token;
    pattern->holes[pattern->hole_count++] = (GiHole){(uint16_t)(hole.at - begin),
        (uint16_t)(hole.at + hole.size - begin), attributes == 0 ? hole.count : 0};
    entry = content + 1 + (attributes == 0 ? hole.count : 0);
    return is_kind(entry, end, GI_TOKEN_END) ? entry + 1 : NULL;
}

bool gi_pattern_learn(GiPattern *pattern, const GiTapeEntry *entries, size_t first, size_t last) {
    if (last - first > GI_PATTERN_ENTRY_LIMIT) return false;
    const GiTapeEntry *entry = entries + first, *end = entries + last;
    GiToken tag = entry->token, close = end[-1].token;
    uint32_t size = close.at + close.size - tag.at;
    *pattern = (GiPattern){
        .first = (uint32_t)first, .size = (uint16_t)size, .entry_count = (uint8_t)(last - first)};
    if (size > SIZE_LIMIT) return false;
    entry += 1 + 2 * tag.count;
    while (entry != NULL && entry + 1 < end) entry = learn_child(pattern, tag.at, entry, end - 1);
    return entry != NULL && pattern->hole_count > 0;
}

int gi_pattern_expand(const GiPattern *pattern, const GiTapeEntry *entries, const GiTapeEntry *like,
    GiTapeEntry expanded[GI_PATTERN_ENTRY_LIMIT]) {
    const GiTapeEntry *model = entries + pattern->first;
    uint32_t begin = model->token.at, shift = like->token.at - begin; /* wraps round */
    const GiHole *hole = pattern->holes;
    GiTapeEntry *out = expanded;
    like++;
    for (int i = 0; i < pattern->entry_count; i++) {
        GiToken token = model[i].token;
        bool last = hole == pattern->holes + pattern->hole_count;
        if (last || token.at - begin != hole->begin) {
            token.at += shift;
            (out++)->token = token;
            continue;
        }
        GiToken found = like->token;
        shift = found.at + found.size - (begin + hole->end);
        for (int k = 0; k <= hole->count; k++) *out++ = *like++;
        i += hole->count;
        hole++;
    }
    return (int)(out - expanded);
}
