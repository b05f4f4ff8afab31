/* SPDX-License-Identifier: MIT
 * Shaders, in all the words of the years, to the model's: a bsdf is a shader, a Microfacet takes
 * the type of its brdf. */
#include "reader/state.h"

static bool is_plain_surface(const GiFrame *frame) {
    return frame->element->kind == GI_KIND_SURFACE && frame->type != NULL &&
           frame->type->value != GLINT_SURFACE_GROUP;
}

static void name_broken(GiReader *reader, const GiFrame *frame) {
    gi_object_name(reader, frame, (GiNamed){.kind = (uint8_t)frame->element->kind, .broken = true});
}

/* A shader matters to a surface that has it, to the glazing over it and to those that refer to it.
 */
void gi_shading_give(GiReader *reader, const GiFrame *frame, GiFrame *parent, uint32_t shader) {
    if (is_plain_surface(parent)) parent->index = shader;
    if (frame->element->slot != GI_SLOT_SUBSTRATE) return;
    /* The slots, which were the substrate's, are the glazing's again. */
    reader->given &= ~gi_object_slots(GI_KIND_SHADER);
    gi_reader_put(reader, GI_SLOT_SUBSTRATE, gi_vec(shader, 0, 0), frame->place);
    if (parent->refraction > 0) {
        gi_reader_put(reader, GI_SLOT_REFRACTION, gi_vec(parent->refraction, 0, 0), frame->place);
    }
}

/* Type, roughness and index that come as one value, from a brdf or a disttype. */
static void set_distribution(GiShader *shader, GiVec value) {
    shader->type = (GlintShaderType)value.x;
    shader->roughness = value.y;
    shader->index = value.z;
}

static GiVec distribution_of_disttype(const GiReader *reader) {
    GiVec value = gi_reader_slot(reader, GI_SLOT_DISTTYPE);
    if (!gi_reader_is_given(reader, GI_SLOT_DISTTYPE)) {
        value.y = reader->defaults[GI_SLOT_ROUGHNESS].x;
        value.z = reader->defaults[GI_SLOT_REFRACTION].x;
    }
    value.x = value.x == 0 ? GLINT_SHADER_BECKMANN : GLINT_SHADER_GGX;
    return value;
}

static uint32_t index_in(const GiReader *reader, GiSlot slot) {
    return gi_reader_is_given(reader, slot) ? (uint32_t)reader->slots[slot].value.x : GI_NONE;
}

static GiShader make_shader(GiReader *reader, const GiFrame *frame) {
    gi_object_use_type(reader, frame->type);
    GiShader shader = {
        .type = (GlintShaderType)frame->type->value,
        /* The years differ about Lambertian, not about LambertianBSDF. */
        .diffuse_given =
            gi_reader_is_given(reader, GI_SLOT_DIFFUSE) || frame->type->kind == GI_KIND_BSDF,
        .diffuse = gi_reader_slot(reader, GI_SLOT_DIFFUSE),
        .specular = gi_reader_slot(reader, GI_SLOT_SPECULAR),
        .mirror = gi_reader_slot(reader, GI_SLOT_MIRROR),
        .exponent = gi_reader_slot(reader, GI_SLOT_EXPONENT).x,
        .roughness = gi_reader_slot(reader, GI_SLOT_ROUGHNESS).x,
        .index = gi_reader_slot(reader, GI_SLOT_REFRACTION).x,
        .texture = index_in(reader, GI_SLOT_TEXTURE),
        .substrate = index_in(reader, GI_SLOT_SUBSTRATE),
    };
    if (frame->type->context == GI_IN_MICROFACET) {
        set_distribution(&shader, reader->slots[GI_SLOT_BRDF].value);
    } else if (frame->type->context == GI_IN_MICROFACET_BSDF) {
        set_distribution(&shader, distribution_of_disttype(reader));
    }
    return shader;
}

static bool is_good(GiReader *reader, const GiFrame *frame) {
    if (frame->type == NULL || frame->broken || !gi_object_is_complete(reader, frame)) return false;
    uint32_t substrate = index_in(reader, GI_SLOT_SUBSTRATE);
    const char *fault =
        substrate == GI_NONE ? NULL : gi_scene_check_substrate(reader->scene, substrate);
    if (fault == NULL) return true;
    gi_report_add(&reader->report, frame->place, 1, "%s", fault);
    return false;
}

void gi_shading_finish_shader(GiReader *reader, GiFrame *frame, GiFrame *parent) {
    if (!is_good(reader, frame)) {
        parent->broken = true;
        name_broken(reader, frame);
        return;
    }
    bool used = is_plain_surface(parent) || frame->element->slot == GI_SLOT_SUBSTRATE;
    if (!used && !gi_reader_is_named(reader, frame)) {
        gi_object_remember_idle(reader, frame);
        return;
    }
    size_t index = reader->scene->shaders.count;
    if (index >= UINT32_MAX ||
        !gi_array_push(reader->memory, &reader->scene->shaders, make_shader(reader, frame))) {
        gi_reader_out_of_memory(reader);
        return;
    }
    gi_object_remember(reader, frame, GLINT_OBJECT_SHADER);
    gi_shading_give(reader, frame, parent, (uint32_t)index);
    gi_object_name(
        reader, frame, (GiNamed){.kind = (uint8_t)frame->element->kind, .index = (uint32_t)index});
}

/* ---------------------------------------------------------------- brdf, texture */

void gi_shading_finish_brdf(GiReader *reader, GiFrame *frame, GiFrame *parent) {
    if (frame->type == NULL || frame->broken || !gi_object_is_complete(reader, frame)) {
        parent->broken = true;
        name_broken(reader, frame);
        return;
    }
    GiVec value = {frame->type->value, gi_reader_slot(reader, GI_SLOT_ROUGHNESS).x,
        gi_reader_slot(reader, GI_SLOT_REFRACTION).x};
    gi_reader_put(reader, GI_SLOT_BRDF, value, frame->place);
    gi_object_name_value(reader, frame, value);
}

_Static_assert((int)GI_WRAP_REPEAT == GLINT_WRAP_REPEAT && (int)GI_WRAP_CLAMP == GLINT_WRAP_CLAMP,
    "the table has the public values");

void gi_shading_finish_texture(GiReader *reader, GiFrame *frame, GiFrame *parent) {
    if (frame->type == NULL || frame->broken || !gi_object_is_complete(reader, frame)) {
        parent->broken = true;
        name_broken(reader, frame);
        return;
    }
    GiTexture texture = {index_in(reader, GI_SLOT_PICTURE), (GiWrap)frame->type->value};
    size_t index = reader->scene->textures.count;
    if (index >= UINT32_MAX || !gi_array_push(reader->memory, &reader->scene->textures, texture)) {
        gi_reader_out_of_memory(reader);
        return;
    }
    GiVec value = gi_vec((double)index, 0, 0);
    gi_reader_put(reader, GI_SLOT_TEXTURE, value, frame->place);
    gi_object_name_value(reader, frame, value);
}
