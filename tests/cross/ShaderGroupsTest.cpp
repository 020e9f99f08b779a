// Of a ray tracing pipeline exist only the shader groups that a scene needs: counted in what the driver is asked to
// make.
#include <cstdint>
#include <ostream>
#include <span>
#include <utility>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Shared/Base/Features.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

struct Groups {
    std::uint32_t triangles = 0;  // hits of meshes, and of quads, which are two triangles
    std::uint32_t procedural = 0; // hits of spheres
    bool operator==(const Groups&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Groups& groups) {
    return out << groups.triangles << " of triangles, " << groups.procedural << " procedural";
}

// While it lives, it stands between the engine and the driver, which gets nothing to compile.
class MadeGroups {
  public:
    explicit MadeGroups(vulkan::VulkanContext& context)
        // The context itself is no constant: what it loaded may be replaced.
        : functions_(const_cast<vulkan::RayTracingFunctions&>(context.rayTracing())),
          driver_(std::exchange(functions_.createPipelines, &MadeGroups::create)) {
        current_ = this;
    }
    ~MadeGroups() {
        functions_.createPipelines = driver_;
        current_ = nullptr;
    }
    MadeGroups(const MadeGroups&) = delete;
    MadeGroups& operator=(const MadeGroups&) = delete;

    // Of the pipeline that was made last.
    const Groups& last() const { return last_; }

  private:
    static VKAPI_ATTR VkResult VKAPI_CALL create(VkDevice, VkDeferredOperationKHR, VkPipelineCache, std::uint32_t,
                                                 const VkRayTracingPipelineCreateInfoKHR* infos,
                                                 const VkAllocationCallbacks*, VkPipeline*) {
        Groups& groups = current_->last_ = {};
        for (const VkRayTracingShaderGroupCreateInfoKHR& g : std::span(infos->pGroups, infos->groupCount)) {
            groups.triangles += g.type == VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
            groups.procedural += g.type == VK_RAY_TRACING_SHADER_GROUP_TYPE_PROCEDURAL_HIT_GROUP_KHR;
        }
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    }

    static inline MadeGroups* current_ = nullptr;
    vulkan::RayTracingFunctions& functions_;
    const PFN_vkCreateRayTracingPipelinesKHR driver_;
    Groups last_;
};

Groups groupsFor(const char* id, const app::RenderSettings& settings) {
    const auto scene = app::compile(app::loadScene(id), true);
    const auto engine = gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = app::GpuEngineKind::Pipeline});
    engine->setScene(scene, nullptr);
    const MadeGroups made(device());
    EXPECT_THROW(engine->reset(scene->camera, settings), RenderError);
    return made.last();
}

app::RenderSettings tiny() {
    app::RenderSettings settings;
    settings.width = settings.height = 8;
    settings.spp = 1;
    return settings;
}

TEST(ShaderGroupsTest, AreThoseOfTheShapesInTheScene) {
    app::RenderSettings settings = tiny();
    EXPECT_EQ(groupsFor("one-weekend-final", settings), (Groups{0, 1}));
    EXPECT_EQ(groupsFor("next-week-quads", settings), (Groups{1, 0}));
    EXPECT_EQ(groupsFor("cornell-box-lights", settings), (Groups{1, 1}));
    settings.features = shared::kFeatureAll;
    EXPECT_EQ(groupsFor("next-week-quads", settings), (Groups{2, 2})); // of spheres, and of disks with cylinders
}

} // namespace
} // namespace rt::test
