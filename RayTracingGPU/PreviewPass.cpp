#include "RayTracingGPU/PreviewPass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "Common/Scene/CameraRecord.h"
#include "Common/Shared/Features.h"
#include "Common/Vulkan/Check.h"
#include "RayTracingGPU/Kernel.h"

namespace rt::gpu {
namespace {

using shared::vec3;
using vulkan::check;

constexpr const char* kWhat = "Preparing the preview";
constexpr std::uint32_t kConstantsBinding = 1; // as in Bindings.glsl
constexpr std::uint32_t kGroup = 64;           // as in Preview.comp
constexpr std::uint32_t kShapeConstant = 14;   // as in Preview.glsl
constexpr std::uint32_t kMostLights = 16;      // whose light is added up for each pixel
constexpr float kNear = 1e-4f;                 // of the distance of focus: nearer surfaces are cut
constexpr float kLeastAmbient = 0.05f;         // so that nothing is wholly dark
constexpr VkShaderStageFlags kStages =
    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

// What the preview leaves out: the lens, and motion over the shutter.
std::uint32_t previewFeatures(std::uint32_t features) {
    return features & ~(shared::kFeatureThinLens | shared::kFeatureMovingSpheres | shared::kFeatureMotion);
}

// The lights of a scene that send out most, but for the sky, which is everywhere.
std::vector<std::uint32_t> strongestLights(const scene::CompiledScene& scene) {
    std::vector<std::uint32_t> lights(scene.globals.lightCount);
    std::iota(lights.begin(), lights.end(), 0u);
    std::erase_if(lights, [&](std::uint32_t i) { return scene.lights[i].kind == shared::kLightSky; });
    const auto count = std::min<std::size_t>(lights.size(), kMostLights);
    const auto stronger = [&](std::uint32_t a, std::uint32_t b) {
        return scene.lights[a].selection > scene.lights[b].selection;
    };
    std::partial_sort(lights.begin(), lights.begin() + static_cast<std::ptrdiff_t>(count), lights.end(), stronger);
    lights.resize(count);
    return lights;
}

// Radiance of white surfaces, were the light of all lamps spread evenly over a sphere of the scene's size whose wall absorbs
// half of what arrives.
vec3 ambientOf(const scene::CompiledScene& scene) {
    const double radius = scene.globals.sceneRadius;
    glm::dvec3 sum(0);
    for (std::uint32_t i = 0; i < scene.globals.lightCount; ++i) {
        const shared::Light& light = scene.lights[i];
        if (light.kind == shared::kLightSky) continue;
        const bool bothSides = light.kind != shared::kLightSphere && light.sides == shared::kSidesBoth;
        sum += glm::dvec3(light.emission) * static_cast<double>(light.area) * (bothSides ? 2.0 : 1.0);
    }
    if (radius > 0) sum /= 0.5 * 4 * 3.14159265358979 * radius * radius;
    return glm::max(vec3(sum), vec3(kLeastAmbient));
}

VkPipelineShaderStageCreateInfo stageInfo(VkShaderStageFlagBits stage, VkShaderModule module,
                                          const VkSpecializationInfo& constants) {
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = stage;
    info.module = module;
    info.pName = "main";
    info.pSpecializationInfo = &constants;
    return info;
}

// The specialisation constants of Preview.glsl.
struct Specialization {
    std::uint32_t values[2]; // features, shape
    VkSpecializationMapEntry entries[2] = {{0, 0, 4}, {kShapeConstant, 4, 4}};
    VkSpecializationInfo info() const { return {2, entries, sizeof values, values}; }
};

} // namespace

PreviewPass::PreviewPass(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, const GpuScene& scene)
    : context_(context),
      scene_(scene),
      features_(previewFeatures(scene.compiled().features)),
      constants_(context, sizeof(shared::RenderConstants), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, vulkan::Memory::Device,
                 "constants"),
      renderPass_(makePreviewRenderPass(context.device())) {
    if (!context.info().draws) throw RenderError(context.info().name + " cannot draw: there is no preview");
    listDraws();
    createBindings();
    createPipelines(cache);
}

// ---- set-up ----------------------------------------------------------------------------------------------------------

void PreviewPass::listDraws() {
    const scene::CompiledScene& s = scene_.compiled();
    std::vector<std::uint32_t> indices = strongestLights(s);
    launch_.lightCount = static_cast<std::uint32_t>(indices.size());
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
    }
    std::sort(draws_.begin(), draws_.end(), [](const Draw& a, const Draw& b) { return a.shape < b.shape; });
    indices_ = vulkan::deviceArray<std::uint32_t>(context_, indices, "the preview");
    launch_.indices = indices_.address();
}

void PreviewPass::createBindings() {
    const VkDevice device = context_.device();
    const VkDescriptorSetLayoutBinding binding{kConstantsBinding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, kStages,
                                               nullptr};
    VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    setInfo.bindingCount = 1;
    setInfo.pBindings = &binding;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device, &setInfo, nullptr, &setLayout), kWhat);
    setLayout_ = {device, setLayout, vkDestroyDescriptorSetLayout};

    const VkPushConstantRange push{kStages, 0, sizeof launch_};
    VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &setLayout;
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &push;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device, &layoutInfo, nullptr, &layout), kWhat);
    layout_ = {device, layout, vkDestroyPipelineLayout};

    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1};
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device, &poolInfo, nullptr, &pool), kWhat);
    pool_ = {device, pool, vkDestroyDescriptorPool};
    VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocation.descriptorPool = pool;
    allocation.descriptorSetCount = 1;
    allocation.pSetLayouts = &setLayout;
    check(vkAllocateDescriptorSets(device, &allocation, &set_), kWhat);

    const VkDescriptorBufferInfo buffer{constants_.get(), 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set_;
    write.dstBinding = kConstantsBinding;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    write.pBufferInfo = &buffer;
    vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
}

void PreviewPass::createPipelines(const vulkan::PipelineCache& cache) {
    for (const Draw& draw : draws_) {
        if (!drawing_[draw.shape]) drawing_[draw.shape] = createDrawing(cache, draw.shape);
    }
    const Specialization constants{{features_, 0}};
    const VkSpecializationInfo specialization = constants.info();
    const vulkan::Handle<VkShaderModule> module = makeShaderModule(context_.device(), Shader::PreviewFinish);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = stageInfo(VK_SHADER_STAGE_COMPUTE_BIT, module.get(), specialization);
    info.layout = layout_.get();
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(context_.device(), cache.get(), 1, &info, nullptr, &pipeline), kWhat);
    finishing_ = {context_.device(), pipeline, vkDestroyPipeline};
}

vulkan::Handle<VkPipeline> PreviewPass::createDrawing(const vulkan::PipelineCache& cache, std::uint32_t shape) {
    const VkDevice device = context_.device();
    const Specialization constants{{features_, shape}};
    const VkSpecializationInfo specialization = constants.info();
    const vulkan::Handle<VkShaderModule> vertex = makeShaderModule(device, Shader::PreviewVertex);
    const vulkan::Handle<VkShaderModule> fragment = makeShaderModule(device, Shader::PreviewFragment);
    const std::array<VkPipelineShaderStageCreateInfo, 2> stages{
        stageInfo(VK_SHADER_STAGE_VERTEX_BIT, vertex.get(), specialization),
        stageInfo(VK_SHADER_STAGE_FRAGMENT_BIT, fragment.get(), specialization)};

    const VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    // Of a cube around a sphere the far faces are drawn: they are there when the camera is in the cube, too.
    raster.cullMode = shape == shared::kSphere ? VK_CULL_MODE_FRONT_BIT : VK_CULL_MODE_NONE;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_GREATER; // near over distance: floats are fine where it is small
    VkPipelineColorBlendAttachmentState all{};
    all.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &all;
    const std::array<VkDynamicState, 2> states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = static_cast<std::uint32_t>(states.size());
    dynamic.pDynamicStates = states.data();

    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = layout_.get();
    info.renderPass = renderPass_.get();
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(device, cache.get(), 1, &info, nullptr, &pipeline), kWhat);
    return {device, pipeline, vkDestroyPipeline};
}

// ---- drawing ---------------------------------------------------------------------------------------------------------

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

void PreviewPass::record(VkCommandBuffer commands) {
    const auto bind = [&](VkPipelineBindPoint point, VkPipeline pipeline) {
        vkCmdBindPipeline(commands, point, pipeline);
        vkCmdBindDescriptorSets(commands, point, layout_.get(), 0, 1, &set_, 0, nullptr);
    };
    vkCmdPushConstants(commands, layout_.get(), kStages, 0, sizeof launch_, &launch_);
    target_.begin(commands, renderPass_.get());
    VkPipeline bound = VK_NULL_HANDLE;
    for (const Draw& draw : draws_) {
        const VkPipeline pipeline = drawing_[draw.shape].get();
        if (pipeline != bound) bind(VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        bound = pipeline;
        vkCmdDraw(commands, draw.vertexCount, draw.instanceCount, draw.firstVertex, draw.firstInstance);
    }
    target_.end(commands);
    vulkan::barrier(commands);
    bind(VK_PIPELINE_BIND_POINT_COMPUTE, finishing_.get());
    const std::uint32_t pixels = target_.extent().width * target_.extent().height;
    vkCmdDispatch(commands, (pixels + kGroup - 1) / kGroup, 1, 1);
    vulkan::barrier(commands);
}

app::Preview PreviewPass::render(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) {
    if (target_.extent().width != width || target_.extent().height != height) {
        target_ = {};
        target_ = PreviewTarget(context_, renderPass_.get(), {width, height});
        launch_.pixels = target_.pixels().address();
    }
    uploadConstants(camera, width, height);
    context_.run([this](VkCommandBuffer commands) { record(commands); });
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
