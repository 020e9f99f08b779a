// Values of accessors, whatever their component type, stride, normalisation and sparse changes. The file has been
// checked, so that all bytes exist; types that do not fit and values that are not finite are InputErrors.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "Common/Scene/Gltf/GltfFile.h"

namespace rt::scene {

std::size_t accessorCount(const GltfFile& file, int accessor);

std::size_t sparseCount(const GltfFile& file, int accessor); // of elements that are changed apart

// Of an accessor of VEC N, within +-kLargest (JsonNode.h). With `elements`, ascending, those alone.
template <int N>
std::vector<glm::vec<N, double>> readVectors(const GltfFile& file, int accessor,
                                             const std::vector<std::uint32_t>* elements = nullptr);

// Of SCALAR and of MAT4, within the bounds and of the elements that readVectors() takes.
std::vector<double> readNumbers(const GltfFile& file, int accessor, const std::vector<std::uint32_t>* elements);
std::vector<glm::dmat4> readMatrices(const GltfFile& file, int accessor, const std::vector<std::uint32_t>* elements);

// A colour of three or four components; the fourth of three is 1.
std::vector<glm::dvec4> readColors(const GltfFile& file, int accessor, const std::vector<std::uint32_t>* elements);

// Of an accessor of unsigned integers.
std::vector<std::uint32_t> readIndices(const GltfFile& file, int accessor);

} // namespace rt::scene
