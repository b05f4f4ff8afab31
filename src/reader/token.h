/* SPDX-License-Identifier: MIT
 * What the scanner finds, eight bytes a piece. */
#pragma once

#include <stdint.h>

typedef enum GiTokenKind {
    GI_TOKEN_START, /* `<name`; the name and the value of each attribute follow */
    GI_TOKEN_END,   /* up to the end of the tag; of <a/> the whole tag */
    GI_TOKEN_TEXT,
    GI_TOKEN_NUMBERS, /* an element's whole content when that is up to three numbers, which follow
                       */
    GI_TOKEN_SPAN,    /* of an attribute */
    GI_TOKEN_LIKE     /* an element like a pattern, whose number is the size; as many holes as the
                         count says follow, numbers or spans */
} GiTokenKind;

enum { GI_TAPE_ATTRIBUTE_LIMIT = 4, GI_TAPE_NUMBER_LIMIT = 3 };

typedef struct GiToken {
    uint32_t at; /* in bytes from where the tape begins */
    uint16_t size;
    uint8_t kind;  /* GiTokenKind */
    uint8_t count; /* of attributes, numbers or holes */
} GiToken;

typedef union GiTapeEntry {
    GiToken token;
    double number;
} GiTapeEntry;
