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

static GiVec read_vec(const GiTapeEntry *numbers, int count) {
    return gi_vec(
        numbers[0].number, count > 1 ? numbers[1].number : 0, count > 2 ? numbers[2].number : 0);
}

void gi_tape_play(GiReader *reader, const GiTape *tape) {
    if (tape->entries.count == 0) return; /* of an empty file there may be no bytes either */
    const char *bytes = (const char *)reader->window.data + (tape->begin - reader->window.base);
    const GiTapeEntry *entry = tape->entries.data, *end = entry + tape->entries.count;
    while (entry < end && !reader->stopped) {
        GiToken token = (entry++)->token;
        GiSpan text = {bytes + token.at, token.size};
        int64_t offset = tape->begin + token.at;
        switch ((GiTokenKind)token.kind) {
        case GI_TOKEN_START: {
            GiAttribute list[GI_TAPE_ATTRIBUTE_LIMIT];
            for (int i = 0; i < token.count; i++, entry += 2) {
                list[i].name = (GiSpan){bytes + entry[0].token.at, entry[0].token.size};
                list[i].value = (GiSpan){bytes + entry[1].token.at, entry[1].token.size};
            }
            gi_tree_start(
                reader, (GiSpan){text.data + 1, text.size - 1}, list, token.count, offset);
            break;
        }
        case GI_TOKEN_END: gi_tree_end(reader, offset + token.size); break;
        case GI_TOKEN_NUMBERS:
            if (!gi_tree_numbers(reader, read_vec(entry, token.count), token.count)) {
                play_text(reader, text, offset);
            }
            entry += token.count;
            break;
        case GI_TOKEN_TEXT:
        case GI_TOKEN_SPAN: play_text(reader, text, offset); break;
        }
    }
}
