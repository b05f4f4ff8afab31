/* SPDX-License-Identifier: MIT
 * What is looked for: every rule with its name, how bad it is, what it finds, and why that matters.
 * The help on the screen, SARIF and docs/check.md all quote these sentences. */
#pragma once

#include "glint/glint.h"
#include "reader/report.h"

/* clang-format off */
#define GI_RULE_LIST(X)                                                                            \
    X(SYNTAX, GI_RULE_SYNTAX, ERROR,                                                               \
        "The file is not well-formed XML.",                                                        \
        "The message says what to write; nothing behind the place is read.")                       \
    X(SCENE, GI_RULE_SCENE, ERROR,                                                                 \
        "The format does not allow this.",                                                         \
        "docs/scene-format.md lists what each element takes.")                                     \
    X(FILE, GI_RULE_FILE, ERROR,                                                                   \
        "A file is missing or broken.",                                                            \
        "Files are looked for from the scene's folder, then from each folder above it.")           \
    X(NOTHING_IN_VIEW, "nothing-in-view", WARNING,                                                 \
        "No camera ray meets anything.",                                                           \
        "The picture is the background alone. Look at viewPoint and viewDir; "                     \
        "viewDir is a direction, not the point that is looked at.")                                \
    X(CAMERA_INSIDE, "camera-inside-solid", WARNING,                                               \
        "The camera stands inside a solid that has no light in it.",                               \
        "All that is seen is the dark inside. Move viewPoint out of the solid, or put a light "    \
        "into it.")                                                                                \
    X(CAMERA_REPLACED, "camera-replaced", WARNING,                                                 \
        "A further camera takes the place of this one.",                                           \
        "A scene has one camera; of several the last one counts.")                                 \
    X(STRETCHED, "stretched-window", WARNING,                                                      \
        "The window has another shape than the picture.",                                          \
        "The window of viewWidth by viewHeight is spread over all pixels, in every year, so that " \
        "spheres become ellipses. Give both the same ratio of width to height.")                   \
    X(NO_LIGHT, "no-light", WARNING,                                                               \
        "The scene has no light, and surfaces that need some.",                                    \
        "They are drawn black. Only RGBNormals and what mirrors or refracts the background can "   \
        "do without.")                                                                             \
    X(LIGHT_DARK, "light-dark", WARNING,                                                           \
        "A light has no intensity.",                                                               \
        "It adds nothing, but rays are sent to it.")                                               \
    X(LIGHT_NEGATIVE, "light-negative", WARNING,                                                   \
        "A light has a negative intensity.",                                                       \
        "It takes light away.")                                                                    \
    X(LIGHT_INSIDE, "light-inside-solid", WARNING,                                                 \
        "A light stands inside a solid, and the camera outside.",                                  \
        "Surfaces block light from both sides, so that nothing that can be seen gets any of it. "  \
        "Move the light out of the solid.")                                                        \
    X(LIGHT_REACHES, "light-reaches-nothing", WARNING,                                             \
        "A light adds nothing to the picture.",                                                    \
        "Drawn with this light alone the picture is black: whatever is seen turns its back to "    \
        "the light or lies in shadow.")                                                            \
    X(DIALECT, "ambiguous-dialect", WARNING,                                                       \
        "Nothing in the file tells by which year's rules it is to be drawn.",                      \
        "The years differ in how light fades and is reflected. Say which one is meant: "           \
        "<scene dialect=\"2018\">, or --dialect.")                                                 \
    X(UNUSED_SHADER, "unused-shader", WARNING,                                                     \
        "No surface has this shader.",                                                             \
        "It has a name that nothing refers to, or another shader of the same surface takes its "   \
        "place.")                                                                                  \
    X(IDLE_SHADER, "shader-without-effect", WARNING,                                               \
        "A shader without a name stands where no surface gets it.",                                \
        "A shader inside of a Group is not handed down to what the Group contains. Put it into "   \
        "each surface, or name it and refer to it.")                                               \
    X(COLOR_NEGATIVE, "color-negative", WARNING,                                                   \
        "A colour has a component below 0.",                                                       \
        "It takes light away.")                                                                    \
    X(COLOR_CLIPS, "color-clips", WARNING,                                                         \
        "A colour has a component above 1, and the picture is cut off there.",                     \
        "A PNG holds 0 to 1; what is brighter is drawn as 1, so shades are lost and hues turn. "   \
        "Colours run from 0 to 1, not to 255.")                                                    \
    X(EXPONENT, "phong-exponent", WARNING,                                                         \
        "The exponent of a Phong shader is not positive.",                                         \
        "With 0 the highlight is equally bright everywhere; below 0 it grows without bound away "  \
        "from where it belongs.")                                                                  \
    X(TEXCOORDS, "texture-without-coordinates", WARNING,                                           \
        "A surface has a texture but no texture coordinates.",                                     \
        "Only spheres and meshes with vt lines have some. Elsewhere all points show the corner "   \
        "(0, 0) of the picture.")                                                                  \
    X(DUPLICATE, "duplicate-surface", WARNING,                                                     \
        "The same surface stands twice in one place.",                                             \
        "The one that comes first in the file is drawn; the other is never seen.")                 \
    X(COINCIDENT, "coincident-surfaces", WARNING,                                                  \
        "Two surfaces of different shaders lie in each other where they are seen.",                \
        "Which one a ray meets first is decided by rounding, so that the picture is speckled. "    \
        "Move one of them by a little.")                                                           \
    X(TOO_SMALL, "surface-too-small", WARNING,                                                     \
        "A surface is smaller than a hundredth of a pixel.",                                       \
        "No ray is likely to meet it. A Box without minPt and maxPt is a point.")                  \
    X(DEGENERATE, "mesh-degenerate", WARNING,                                                      \
        "A mesh has many triangles without area.",                                                 \
        "They are never drawn. Their corners coincide or lie on a line.")                          \
    X(WINDING, "mesh-winding", WARNING,                                                            \
        "Neighbouring triangles of a mesh without normals turn their fronts to different sides.",  \
        "A triangle is lit on the side from where its corners run counterclockwise, so that some " \
        "are dark among bright ones.")                                                             \
    X(NORMALS, "mesh-normals", WARNING,                                                            \
        "Some triangles of a mesh have normals that point to their back.",                         \
        "They are lit from the wrong side. The corners' order and the normals must agree.")        \
    X(OUT_OF_VIEW, "surface-out-of-view", NOTE,                                                    \
        "A surface lies outside of what the camera sees.",                                         \
        "It may cast shadows and be seen in mirrors.")
/* clang-format on */

typedef enum GiRule {
#define GI_RULE_ENUM(id, name, severity, summary, help) GI_CHECK_##id,
    GI_RULE_LIST(GI_RULE_ENUM)
#undef GI_RULE_ENUM
        GI_CHECK_COUNT
} GiRule;
