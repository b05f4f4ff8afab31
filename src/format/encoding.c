/* SPDX-License-Identifier: MIT
 * The file is known to be well formed in the encoding that its first bytes or its declaration tell,
 * so nothing is checked; what is broken nevertheless becomes something harmless. */
#include "format/encoding.h"

#include <string.h>

static bool put(GiMemory *memory, GiText *text, const char *bytes, size_t size) {
    if (!gi_array_reserve(memory, text, size)) return false;
    memcpy(text->data + text->count, bytes, size);
    text->count += size;
    return true;
}

bool gi_encoding_put(GiMemory *memory, GiText *text, uint32_t code) {
    char bytes[4];
    size_t size = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    static const unsigned char lead[] = {0, 0, 0xc0, 0xe0, 0xf0};
    for (size_t i = size; i-- > 1; code >>= 6) bytes[i] = (char)(0x80 | (code & 0x3f));
    bytes[0] = (char)(lead[size] | code);
    return put(memory, text, bytes, size);
}

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

GiSpan gi_encoding_declared(const char *text, size_t size) {
    GiSpan none = {text, 0};
    if (size < 6 || memcmp(text, "<?xml", 5) != 0 || !is_blank(text[5])) return none;
    static const char word[] = "encoding";
    size_t word_size = sizeof word - 1, i = 5;
    for (; i + word_size < size && text[i] != '>'; i++) {
        if (is_blank(text[i]) && memcmp(text + i + 1, word, word_size) == 0) break;
    }
    if (i + word_size >= size || text[i] == '>') return none;
    i += 1 + word_size;
    while (i < size && (is_blank(text[i]) || text[i] == '=')) i++;
    if (i >= size || (text[i] != '"' && text[i] != '\'')) return none;
    const char *end = memchr(text + i + 1, text[i], size - i - 1);
    if (end == NULL) return none;
    return (GiSpan){text + i + 1, (size_t)(end - text) - i - 1};
}

static bool same_word(GiSpan span, const char *small) {
    if (span.size != strlen(small)) return false;
    for (size_t i = 0; i < span.size; i++) {
        char c = span.data[i];
        if ((c >= 'A' && c <= 'Z' ? (char)(c + 32) : c) != small[i]) return false;
    }
    return true;
}

static uint32_t unit_at(const unsigned char *bytes, bool big) {
    return big ? (uint32_t)(bytes[0] << 8 | bytes[1]) : (uint32_t)(bytes[1] << 8 | bytes[0]);
}

static bool put_utf16(
    GiMemory *memory, GiText *text, const unsigned char *bytes, size_t size, bool big) {
    for (size_t i = 0; i + 1 < size; i += 2) {
        uint32_t code = unit_at(bytes + i, big);
        if (code == 0xfeff && i == 0) continue;
        if (code >= 0xd800 && code < 0xdc00 && i + 3 < size) {
            i += 2;
            code = 0x10000 + ((code - 0xd800) << 10) + (unit_at(bytes + i, big) & 0x3ff);
        }
        if (!gi_encoding_put(memory, text, code)) return false;
    }
    return true;
}

/* Lines end with a line feed: \r\n and \r are the same to XML. */
static void mend_lines(GiText *text) {
    size_t to = 0;
    for (size_t i = 0; i < text->count; i++) {
        char c = text->data[i];
        if (c == '\r') {
            if (i + 1 < text->count && text->data[i + 1] == '\n') continue;
            c = '\n';
        }
        text->data[to++] = c;
    }
    text->count = to;
}

static bool name_encoding(GiMemory *memory, GiText *text) {
    GiSpan declared = gi_encoding_declared(text->data, text->count);
    if (declared.size == 0 || same_word(declared, "utf-8")) return true;
    static const char name[] = "UTF-8";
    size_t name_size = sizeof name - 1, begin = (size_t)(declared.data - text->data);
    size_t behind = begin + declared.size;
    if (!gi_array_reserve(memory, text, name_size)) return false;
    memmove(text->data + begin + name_size, text->data + behind, text->count - behind);
    memcpy(text->data + begin, name, name_size);
    text->count = text->count - declared.size + name_size;
    return true;
}

bool gi_encoding_to_utf8(GiMemory *memory, const void *source, size_t size, GiText *text) {
    const unsigned char *bytes = source;
    bool good = true;
    bool wide = size >= 2 && (bytes[0] == 0 || bytes[1] == 0 || bytes[0] + bytes[1] == 0xfe + 0xff);
    if (wide) {
        good = put_utf16(memory, text, bytes, size, bytes[0] == 0 || bytes[0] == 0xfe);
    } else if (same_word(gi_encoding_declared(source, size), "iso-8859-1")) {
        for (size_t i = 0; i < size && good; i++) good = gi_encoding_put(memory, text, bytes[i]);
    } else {
        size_t mark = size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
        good = put(memory, text, (const char *)bytes + mark, size - mark);
    }
    if (!good || !gi_array_reserve(memory, text, 1)) return false;
    mend_lines(text);
    return name_encoding(memory, text);
}
