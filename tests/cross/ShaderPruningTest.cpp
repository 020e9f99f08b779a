// What is left of a shader answers as the whole one does.
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Vulkan/ShaderPruning.h"
#include "PruningProbe.comp.h"
#include "RayTracingGPU/EmbeddedShaders.h"
#include "tests/cross/Probe.h"

namespace rt::test {
namespace {

std::vector<std::uint32_t> pruned(std::span<const std::uint32_t> code, std::uint32_t bits) {
    const VkSpecializationMapEntry entry{0, 0, sizeof bits};
    return vulkan::prunedShader(code, {1, &entry, sizeof bits, &bits});
}

TEST(ShaderPruning, LeavesAnswersAsTheyAreForEveryConstant) {
    constexpr std::uint32_t kInvocations = 256;
    for (std::uint32_t bits = 0; bits < 16; ++bits) {
        const Probe whole{PruningProbe_comp, {bits}, 1, kInvocations, false};
        const Probe less{PruningProbe_comp, {bits}, 1, kInvocations, true};
        EXPECT_EQ(answersOf(less), answersOf(whole)) << "bits " << bits;
        EXPECT_LT(pruned(PruningProbe_comp, bits).size(), std::size(PruningProbe_comp)) << "bits " << bits;
    }
}

TEST(ShaderPruning, KeepsTheWholeWhereNoConstantDecides) {
    const std::span<const std::uint32_t> code = gpu::shaderCode(gpu::Shader::FilmReduce);
    EXPECT_EQ(pruned(code, 0), std::vector(code.begin(), code.end()));
}

TEST(ShaderPruning, TakesWhatHasBeenPrunedAlready) {
    const std::vector<std::uint32_t> once = pruned(PruningProbe_comp, 5);
    EXPECT_EQ(pruned(once, 5), once);
}

// A scene without lights, of spheres alone: most of the shader is for others.
TEST(ShaderPruning, HalvesTheShaderOfPaths) {
    const std::span<const std::uint32_t> code = gpu::shaderCode(gpu::Shader::PathsCompute);
    EXPECT_LT(2 * pruned(code, 1).size(), code.size());
}

} // namespace
} // namespace rt::test
