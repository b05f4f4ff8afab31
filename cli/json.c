/* SPDX-License-Identifier: MIT */
#include "json.h"

#include <stdio.h>

/* The length of the well-formed UTF-8 sequence at text; 0: there is none. */
static int sequence_length(const unsigned char *text) {
    if (text[0] < 0x80) return 1;
    int length = text[0] >= 0xc2 && text[0] < 0xe0   ? 2
                 : text[0] >= 0xe0 && text[0] < 0xf0 ? 3
                 : text[0] >= 0xf0 && text[0] < 0xf5 ? 4
                                                     : 0;
    for (int i = 1; i < length; i++) {
        if ((text[i] & 0xc0) != 0x80) return 0;
    }
    /* Overlong forms, surrogates, and what lies beyond the last code point. */
    if ((text[0] == 0xe0 && text[1] < 0xa0) || (text[0] == 0xed && text[1] > 0x9f) ||
        (text[0] == 0xf0 && text[1] < 0x90) || (text[0] == 0xf4 && text[1] > 0x8f)) {
        return 0;
    }
    return length;
}

/* File names may hold any byte; JSON only holds Unicode. */
void cli_json_print_text(const char *text) {
    putchar('"');
    const unsigned char *byte = (const unsigned char *)text;
    while (*byte != '\0') {
        int length = sequence_length(byte);
        if (length == 0) {
            fputs("\\ufffd", stdout);
            length = 1;
        } else if (*byte == '"' || *byte == '\\') {
            printf("\\%c", *byte);
        } else if (*byte < 0x20 || *byte == 0x7f) {
            printf("\\u%04x", *byte);
        } else {
            fwrite(byte, 1, (size_t)length, stdout);
        }
        byte += length;
    }
    putchar('"');
}
