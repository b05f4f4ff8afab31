/* SPDX-License-Identifier: MIT */
#include "reader/name.h"

#include "reader/suggest.h"

#include <string.h>

void gi_names_init(GiNames *names, GiMemory *memory) {
    memset(names, 0, sizeof *names);
    names->memory = memory;
    names->seed = (uint32_t)((uintptr_t)names >> 4);
}

void gi_names_reset(GiNames *names) {
    gi_array_free(names->memory, &names->text);
    gi_array_free(names->memory, &names->entries);
    gi_array_free(names->memory, &names->values);
    gi_memory_free(names->memory, names->slots, names->slot_count * sizeof names->slots[0]);
    names->slots = NULL;
    names->slot_count = 0;
}

static uint32_t hash_text(const GiNames *names, GiSpan text) {
    uint32_t hash = names->seed ^ UINT32_C(2166136261); /* FNV-1a, with bits from above mixed in */
    for (size_t i = 0; i < text.size; i++) {
        hash = (hash ^ (unsigned char)text.data[i]) * UINT32_C(16777619);
        hash ^= hash >> 15;
    }
    return hash;
}

/* The slot of the name, or the empty slot where it would go. */
static uint32_t *find_slot(const GiNames *names, GiSpan name, uint32_t hash) {
    for (size_t i = hash;; i++) {
        uint32_t *slot = &names->slots[i & (names->slot_count - 1)];
        if (*slot == 0) return slot;
        const GiNamed *entry = &names->entries.data[*slot - 1];
        if (entry->hash == hash && entry->size == name.size &&
            gi_span_equals(name, names->text.data + entry->text)) {
            return slot;
        }
    }
}

static bool grow(GiNames *names) {
    size_t count = names->slot_count == 0 ? 64 : names->slot_count * 2;
    uint32_t *slots = gi_memory_allocate(names->memory, count * sizeof *slots);
    if (slots == NULL) return false;
    memset(slots, 0, count * sizeof *slots);
    for (size_t e = 0; e < names->entries.count; e++) {
        size_t i = names->entries.data[e].hash;
        while (slots[i & (count - 1)] != 0) i++;
        slots[i & (count - 1)] = (uint32_t)e + 1;
    }
    gi_memory_free(names->memory, names->slots, names->slot_count * sizeof *slots);
    names->slots = slots;
    names->slot_count = count;
    return true;
}

bool gi_names_set(GiNames *names, GiSpan name, GiNamed named) {
    size_t size = name.size + 1;
    if (names->entries.count * 2 >= names->slot_count && !grow(names)) return false;
    named.hash = hash_text(names, name);
    named.size = (uint32_t)name.size;
    uint32_t *slot = find_slot(names, name, named.hash);
    if (*slot != 0) {
        named.text = names->entries.data[*slot - 1].text;
        names->entries.data[*slot - 1] = named;
        return true;
    }
    if (size > UINT32_MAX || names->text.count > UINT32_MAX - size ||
        names->entries.count >= UINT32_MAX - 1 ||
        !gi_array_reserve(names->memory, &names->text, size)) {
        return false;
    }
    named.text = (uint32_t)names->text.count;
    if (!gi_array_push(names->memory, &names->entries, named)) return false;
    memcpy(names->text.data + names->text.count, name.data, name.size);
    names->text.data[names->text.count + name.size] = '\0';
    names->text.count += size;
    *slot = (uint32_t)names->entries.count;
    return true;
}

const GiNamed *gi_names_get(const GiNames *names, GiSpan name) {
    if (names->slot_count == 0) return NULL;
    uint32_t slot = *find_slot(names, name, hash_text(names, name));
    return slot == 0 ? NULL : &names->entries.data[slot - 1];
}

bool gi_names_intern(GiNames *names, GiSpan name, uint32_t *number) {
    const GiNamed *entry = gi_names_get(names, name);
    if (entry != NULL) {
        *number = (uint32_t)(entry - names->entries.data);
        return true;
    }
    *number = (uint32_t)names->entries.count;
    return gi_names_set(names, name, (GiNamed){.kind = GI_KIND_STRING});
}

const char *gi_names_suggest(const GiNames *names, GiSpan name) {
    enum { LOOK_BACK = 10000 }; /* bounds the time of a file with very many names and errors */
    GiSuggestion suggestion = gi_suggestion_begin(name.data, name.size);
    size_t count = names->entries.count, first = count > LOOK_BACK ? count - LOOK_BACK : 0;
    for (size_t i = count; i > first; i--) {
        gi_suggestion_offer(&suggestion, names->text.data + names->entries.data[i - 1].text);
    }
    return suggestion.best;
}
