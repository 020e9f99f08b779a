// What a principled material (Principled.h) is made of, and its record in the compiled scene. Names in scene files and
// their help stand in Common/Scene/Json/PrincipledType.h.
#ifndef RT_SHARED_PRINCIPLED_PARAMETERS_H
#define RT_SHARED_PRINCIPLED_PARAMETERS_H
#include "Common/Shared/Base/Shim.h"

// Numbers, which a channel of an image may multiply: NUMBER(member, usual value). All lie in [0,1].
#define RT_PRINCIPLED_NUMBERS(NUMBER) \
    NUMBER(metallic, 0)               \
    NUMBER(roughness, 0.5)            \
    NUMBER(specular, 1)               \
    NUMBER(transmission, 0)           \
    NUMBER(clearcoat, 0)              \
    NUMBER(clearcoatRoughness, 0)     \
    NUMBER(sheenRoughness, 0)         \
    NUMBER(opacity, 1)                \
    NUMBER(anisotropy, 0)             \
    NUMBER(iridescence, 0)            \
    NUMBER(iridescenceThickness, 1)   \
    NUMBER(diffuseTransmission, 0)

// Colours beside the base colour, constant or a texture: COLOR(member, usual value).
#define RT_PRINCIPLED_COLORS(COLOR) \
    COLOR(specularColor, 1)         \
    COLOR(sheenColor, 0)            \
    COLOR(diffuseTransmissionColor, 1)

RT_SHARED_BEGIN

struct ScaledChannel {
    float factor; // negative, only with a texture: 1 + factor times channel, as roughness is of a map of gloss
    uint texture; // kNone: factor alone
    uint channel; // of the texture, 0 to 3: red, green, blue, opacity
};

struct TintedTexture {
    vec3 color;   // where there is no texture, which replaces it
    uint texture; // kNone: constant
};

// Beside the Material of the same index.
struct Principled {
#define RT_NUMBER(member, usual) ScaledChannel member;
#define RT_COLOR(member, usual) TintedTexture member;
    RT_PRINCIPLED_NUMBERS(RT_NUMBER)
    RT_PRINCIPLED_COLORS(RT_COLOR)
#undef RT_NUMBER
#undef RT_COLOR
    float ior;          // index of refraction inside over outside, >= 1
    uint thin;          // 1: transmits without bending, as a sheet does
    uint glass;         // first of the glassAlbedos of its index; kNone: it is thin, or nothing is transmitted
    vec3 channelIor;    // of glass that disperses, by colour channel; zero: it does not
    uvec3 channelGlass; // as `glass`, of each of them
    vec3 absorption;    // per world unit of length inside
    uint normalTexture; // tangent-space normals, 2 rgb - 1; kNone: none
    float normalScale;  // of their x and y
    uint coatTexture;   // such normals of the clear coat, which has nothing of the surface's; kNone: it is smooth
    float coatScale;
    float alphaCutoff;   // opacity below it is 0, else 1; negative: opacity is a probability
    uint emitsColors;    // 1: vertex colours multiply emission, too
    vec2 stretch;        // where facets are rougher: cosine and sine of the angle to the tangent
    vec2 filmThickness;  // of the thin film, in nm: where iridescenceThickness is 0, and where it is 1
    float filmIor;       // its index of refraction
    uint stretchTexture; // 2 rg - 1: another direction in place of the tangent; kNone: there is none
};

RT_SHARED_END

#endif
