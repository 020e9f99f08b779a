#include "RayTracingGPU/EmbeddedShaders.h"

namespace {

using std::uint32_t; // the generated headers say uint32_t

#include <rt-gpu.shaders.h>

} // namespace

namespace rt::gpu {

std::span<const std::uint32_t> shaderCode(Shader shader) {
    switch (shader) {
#define RT_SHADER_CODE(name, array) \
    case Shader::name:              \
        return array;
        RT_GPU_SHADERS(RT_SHADER_CODE)
#undef RT_SHADER_CODE
    }
    return {};
}

} // namespace rt::gpu
