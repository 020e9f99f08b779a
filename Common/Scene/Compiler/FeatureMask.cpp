#include "Common/Scene/Compiler/FeatureMask.h"

#include <algorithm>
#include <stdexcept>

#include "Common/Scene/MaterialTypes.h"
#include "Common/Shared/Material/PrincipledSurface.h"

namespace rt::scene {

namespace {

using shared::Features;

Features ofMaterial(const shared::Material& material) {
    Features mask = materialType(static_cast<MaterialKind>(material.kind)).feature;
    const shared::Bsdf bsdf = shared::makeBsdf(material, material.albedo);
    if (shared::isMetal(mask, bsdf) && shared::isFuzzy(shared::kFeatureFuzz, bsdf)) mask |= shared::kFeatureFuzz;
    const shared::vec3 e = material.emission;
    return e.x > 0 || e.y > 0 || e.z > 0 ? mask | shared::kFeatureEmissive : mask;
}

// Vertex colours count for opacity as soon as some texture or number does.
bool letsRaysThrough(const shared::Principled& p) {
    return p.opacity.factor < 1 || p.opacity.texture != shared::kNone || p.alphaCutoff > 0;
}

// Of its own, as the surface below has a map of normals or the coat itself.
bool hasCoatNormal(const shared::Principled& p) {
    return p.clearcoat.factor != 0 && (p.normalTexture != shared::kNone || p.coatTexture != shared::kNone);
}

Features ofTexture(const shared::Texture& texture) {
    switch (texture.kind) {
        case shared::kTextureSolid:
            return shared::kFeatureNone;
        case shared::kTextureChecker:
            return shared::kFeatureChecker;
        case shared::kTextureImage:
            return shared::kFeatureImages;
        case shared::kTextureMarble:
        case shared::kTextureTurbulence:
        case shared::kTextureNoise:
            return shared::kFeatureNoise;
        default:
            throw std::logic_error("a kind of texture without a feature");
    }
}

Features ofLight(const shared::Light& light) {
    switch (light.kind) {
        case shared::kLightSphere:
            return shared::kFeatureSphereLights;
        case shared::kLightQuad:
            return shared::kFeatureQuadLights;
        case shared::kLightTriangle:
            return shared::kFeatureTriangleLights;
        case shared::kLightEllipsoid:
            return shared::kFeatureEllipsoidLights;
        case shared::kLightDisk:
            return shared::kFeatureDiskLights;
        case shared::kLightCylinder:
            return shared::kFeatureCylinderLights;
        case shared::kLightPoint:
        case shared::kLightSpot:
        case shared::kLightDirectional:
            return shared::kFeaturePunctualLights;
        default:
            return shared::kFeatureNone;
    }
}

Features ofSky(const shared::SceneGlobals& globals) {
    if (globals.skyKind == shared::kSkyBlack) return shared::kFeatureNone;
    return shared::kFeatureSky |
           (globals.skyKind == shared::kSkyImage ? shared::kFeatureSkyImage : shared::kFeatureNone);
}

} // namespace

shared::Features featureMask(const CompiledScene& scene) {
    Features mask = ofSky(scene.globals);
    const auto need = [&mask](bool needed, Features bits) {
        if (needed) mask |= bits;
    };
    need(!scene.spheres.empty(), shared::kFeatureSpheres);
    need(!scene.sphereMotions.empty(), shared::kFeatureMovingSpheres);
    need(!scene.quads.empty(), shared::kFeatureQuads);
    need(!scene.triangles.empty(), shared::kFeatureTriangles);
    for (const shared::Round& round : scene.rounds)
        need(true, round.hole >= 0 ? shared::kFeatureDisks : shared::kFeatureCylinders);
    need(!scene.instances.empty(), shared::kFeatureInstances);
    need(!scene.media.empty(), shared::kFeatureVolumes);
    need(scene.camera.defocusAngle > 0, shared::kFeatureThinLens);
    need(scene.globals.lightCount > 0, shared::kFeatureLights);
    need(scene.globals.lightCount > shared::kContributionLights, shared::kFeatureManyLights);
    need(!scene.normals.empty(), shared::kFeatureSmoothNormals);
    for (const shared::Material& material : scene.materials) mask |= ofMaterial(material);
    for (std::size_t i = 0; i < scene.principled.size(); ++i)
        if (shared::isPrincipled(shared::kFeatureAll, scene.materials[i])) {
            need(true, shared::kFeatureVertexAttributes); // which no other kind of material looks at
            need(letsRaysThrough(scene.principled[i]), shared::kFeatureOpacity);
            need(hasCoatNormal(scene.principled[i]), shared::kFeatureCoatNormal);
            need(scene.principled[i].channelIor.x > 0, shared::kFeatureDispersion);
            need(scene.principled[i].diffuseTransmission.factor != 0, shared::kFeatureDiffuseTransmission);
            need(scene.principled[i].iridescence.factor != 0, shared::kFeatureIridescence);
            need(scene.principled[i].anisotropy.factor != 0, shared::kFeatureAnisotropy);
        }
    // Vertex colours have an opacity of their own, which counts for principled materials.
    if (shared::has(mask, shared::kFeatureVertexAttributes))
        need(std::any_of(scene.colors.begin(), scene.colors.end(), [](const shared::vec4& c) { return c.w < 1.0f; }),
             shared::kFeatureOpacity);
    for (const shared::Texture& texture : scene.textures) mask |= ofTexture(texture);
    for (const shared::Light& light : scene.lights) mask |= ofLight(light);
    return mask;
}

} // namespace rt::scene
