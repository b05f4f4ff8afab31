/* SPDX-License-Identifier: MIT
 * Shaders. A matte surface whose diffuse term is kd / pi, and that is black from behind, is one of
 * facets without facets: the same formula in every dialect, to the last bit. */
#include "format/upgrade.h"

#include <stdio.h>
#include <string.h>

#define NO_FACETS "<microfacetColor>0 0 0</microfacetColor>", "<alpha>1</alpha>", "<nt>1.5</nt>"

static bool has(const GiUpgrade *upgrade, size_t token, GiSlot slot) {
    return gi_upgrade_child(upgrade, token, slot) != GI_NO_TOKEN;
}

static bool is_black(const GiUpgrade *upgrade, size_t token, GiSlot slot) {
    double v[3];
    size_t child = gi_upgrade_child(upgrade, token, slot);
    return child != GI_NO_TOKEN && gi_upgrade_numbers(upgrade, child, 3, v) && v[0] == 0 &&
           v[1] == 0 && v[2] == 0;
}

static bool matte_differs(const GiUpgrade *upgrade) {
    return upgrade->has_points && upgrade->from->diffuse_over_pi != upgrade->to->diffuse_over_pi;
}

/* The diffuseColor of a Lambertian that says none. */
static void default_diffuse(const GiUpgrade *upgrade, char *text, size_t size) {
    const double gray = upgrade->from->default_diffuse, color[3] = {gray, gray, gray};
    char numbers[GI_UPGRADE_TEXT_SIZE];
    gi_upgrade_format(color, numbers);
    snprintf(text, size, "<diffuseColor>%s</diffuseColor>", numbers);
}

/* ---------------------------------------------------------------- matte */

static void tell_noise(GiUpgrade *upgrade, size_t token) {
    bool paths = upgrade->document->scene.integrator == GLINT_INTEGRATOR_PATH;
    if (!upgrade->has_large && !paths) return;
    gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
        "directions are drawn in another way here: the noise is another, the mean the same");
}

/* Under large lights alone nothing is rewritten, and one thing differs. */
static void tell_behind(GiUpgrade *upgrade, size_t token) {
    if (!upgrade->has_large || upgrade->from->black_from_behind == upgrade->to->black_from_behind) {
        return;
    }
    gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
        "where it is seen from behind it was black and now reflects light");
}

static void upgrade_lambertian(GiUpgrade *upgrade, size_t token) {
    const GiToken *start = &upgrade->document->tokens.data[token];
    bool bsdf = start->type->context == GI_IN_LAMBERTIAN_BSDF;
    bool given = bsdf || has(upgrade, token, GI_SLOT_DIFFUSE);
    char diffuse[GI_UPGRADE_TEXT_SIZE + 40];
    default_diffuse(upgrade, diffuse, sizeof diffuse);
    const char *name = gi_upgrade_name(upgrade, token);
    if (matte_differs(upgrade)) {
        const char *const facets[] = {diffuse, NO_FACETS};
        const char *const gloss[] = {"<specularColor>0 0 0</specularColor>"};
        gi_edit_set_attribute(
            &upgrade->edits, token, "type", bsdf ? "MicrofacetBSDF" : "MicrofacetBeckmann");
        if (bsdf) {
            gi_edit_append(&upgrade->edits, token, name, gloss, 1);
        } else {
            gi_edit_append(&upgrade->edits, token, name, facets + given, 4 - given);
        }
        gi_upgrade_note(upgrade, GLINT_CHANGE_SAME, token,
            "the diffuse term is kd / pi, and black from behind, which is now that of black "
            "microfacets");
        tell_noise(upgrade, token);
        return;
    }
    if (!given && upgrade->from->default_diffuse != upgrade->to->default_diffuse) {
        const char *const children[] = {diffuse};
        gi_edit_append(&upgrade->edits, token, name, children, 1);
        gi_upgrade_note(
            upgrade, GLINT_CHANGE_SAME, token, "the diffuseColor that it has is now said");
    }
    tell_behind(upgrade, token);
}

void gi_upgrade_surface(GiUpgrade *upgrade, size_t token) {
    const GiDocument *document = upgrade->document;
    for (size_t i = gi_document_first_child(document, token); i != GI_NO_TOKEN;
         i = gi_document_next_child(document, i)) {
        const GiElement *element = document->tokens.data[i].element;
        if (element == NULL) continue;
        if (element->kind == GI_KIND_SHADER || element->kind == GI_KIND_BSDF) return;
    }
    bool facets = matte_differs(upgrade);
    if (!facets) tell_behind(upgrade, token);
    if (!facets && upgrade->from->default_diffuse == upgrade->to->default_diffuse) return;
    char diffuse[GI_UPGRADE_TEXT_SIZE + 40], shader[GI_UPGRADE_TEXT_SIZE + 200];
    default_diffuse(upgrade, diffuse, sizeof diffuse);
    snprintf(shader, sizeof shader, "<shader type=\"%s\">%s%s</shader>",
        facets ? "MicrofacetBeckmann" : "Lambertian", diffuse,
        facets ? "<microfacetColor>0 0 0</microfacetColor><alpha>1</alpha><nt>1.5</nt>" : "");
    const char *const children[] = {shader};
    gi_edit_append(&upgrade->edits, token, gi_upgrade_name(upgrade, token), children, 1);
    gi_upgrade_note(upgrade, GLINT_CHANGE_SAME, token, "the shader that it has is now said");
    if (facets) tell_noise(upgrade, token);
}

/* ---------------------------------------------------------------- highlights */

static void upgrade_phong(GiUpgrade *upgrade, size_t token) {
    static const double white[3] = {1, 1, 1};
    const GiRules *from = upgrade->from, *to = upgrade->to;
    bool dull = is_black(upgrade, token, GI_SLOT_SPECULAR);
    if (!upgrade->has_points && !upgrade->has_large) return;
    if (matte_differs(upgrade)) {
        bool scaled = !has(upgrade, token, GI_SLOT_TEXTURE) &&
                      gi_upgrade_scale(upgrade, token, GI_SLOT_DIFFUSE, "diffuseColor", white,
                          0.31830988618379067);
        gi_upgrade_note(upgrade, scaled ? GLINT_CHANGE_ROUNDING : GLINT_CHANGE_DIFFERENT, token,
            scaled ? "the diffuse term was kd / pi: diffuseColor is divided by pi"
                   : "the diffuse term was kd / pi and is now kd: it gets pi times as bright");
        if (upgrade->has_large) {
            gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
                "large lights divide the diffuse term and the highlight by pi themselves");
        }
    } else if (upgrade->has_large && from->diffuse_over_pi != to->diffuse_over_pi) {
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            "light of large lights makes a highlight that is now divided by pi");
    }
    if (from->phong_cosine != to->phong_cosine && !dull) {
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            "the highlight was multiplied by n.l and is not any more: it gets brighter where "
            "light grazes");
    } else if (from->highlight_needs_light != to->highlight_needs_light && !from->phong_cosine &&
               !dull) {
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            "the highlight went on where the surface is turned away from the light (n.l <= 0) and "
            "now ends there");
    }
    if (from->black_from_behind != to->black_from_behind) {
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            "where it is seen from behind it was black and now reflects light");
    }
}

/* ---------------------------------------------------------------- rays that go on */

static void upgrade_clear(GiUpgrade *upgrade, size_t token, bool glazed) {
    const GiRules *from = upgrade->from, *to = upgrade->to;
    if (from->schlick != to->schlick) {
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            "it reflected by Schlick's formula and now does by Fresnel's");
    }
    if (!glazed && from->glass_by_flag != to->glass_by_flag) {
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            "a ray knew by counting that it is in glass, and now by n.v < 0");
    }
    if (from->glass_ends != to->glass_ends || from->least_weight != to->least_weight) {
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            "branches of little weight, and glass met by the last ray, were black");
    }
    if (glazed && from->glazed_behind != to->glazed_behind) {
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            "seen from behind it was black and now is its substrate");
    }
    if (glazed && from->glazed_adds != to->glazed_adds) {
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            "the glaze did not weaken its substrate and now does: it gets darker");
    }
}

void gi_upgrade_shader(GiUpgrade *upgrade, size_t token) {
    const GiRules *from = upgrade->from, *to = upgrade->to;
    GiContexts context = upgrade->document->tokens.data[token].type->context;
    if (context & (GI_IN_LAMBERTIAN | GI_IN_LAMBERTIAN_BSDF)) {
        upgrade_lambertian(upgrade, token);
    } else if (context == GI_IN_PHONG) {
        upgrade_phong(upgrade, token);
    } else if (context & (GI_IN_GLASS | GI_IN_GLASS_BSDF)) {
        upgrade_clear(upgrade, token, false);
    } else if (context & (GI_IN_GLAZED | GI_IN_GLAZED_BSDF)) {
        upgrade_clear(upgrade, token, true);
    } else if (context == GI_IN_COOK_TORRANCE) {
        if (from->black_from_behind != to->black_from_behind) {
            gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
                "where it is seen from behind it was black and now reflects light");
        }
        if (upgrade->has_large && from->radiance_over_pi != to->radiance_over_pi) {
            gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
                "light of large lights is now divided by pi");
        }
    }
    if (has(upgrade, token, GI_SLOT_MIRROR) && from->least_weight != to->least_weight) {
        gi_upgrade_note(
            upgrade, GLINT_CHANGE_DIFFERENT, token, "mirrored rays of little weight were left out");
    }
}
