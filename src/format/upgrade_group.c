/* SPDX-License-Identifier: MIT
 * The order of a group's transforms. Where the first listed acted first, the list is turned round:
 * each transform's text goes to the place of its counterpart, and comments stay where they are. */
#include "format/upgrade.h"

#include <string.h>

static bool is_transform(const GiToken *token) {
    return token->element != NULL && token->element->slot >= GI_SLOT_TRANSLATE &&
           token->element->slot <= GI_SLOT_SCALE;
}

/* What the steps in the new order come to: bit by bit the same matrix, nearly the same, or none,
 * since numbers may overflow in one order only. */
static GlintChangeKind compare_matrices(GiUpgrade *upgrade, const GiGroup *group) {
    const GiScene *scene = &upgrade->document->scene;
    GiGroup turned = {.nests = false};
    for (size_t i = group->steps.count; i-- > 0;) {
        if (!gi_array_push(upgrade->memory, &turned.steps, group->steps.data[i])) {
            upgrade->failed = true;
        }
    }
    GiAffine old, new;
    gi_scene_group_matrix(scene, group, upgrade->from, &old);
    bool good = gi_scene_group_matrix(scene, &turned, upgrade->to, &new);
    gi_array_free(upgrade->memory, &turned.steps);
    if (!good) return GLINT_CHANGE_DIFFERENT;
    return memcmp(&old, &new, sizeof old) == 0 ? GLINT_CHANGE_SAME : GLINT_CHANGE_ROUNDING;
}

/* Puts the value of a transform into the place of another. It has no name there, since it may come
 * to stand behind its uses, and no ref, for the same reason. */
static void move(GiUpgrade *upgrade, size_t from, size_t to) {
    const GiToken *tokens = upgrade->document->tokens.data, *place = &tokens[to];
    gi_edit_element(&upgrade->edits, place->begin, tokens[place->match].end,
        tokens[from].element->name, gi_upgrade_content(upgrade, from));
}

void gi_upgrade_value(GiUpgrade *upgrade, size_t token) {
    const GiToken *tokens = upgrade->document->tokens.data, *start = &tokens[token];
    size_t target = upgrade->targets.data[token];
    bool turned = upgrade->from->first_listed_first != upgrade->to->first_listed_first;
    if (!turned || !start->refers || !is_transform(&tokens[target])) return;
    /* A transform is written by its group, which may move it. */
    if (is_transform(start)) return;
    gi_edit_element(&upgrade->edits, start->begin, tokens[start->match].end, start->element->name,
        gi_upgrade_content(upgrade, token));
}

void gi_upgrade_group(GiUpgrade *upgrade, size_t token, uint32_t index) {
    const GiDocument *document = upgrade->document;
    if (upgrade->from->first_listed_first == upgrade->to->first_listed_first) return;
    GI_ARRAY(size_t) list = {0};
    for (size_t i = gi_document_first_child(document, token); i != GI_NO_TOKEN;
         i = gi_document_next_child(document, i)) {
        if (!is_transform(&document->tokens.data[i])) continue;
        if (!gi_array_push(upgrade->memory, &list, i)) upgrade->failed = true;
    }
    for (size_t i = 0; i < list.count; i++) {
        move(upgrade, list.data[list.count - 1 - i], list.data[i]);
    }
    if (list.count > 1) {
        GlintChangeKind kind = compare_matrices(upgrade, &document->scene.groups.data[index]);
        gi_upgrade_note(upgrade, kind, token,
            kind == GLINT_CHANGE_DIFFERENT
                ? "the first listed transform acted first: turned round, their numbers overflow"
                : "the first listed transform acted first: their order is turned round");
    }
    gi_array_free(upgrade->memory, &list);
}
