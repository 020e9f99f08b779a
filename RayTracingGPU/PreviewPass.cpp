#include "RayTracingGPU/PreviewPass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "Common/Core/Error.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Shared/Base/Features.h"
#include "RayTracingGPU/EmbeddedShaders.h"
#include "Shaders/SpecializationIds.h"

namespace rt::gpu {
namespace {

using shared::vec3;

constexpr const char* kWhat = "Preparing the preview";
constexpr std::uint32_t kConstantsBinding = 1;  // as in Bindings.glsl
constexpr std::uint32_t kGroup = 64;            // as in Preview.comp
constexpr std::uint32_t kBandPixels = 1u << 20; // that are drawn at a time, from some of the primitives
constexpr std::uint32_t kWhole = 36;            // vertices: a multiple of those of every primitive
constexpr std::uint32_t kMaxLights = 16;        // whose light is added up for each pixel
constexpr float kNear = 1e-4f;                  // of the distance of focus: nearer surfaces are cut
constexpr float kMinAmbient = 0.05f;            // so that nothing is wholly dark
constexpr VkShaderStageFlags kStages =
    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

// What the preview leaves out: the lens, and motion over the shutter.
shared::Features previewFeatures(shared::Features features) {
    return features & ~(shared::kFeatureThinLens | shared::kFeatureMovingSpheres);
}

// The lights of a scene that send out most, but for the sky, which is everywhere.
std::vector<std::uint32_t> strongestLights(const scene::CompiledScene& scene) {
    std::vector<std::uint32_t> lights(scene.globals.lightCount);
    std::iota(lights.begin(), lights.end(), 0u);
    std::erase_if(lights, [&](std::uint32_t i) { return scene.lights[i].kind == shared::kLightSky; });
    const auto count = std::min<std::size_t>(lights.size(), kMaxLights);
    const auto stronger = [&](std::uint32_t a, std::uint32_t b) {
        return scene.lights[a].selection > scene.lights[b].selection;
    };
    std::partial_sort(lights.begin(), lights.begin() + static_cast<std::ptrdiff_t>(count), lights.end(), stronger);
    lights.resize(count);
    return lights;
}

// Radiance of white surfaces, were the light of all lamps spread evenly over a sphere of the scene's size whose wall
// absorbs half of what arrives.
vec3 ambientOf(const scene::CompiledScene& scene) {
    const double radius = scene.globals.sceneRadius;
    glm::dvec3 sum(0);
    for (std::uint32_t i = 0; i < scene.globals.lightCount; ++i) {
        const shared::Light& light = scene.lights[i];
        if (light.kind == shared::kLightSky) continue;
        sum += glm::dvec3(light.emission) * scene::emittingArea(light);
    }
    if (radius > 0) sum /= 0.5 * 4 * std::numbers::pi * radius * radius;
    return glm::max(vec3(sum), vec3(kMinAmbient));
}

// The specialization constants of Preview.glsl; others stay as the shaders have them.
struct Specialization {
    shared::Features features;
    std::uint32_t shape;

    static constexpr VkSpecializationMapEntry kEntries[] = {{shared::kSceneFeaturesId, 0, 4},
                                                            {shared::kMaterialFeaturesId, 4, 4},
                                                            {shared::kMethodsId, 8, 4},
                                                            {shared::kShapeId, 12, 4}};
    VkSpecializationInfo info() const { return {4, kEntries, 16, this}; }
};

} // namespace

PreviewPass::PreviewPass(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, const GpuScene& scene)
    : context_(context),
      scene_(scene),
      features_(previewFeatures(scene.compiled().features)),
      constants_(context.memory(), sizeof(shared::RenderConstants), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                 vulkan::Memory::Device, "constants"),
      clearing_(makePreviewRenderPass(context.device(), true)),
      goingOn_(makePreviewRenderPass(context.device(), false)),
      vertices_(context.info().isSoftware(), 1) {
    if (!context.info().draws) throw RenderError(context.info().name + " cannot draw: there is no preview");
    listDraws();
    createPipelines(cache);
}

// ---- set-up --------------------------------------------------------------------------------------------------------

void PreviewPass::listDraws() {
    const scene::CompiledScene& s = scene_.compiled();
    std::vector<std::uint32_t> indices = strongestLights(s);
    launch_.lightCount = static_cast<std::uint32_t>(indices.size());
    // Mesa 25.2 on processors loads what all invocations of a draw would load from one place even where
    // a condition forbids it to all of them, as in a loop of no turn: such a place must be one of the array.
    if (indices.empty()) indices.push_back(0);
    launch_.ambient = ambientOf(s);
    launch_.near = kNear;
    std::vector<std::vector<std::uint32_t>> instances(s.geometries.size());
    instances[0].push_back(shared::kNone);
    for (std::uint32_t i = 0; i < s.instances.size(); ++i) instances[s.instances[i].geometry].push_back(i);
    for (std::size_t g = 0; g < s.geometries.size(); ++g) {
        const shared::Geometry& geometry = s.geometries[g];
        const auto first = static_cast<std::uint32_t>(indices.size());
        const auto count = static_cast<std::uint32_t>(instances[g].size());
        indices.insert(indices.end(), instances[g].begin(), instances[g].end());
        const auto add = [&](std::uint32_t shape, std::uint32_t begin, std::uint32_t primitives,
                             std::uint32_t vertices) {
            if (primitives > 0 && count > 0) {
                draws_.push_back({shape, begin * vertices, primitives * vertices, first, count});
            }
        };
        add(shared::kSphere, geometry.firstSphere, geometry.sphereCount, 36);
        add(shared::kQuad, geometry.firstQuad, geometry.quadCount, 6);
        add(shared::kTriangle, geometry.firstTriangle, geometry.triangleCount, 3);
        add(shared::kRound, geometry.firstRound, geometry.roundCount, 36);
    }
    std::sort(draws_.begin(), draws_.end(), [](const Draw& a, const Draw& b) { return a.shape < b.shape; });
    indices_ = vulkan::deviceArray<std::uint32_t>(context_, indices, "the preview");
    launch_.indices = indices_.address();
}

void PreviewPass::createPipelines(const vulkan::PipelineCache& cache) {
    const VkDevice device = context_.device();
    const VkDescriptorSetLayoutBinding binding{kConstantsBinding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, kStages,
                                               nullptr};
    const std::array bindings{
        binding, VkDescriptorSetLayoutBinding{shared::kPreviewDrawnBinding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1,
                                              VK_SHADER_STAGE_COMPUTE_BIT, nullptr}};
    bindings_ = vulkan::DescriptorSet(device, bindings, kWhat);
    bindings_.write(kConstantsBinding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, constants_.get());
    layout_ = vulkan::makePipelineLayout(device, {kStages, 0, sizeof launch_}, bindings_.layout(), kWhat);

    for (const Draw& draw : draws_) {
        if (!drawing_[draw.shape]) drawing_[draw.shape] = createDrawing(cache, draw.shape);
    }
    const Specialization constants{features_, 0};
    const VkSpecializationInfo specialization = constants.info();
    const auto module = vulkan::makeShaderModule(device, shaderCode(Shader::PreviewFinish), specialization);
    finishing_ = vulkan::makeComputePipeline(device, cache.get(), layout_.get(), module.get(), &specialization, kWhat);
}

vulkan::Handle<VkPipeline> PreviewPass::createDrawing(const vulkan::PipelineCache& cache, std::uint32_t shape) {
    const VkDevice device = context_.device();
    const Specialization constants{features_, shape};
    const VkSpecializationInfo specialization = constants.info();
    const auto vertex = vulkan::makeShaderModule(device, shaderCode(Shader::PreviewVertex), specialization);
    const auto fragment = vulkan::makeShaderModule(device, shaderCode(Shader::PreviewFragment), specialization);
    const std::array stages{vulkan::shaderStage(VK_SHADER_STAGE_VERTEX_BIT, vertex.get(), &specialization),
                            vulkan::shaderStage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment.get(), &specialization)};
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_GREATER; // near over distance: floats are fine where it is small
    vulkan::Rasterization rasterization;
    // Of a box around a sphere, disk or cylinder the far faces are drawn: they are there when the camera is in it, too.
    const bool isInBox = shape == shared::kSphere || shape == shared::kRound;
    rasterization.cull = isInBox ? VK_CULL_MODE_FRONT_BIT : VK_CULL_MODE_NONE;
    rasterization.depth = &depth;
    rasterization.samples = kPreviewSampleBit;
    // Outlines that fragments find, and not the edges of primitives.
    rasterization.shadesSamples = isInBox || shared::has(features_, shared::kFeatureOpacity);
    return vulkan::makeGraphicsPipeline(device, cache.get(), layout_.get(), clearing_.get(), stages, rasterization,
                                        kWhat);
}

// ---- drawing -------------------------------------------------------------------------------------------------------

// From the camera's record: what of a point's position is along `across`, `down` and towards the plane of focus.
void PreviewPass::uploadConstants(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) {
    shared::RenderConstants constants{};
    constants.arrays = scene_.arrays();
    constants.globals = scene_.compiled().globals;
    constants.params.width = width;
    constants.params.height = height;
    constants.camera = scene::makeCamera(camera, width, height, scene_.compiled().origin);
    vulkan::upload(context_, constants_, std::as_bytes(std::span(&constants, 1)));

    const shared::Camera& c = constants.camera;
    // Rows of the inverse, from its transpose.
    const glm::dmat3 rows = glm::transpose(glm::inverse(glm::dmat3(c.across, c.down, c.corner)));
    const auto row = [&](const glm::dvec3& r) { return shared::vec4(r, -glm::dot(r, glm::dvec3(c.origin))); };
    launch_.clipX = row(2.0 * rows[0] - rows[2]);
    launch_.clipY = row(2.0 * rows[1] - rows[2]);
    launch_.clipW = row(rows[2]);
}

void PreviewPass::bind(VkCommandBuffer commands, VkPipelineBindPoint point, VkPipeline pipeline) const {
    vkCmdBindPipeline(commands, point, pipeline);
    vkCmdBindDescriptorSets(commands, point, layout_.get(), 0, 1, &bindings_.get(), 0, nullptr);
}

// Of a draw's vertices, one instance after the other, `most` or so from `done` on; returns how many.
std::uint64_t PreviewPass::recordDraw(VkCommandBuffer commands, const Draw& draw, std::uint64_t done,
                                      std::uint64_t maximum) const {
    const auto instance = static_cast<std::uint32_t>(done / draw.vertexCount);
    const auto vertex = static_cast<std::uint32_t>(done % draw.vertexCount);
    if (vertex == 0 && maximum >= draw.vertexCount) {
        const std::uint64_t count = std::min<std::uint64_t>(draw.instanceCount - instance, maximum / draw.vertexCount);
        vkCmdDraw(commands, draw.vertexCount, static_cast<std::uint32_t>(count), draw.firstVertex,
                  draw.firstInstance + instance);
        return count * draw.vertexCount;
    }
    const std::uint64_t whole = std::max<std::uint64_t>(1, maximum / kWhole) * kWhole;
    const std::uint64_t count = std::min<std::uint64_t>(draw.vertexCount - vertex, whole);
    vkCmdDraw(commands, static_cast<std::uint32_t>(count), 1, draw.firstVertex + vertex, draw.firstInstance + instance);
    return count;
}

void PreviewPass::drawBand(const Band& band) {
    std::size_t next = 0;   // the draw that is next
    std::uint64_t done = 0; // of its vertices
    VkRenderPass renderPass = clearing_.get();
    do {
        const std::uint64_t maximum = vertices_.suggest();
        std::uint64_t recorded = 0;
        const double seconds = context_.runTimed([&](VkCommandBuffer commands) {
            target_.begin(commands, renderPass, band);
            vkCmdPushConstants(commands, layout_.get(), kStages, 0, sizeof launch_, &launch_);
            VkPipeline bound = VK_NULL_HANDLE;
            while (next < draws_.size() && recorded < maximum) {
                const Draw& draw = draws_[next];
                const VkPipeline pipeline = drawing_[draw.shape].get();
                if (pipeline != bound) bind(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
                bound = pipeline;
                const std::uint64_t count = recordDraw(commands, draw, done, maximum - recorded);
                recorded += count;
                done += count;
                if (done < std::uint64_t{draw.vertexCount} * draw.instanceCount) continue;
                done = 0;
                ++next;
            }
            vkCmdEndRenderPass(commands);
        });
        vertices_.measured(recorded, seconds);
        renderPass = goingOn_.get();
    } while (next < draws_.size());
}

void PreviewPass::finishBand(const Band& band) {
    const std::uint32_t width = target_.extent().width;
    context_.run([&](VkCommandBuffer commands) {
        bind(commands, VK_PIPELINE_BIND_POINT_COMPUTE, finishing_.get());
        vkCmdPushConstants(commands, layout_.get(), kStages, 0, sizeof launch_, &launch_);
        vkCmdDispatch(commands, (band.count * width + kGroup - 1) / kGroup, 1, 1);
        vulkan::barrier(commands, vulkan::kComputeWrite, vulkan::kTransferRead | vulkan::kTransferWrite);
    });
}

app::Preview PreviewPass::render(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) {
    if (target_.extent().width != width || target_.extent().height != height) {
        target_ = {};
        target_ = PreviewTarget(context_, clearing_.get(), {width, height}, std::max(1u, kBandPixels / width));
        bindings_.write(shared::kPreviewDrawnBinding, target_.drawn());
        launch_.pixels = target_.pixels().address();
    }
    uploadConstants(camera, width, height);
    for (Band band{0, target_.bandRows()}; band.first < height; band.first += band.count) {
        band.count = std::min(band.count, height - band.first);
        launch_.firstRow = band.first;
        launch_.rowCount = band.count;
        drawBand(band);
        finishBand(band);
    }
    std::vector<float> pixels(std::size_t{4} * width * height);
    vulkan::download(context_, target_.pixels(), std::as_writable_bytes(std::span(pixels)));
    app::Preview preview{image::Image(width, height, 3), image::Image(width, height, 1)};
    for (std::size_t i = 0; i < preview.depth.data.size(); ++i) {
        std::copy_n(&pixels[4 * i], 3, &preview.picture.data[3 * i]);
        preview.depth.data[i] = pixels[4 * i + 3];
    }
    return preview;
}

} // namespace rt::gpu
