// Removes from a shader what its specialization constants rule out, before a driver sees it: drivers inline all
// functions, and take most of their time for that, before they fold the constants.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <vulkan/vulkan.h>

namespace rt::vulkan {

// A SPIR-V module that does the same as `code` where its specialization constants have these values, which must be
// handed to the pipeline all the same. Branches are followed whose conditions are known from the constants alone,
// through boolean expressions, what functions return and variables of one value, but not through parameters; the other
// blocks go, and the functions that are called no longer.
std::vector<std::uint32_t> prunedShader(std::span<const std::uint32_t> code, const VkSpecializationInfo& constants);

} // namespace rt::vulkan
