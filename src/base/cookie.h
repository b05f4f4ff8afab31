/* SPDX-License-Identifier: MIT
 * The private version field of every desc struct. Only the default functions write it, so a struct
 * that skipped its default is caught, and so is one laid out by another version of the header. */
#pragma once

#define GI_COOKIE 0x476C6E74 /* "Glnt" */
