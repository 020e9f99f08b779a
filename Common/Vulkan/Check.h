// Vulkan's result codes as errors with one clear line.
#pragma once
#include <string>

#include <vulkan/vulkan.h>

#include "Common/Core/Error.h"

namespace rt::vulkan {

// No device, or not the one asked for, can render. Ends a program with ExitCode::NoDevice.
struct NoDeviceError : Error {
    explicit NoDeviceError(const std::string& message) : Error(ExitCode::NoDevice, message) {}
};
// The device stopped answering: nothing that it holds can be read any more.
struct DeviceLostError : RenderError {
    using RenderError::RenderError;
};

std::string resultName(VkResult result);

// Throws unless `result` is a success: DeviceLostError or RenderError, naming what could not be done.
void check(VkResult result, const std::string& what);

} // namespace rt::vulkan
