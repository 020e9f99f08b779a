// Declarations, C++ and GLSL, of what an engine provides to the shared headers that fetch from a scene: enough to compile
// each of them alone.
#ifndef RT_TESTS_SCENE_ACCESS_H
#define RT_TESTS_SCENE_ACCESS_H
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

#define SceneRef uint

SceneGlobals loadGlobals(SceneRef scene);
Sphere loadSphere(SceneRef scene, uint i);
vec3 loadSphereMotion(SceneRef scene, uint i);
Quad loadQuad(SceneRef scene, uint i);
vec3 loadPosition(SceneRef scene, uint i);
vec3 loadNormal(SceneRef scene, uint i);
vec2 loadUv(SceneRef scene, uint i);
uvec3 loadTriangle(SceneRef scene, uint i);
Mesh loadMesh(SceneRef scene, uint i);
uint loadTriangleMesh(SceneRef scene, uint i);
Instance loadInstance(SceneRef scene, uint i);
Material loadMaterial(SceneRef scene, uint i);
Texture loadTexture(SceneRef scene, uint i);
Image loadImage(SceneRef scene, uint i);
vec3 loadTexel(SceneRef scene, Image image, uint x, uint y);
vec3 loadPerlinGradient(SceneRef scene, uint i);
uint loadPerlinPermutation(SceneRef scene, uint i);
Medium loadMedium(SceneRef scene, uint i);
Light loadLight(SceneRef scene, uint i);
LightBound loadLightBound(SceneRef scene, uint i);
LightCluster loadLightCluster(SceneRef scene, uint node, uint i);
void expectLights(SceneRef scene, uint node);
uint loadLightNodeParent(SceneRef scene, uint node);
uint loadLightPlace(SceneRef scene, uint light);
LightWeights loadContributions(SceneRef scene, vec3 position, vec3 normal);
float loadSkyCdf(SceneRef scene, uint i);

RT_SHARED_END

#endif
