// Common/Shared/Base/SceneAccess.h for shaders: out of the buffers that Bindings.glsl names.
#include "Bindings.glsl"
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Texture/Color.h"
#include "Common/Shared/Light/LightContribution.h"
#include "Common/Shared/Light/Lights.h"

SceneGlobals loadGlobals(SceneRef scene) {
    SceneGlobals globals = constants.globals;
    if (kLightCount != 0u) globals.lightCount = kLightCount; // then the compiler unrolls loops over lights
    return globals;
}
#define RT_LOAD(Type, name, load, title) Type load(SceneRef scene, uint i) { return constants.arrays.name.at[i]; }
#define RT_DEFINED_BELOW(Type, name, load, title)
RT_SCENE_ARRAYS(RT_LOAD, RT_DEFINED_BELOW)

vec3 loadSphereMotion(SceneRef scene, uint i) { return constants.arrays.sphereMotions.at[i]; }

// All lanes ask for the same light: that is what uniform buffers are fast at.
LightBound loadLightBound(SceneRef scene, uint i) {
    if (kLightCount != 0u) return constants.lightBounds[i];
    return constants.arrays.lightBounds.at[i];
}

LightCluster loadLightCluster(SceneRef scene, uint node, uint i) {
    LightCluster c;
    c.center = vec3(constants.arrays.lightNodes.at[node].centerX[i], constants.arrays.lightNodes.at[node].centerY[i],
                    constants.arrays.lightNodes.at[node].centerZ[i]);
    c.radius = constants.arrays.lightNodes.at[node].radius[i];
    c.axis = vec3(constants.arrays.lightNodes.at[node].axisX[i], constants.arrays.lightNodes.at[node].axisY[i],
                  constants.arrays.lightNodes.at[node].axisZ[i]);
    c.meanResultantLength = constants.arrays.lightNodes.at[node].meanResultantLength[i];
    c.spreadCosine = constants.arrays.lightNodes.at[node].spreadCosine[i];
    c.planarIntensity = constants.arrays.lightNodes.at[node].planarIntensity[i];
    c.omnidirectionalIntensity = constants.arrays.lightNodes.at[node].omnidirectionalIntensity[i];
    c.child = constants.arrays.lightNodes.at[node].child[i];
    return c;
}

vec4 loadTexel(SceneRef scene, Image image, uint x, uint y) {
    uint texel = y * image.width + x;
    if (image.format == kTexelSrgb8 || image.format == kTexelLinear8) {
        uint word = constants.arrays.texels.at[image.firstTexel + texel];
        vec4 linear = decodeLinear8(word);
        return image.format == kTexelSrgb8 ? vec4(decodeSrgb8(word), linear.w) : linear;
    }
    bool hasOpacity = image.format == kTexelLinearF32A;
    uint first = image.firstTexel + (hasOpacity ? 4u : 3u) * texel;
    return vec4(uintBitsToFloat(constants.arrays.texels.at[first]), uintBitsToFloat(constants.arrays.texels.at[first + 1u]),
                uintBitsToFloat(constants.arrays.texels.at[first + 2u]),
                hasOpacity ? uintBitsToFloat(constants.arrays.texels.at[first + 3u]) : 1.0f);
}
