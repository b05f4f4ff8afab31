/* SPDX-License-Identifier: MIT
 * What the scanner has found, handed to tree.c as the events that expat would make of it. */
#include "reader/state.h"

#include <string.h>

/* A line ends with one character to a reader, whatever the file has. */
static void play_text(GiReader *reader, GiSpan text, int64_t offset) {
    for (;;) {
        const char *end = memchr(text.data, '\r', text.size);
        size_t size = end != NULL ? (size_t)(end - text.data) : text.size;
        if (size > 0) gi_tree_text(reader, (GiSpan){text.data, size}, offset);
        if (end == NULL) return;
        gi_tree_text(reader, (GiSpan){"\n", 1}, offset + (int64_t)size);
        size += size + 1 < text.size && end[1] == '\n' ? 2 : 1;
        text = (GiSpan){text.data + size, text.size - size};
        offset += (int64_t)size;
    }
}

/* An element that is a value and nothing else, which most elements are: `<radius>1</radius>`. From
 * behind its start tag; null when it must be taken piece by piece. */
static const GiTapeEntry *play_value(GiReader *reader, GiSpan tag, const GiTapeEntry *entry,
    const GiTapeEntry *end, int64_t offset) {
    if (entry >= end || entry->token.kind != GI_TOKEN_NUMBERS) return NULL;
    int count = entry->token.count;
    if (end - entry <= count + 1 || entry[count + 1].token.kind != GI_TOKEN_END) return NULL;
    GiVec value = gi_tape_vec(entry + 1, count);
    return gi_tree_value(reader, tag, value, count, offset) ? entry + count + 2 : NULL;
}

static void play(GiReader *reader, const GiTape *tape, const GiTapeEntry *entry,
    const GiTapeEntry *end, const char *bytes);

static void play_like(
    GiReader *reader, const GiTape *tape, const GiTapeEntry *like, const char *bytes) {
    if (gi_like_play(reader, tape, like, bytes)) return;
    GiTapeEntry expanded[GI_PATTERN_ENTRY_LIMIT];
    const GiPattern *pattern = &tape->patterns[like->token.size];
    int count = gi_pattern_expand(pattern, tape->entries.data, like, expanded);
    play(reader, tape, expanded, expanded + count, bytes);
}

static void play(GiReader *reader, const GiTape *tape, const GiTapeEntry *entry,
    const GiTapeEntry *end, const char *bytes) {
    while (entry < end && !reader->stopped) {
        GiToken token = (entry++)->token;
        GiSpan text = {bytes + token.at, token.size};
        int64_t offset = tape->begin + token.at;
        switch ((GiTokenKind)token.kind) {
        case GI_TOKEN_START: {
            GiSpan tag = {text.data + 1, text.size - 1};
            if (token.count == 0) {
                const GiTapeEntry *next = play_value(reader, tag, entry, end, offset);
                if (next != NULL) {
                    entry = next;
                    break;
                }
            }
            GiAttribute list[GI_TAPE_ATTRIBUTE_LIMIT];
            for (int i = 0; i < token.count; i++, entry += 2) {
                list[i].name = (GiSpan){bytes + entry[0].token.at, entry[0].token.size};
                list[i].value = (GiSpan){bytes + entry[1].token.at, entry[1].token.size};
            }
            gi_tree_start(reader, tag, list, token.count, offset);
            break;
        }
        case GI_TOKEN_END: gi_tree_end(reader, offset + token.size); break;
        case GI_TOKEN_NUMBERS:
            if (!gi_tree_numbers(reader, gi_tape_vec(entry, token.count), token.count)) {
                play_text(reader, text, offset);
            }
            entry += token.count;
            break;
        case GI_TOKEN_TEXT:
        case GI_TOKEN_SPAN: play_text(reader, text, offset); break;
        case GI_TOKEN_LIKE:
            play_like(reader, tape, entry - 1, bytes);
            for (int i = 0; i < token.count; i++) entry += 1 + entry->token.count;
            break;
        }
    }
}

void gi_tape_play(GiReader *reader, const GiTape *tape) {
    if (tape->entries.count == 0) return; /* of an empty file there may be no bytes either */
    const char *bytes = (const char *)reader->window.data + (tape->begin - reader->window.base);
    for (int i = 0; i < tape->pattern_count; i++) reader->paths[i] = (GiPath){.known = false};
    const GiTapeEntry *entries = tape->entries.data;
    play(reader, tape, entries, entries + tape->entries.count, bytes);
}
