// How formulas read the scene. SceneRef says which, and load...() fetches element i of an array of SceneArrays.h. In
// C++ a scene is a view of arrays, whoever owns them; a shader is bound to one, and defines what is declared here.
#ifndef RT_SHARED_SCENE_ACCESS_H
#define RT_SHARED_SCENE_ACCESS_H
#include "Common/Shared/Base/SceneArrays.h"
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

RT_FN vec4 decodeLinear8(uint word) {
    return vec4(float(word & 255u), float(word >> 8u & 255u), float(word >> 16u & 255u), float(word >> 24u)) *
           (1.0f / 255.0f);
}

RT_SHARED_END

#ifdef __cplusplus

namespace rt::shared {

// One member an array: Array<Sphere> spheres, and so on. std::vector owns them; pointers make a view.
template <template <typename...> typename Array>
struct SceneArraysOf {
#define RT_MEMBER(Type, name, load, title) Array<Type> name{};
    RT_SCENE_ARRAYS(RT_MEMBER, RT_MEMBER)
#undef RT_MEMBER
};

// visit(title, scenes.spheres...), then of each further array: of one scene, or the arrays of several side by side.
template <typename Visit, typename... Scenes>
void forEachArray(const Visit& visit, Scenes&... scenes) {
#define RT_VISIT(Type, name, load, title) visit(title, scenes.name...);
    RT_SCENE_ARRAYS(RT_VISIT, RT_VISIT)
#undef RT_VISIT
}

// Without those that follow from the others.
template <typename Visit, typename... Scenes>
void forEachSourceArray(const Visit& visit, Scenes&... scenes) {
#define RT_VISIT(Type, name, load, title) visit(title, scenes.name...);
    RT_SCENE_SOURCE_ARRAYS(RT_VISIT, RT_VISIT)
#undef RT_VISIT
}

template <typename Record>
using ConstPointer = const Record*;

// First elements, null where the scene has none.
struct SceneView : SceneArraysOf<ConstPointer> {
    const float* srgbToLinear = nullptr; // of each byte, for images of kTexelSrgb8
    SceneGlobals globals{};
};
using SceneRef = const SceneView&;

// Of SceneArraysOf<std::vector>, which stay where they are while the view is used.
template <typename Vectors>
SceneView viewOf(const Vectors& arrays, const SceneGlobals& globals) {
    SceneView view;
    forEachArray(
        [](const char*, const auto& records, auto& first) { first = records.empty() ? nullptr : records.data(); },
        arrays, view);
    view.globals = globals;
    return view;
}

#define RT_LOAD(Type, name, load, title)             \
    RT_FN const Type& load(SceneRef scene, uint i) { \
        return scene.name[i];                        \
    }
#define RT_DEFINED_BELOW(Type, name, load, title)
RT_SCENE_ARRAYS(RT_LOAD, RT_DEFINED_BELOW)
#undef RT_LOAD
#undef RT_DEFINED_BELOW

RT_FN const SceneGlobals& loadGlobals(SceneRef scene) {
    return scene.globals;
}
RT_FN vec3 loadSphereMotion(SceneRef scene, uint i) {
    return scene.sphereMotions != nullptr ? scene.sphereMotions[i] : vec3(0.0f);
}
RT_FN const LightBound& loadLightBound(SceneRef scene, uint i) {
    return scene.lightBounds[i];
}
RT_FN LightCluster loadLightCluster(SceneRef scene, uint node, uint i) {
    const LightNode& n = scene.lightNodes[node];
    LightCluster c;
    c.center = vec3(n.centerX[i], n.centerY[i], n.centerZ[i]);
    c.radius = n.radius[i];
    c.axis = vec3(n.axisX[i], n.axisY[i], n.axisZ[i]);
    c.meanResultantLength = n.meanResultantLength[i];
    c.spreadCosine = n.spreadCosine[i];
    c.planarIntensity = n.planarIntensity[i];
    c.omnidirectionalIntensity = n.omnidirectionalIntensity[i];
    c.child = n.child[i];
    return c;
}
RT_FN vec4 loadTexel(SceneRef scene, const Image& image, uint x, uint y) {
    const uint texel = y * image.width + x;
    if (image.format == kTexelLinearF32) {
        const uint* words = scene.texels + image.firstTexel + 3u * texel;
        return vec4(uintBitsToFloat(words[0]), uintBitsToFloat(words[1]), uintBitsToFloat(words[2]), 1.0f);
    }
    if (image.format == kTexelLinearF32A) {
        const uint* words = scene.texels + image.firstTexel + 4u * texel;
        return vec4(uintBitsToFloat(words[0]), uintBitsToFloat(words[1]), uintBitsToFloat(words[2]),
                    uintBitsToFloat(words[3]));
    }
    const uint word = scene.texels[image.firstTexel + texel];
    if (image.format == kTexelLinear8) return decodeLinear8(word);
    return vec4(scene.srgbToLinear[word & 255u], scene.srgbToLinear[word >> 8u & 255u],
                scene.srgbToLinear[word >> 16u & 255u], float(word >> 24u) * (1.0f / 255.0f));
}

} // namespace rt::shared

#else

struct SceneRef {
    uint unused;
};

#define RT_DECLARE(Type, name, load, title) Type load(SceneRef scene, uint i);
#define RT_DECLARED_BELOW(Type, name, load, title)
RT_SCENE_ARRAYS(RT_DECLARE, RT_DECLARED_BELOW)

SceneGlobals loadGlobals(SceneRef scene);
vec3 loadSphereMotion(SceneRef scene, uint i); // 0 for all where none moves
LightBound loadLightBound(SceneRef scene, uint i);
LightCluster loadLightCluster(SceneRef scene, uint node, uint i); // child i of a node
vec4 loadTexel(SceneRef scene, Image image, uint x, uint y);      // linear RGB, opacity

#endif

RT_SHARED_BEGIN

// Place of a node of the light tree in its parent: node * kLightNodeChildren + child; kNone: the root.
RT_FN uint loadLightNodeParent(SceneRef scene, uint node) {
    return loadLightLeaf(scene, loadGlobals(scene).lightCount + node);
}

RT_SHARED_END

#endif
