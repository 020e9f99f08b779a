// A pipeline that tests make again, of the same shaders and constants, is compiled once in a process. Mesa's software
// driver takes seconds for one and remembers nothing, as drivers of devices do. Engines are as new as ever: they create
// and destroy their pipelines, and only the compiler is left out.
#pragma once
#include "Common/Vulkan/VulkanContext.h"

namespace rt::test {

// A context, one at a time, whose pipelines are shared.
class SharingContext : public vulkan::VulkanContext {
  public:
    explicit SharingContext(const vulkan::ContextOptions& options);
    ~SharingContext() override;
};

} // namespace rt::test
