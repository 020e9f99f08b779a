// A path tracer of a weekend, out of modules: the scene, its compiler, the tree and the bsdfs are the library's; the
// loop that follows a path, which is what one wants to understand, is written out here. No light is sampled: paths end
// when they reach the sky.
//
//     ./weekend [PICTURE.png]
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "Common/Accel/CpuAccel.h"
#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Core/Parallel.h"
#include "Common/Image/Image.h"
#include "Common/Image/ImageIo.h"
#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Camera.h"
#include "Common/Shared/Light/Sky.h"
#include "Common/Shared/Material/Bsdf.h"
#include "Common/Shared/Shape/Surface.h"

namespace shared = rt::shared;
using shared::vec2, shared::vec3;

namespace {

constexpr std::uint32_t kWidth = 320, kHeight = 180, kSamples = 32, kMaxDepth = 10;

// Three balls on a planet: matt, glass, metal.
rt::scene::SceneDesc makeScene() {
    rt::scene::SceneDesc scene;
    scene.background = rt::scene::GradientBackground{};
    scene.camera = rt::scene::camera({-2, 1.2, 3}, {0, 0.4, 0}, 30);
    scene.materials["ground"] = rt::scene::lambertian(0.5, 0.6, 0.2);
    scene.materials["matt"] = rt::scene::lambertian(0.7, 0.2, 0.2);
    scene.materials["glass"] = rt::scene::glass(1.5);
    scene.materials["metal"] = rt::scene::metal({0.8, 0.7, 0.5}, 0.1);
    rt::scene::addSphere(scene, {0, -100, 0}, 100, "ground");
    rt::scene::addSphere(scene, {-1.05, 0.5, 0}, 0.5, "glass");
    rt::scene::addSphere(scene, {0, 0.5, 0}, 0.5, "matt");
    rt::scene::addSphere(scene, {1.05, 0.5, 0}, 0.5, "metal");
    return scene;
}

// Uniform numbers of a path, two at a time.
struct Numbers {
    std::uint32_t path;
    std::uint32_t drawn = 0;
    vec2 next() {
        const shared::uvec3 words = shared::hash3({path, drawn++, 0x7eeu});
        return shared::toUniform2({words.x, words.y});
    }
};

struct Tracer {
    const rt::scene::CompiledScene& scene;
    shared::SceneView view;                    // of its arrays, as formulas read them
    std::unique_ptr<rt::accel::CpuAccel> tree; // over its primitives
    rt::accel::Tracer trace;                   // compiled for this processor, and for the kinds that there are

    explicit Tracer(const rt::scene::CompiledScene& s)
        : scene(s),
          view(shared::viewOf(s, s.globals)),
          tree(rt::accel::CpuAccel::build(
              {s.spheres, s.sphereMotions, s.quads, s.positions, s.triangles, s.geometries, s.instances, s.rounds},
              {})),
          trace(rt::accel::rayQuery().tracer(tree->view().kinds)) {}

    // What arrives along the ray: at each surface the path goes on in one direction that the bsdf draws, and what comes
    // from there counts by the weight, which is bsdf times cosine over the density of the direction.
    vec3 radiance(shared::Ray ray, Numbers& numbers) const {
        vec3 throughput(1.0f);
        for (std::uint32_t depth = 0; depth < kMaxDepth; ++depth) {
            const shared::Hit hit = trace.closest(tree->view(), ray, shared::kInfinity);
            if (hit.t < 0) return throughput * shared::skyRadiance(scene.features, view, ray.direction);

            const shared::Surface surface = shared::makeSurface(scene.features, view, ray, hit);
            const shared::Material& material = view.materials[surface.material];
            const shared::Bsdf bsdf = shared::makeBsdf(material, material.albedo);
            const vec3 wo = -ray.direction;
            const bool isFront = dot(wo, surface.normal) > 0;
            const vec3 normal = isFront ? surface.normal : -surface.normal;
            const vec2 u = numbers.next();
            const float uLobe = numbers.next().x; // chooses among the lobes of materials that have several
            const shared::BsdfSample next =
                shared::sampleBsdf(scene.features, bsdf, normal, isFront ? 1u : 0u, wo, u, uLobe);
            throughput *= next.weight;
            if (throughput == vec3(0.0f)) break; // absorbed
            ray.origin = shared::offsetOrigin(surface.position, surface.error, normal, next.wi);
            ray.direction = next.wi;
        }
        return vec3(0.0f);
    }
};

} // namespace

int main(int count, char** arguments) try {
    const std::string file = count > 1 ? arguments[1] : "weekend.png";
    const auto scene = rt::scene::compileScene(makeScene());
    const Tracer tracer(*scene);
    const shared::Camera camera = rt::scene::makeCamera(scene->camera, kWidth, kHeight, scene->origin);

    rt::image::Image picture(kWidth, kHeight);
    rt::parallelFor(0, kHeight, [&](std::size_t row) {
        const auto y = static_cast<std::uint32_t>(row);
        for (std::uint32_t x = 0; x < kWidth; ++x) {
            vec3 sum(0.0f);
            for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
                Numbers numbers{(y * kWidth + x) * kSamples + sample};
                const vec2 uPixel = numbers.next();
                sum += tracer.radiance(shared::generateCameraRay(scene->features, camera, {x, y}, {kWidth, kHeight},
                                                                 uPixel, vec2(0.5f), 0.0f),
                                       numbers);
            }
            for (int channel = 0; channel < 3; ++channel) picture.pixel(x, y)[channel] = sum[channel] / kSamples;
        }
    });
    rt::image::writeImage(file, picture);
    const float* sky = picture.pixel(kWidth / 2, 0);
    std::printf("the middle of the upper row: %.3f %.3f %.3f\n%s\n", sky[0], sky[1], sky[2], file.c_str());
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
