#include "Common/Scene/Gltf/GltfAccessor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include <glm/common.hpp>

#include "Common/Core/SystemMemory.h"
#include "Common/Scene/Gltf/GltfComponents.h"
#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

namespace {

const tinygltf::Accessor& at(const GltfFile& file, int accessor) {
    return file.model.accessors[static_cast<std::size_t>(accessor)];
}

[[noreturn]] void fail(const GltfFile& file, int accessor, const std::string& message) {
    file.fail("/accessors/" + std::to_string(accessor), message);
}

// Of values in a buffer; bytes empty: all are zero.
struct Source {
    std::span<const std::byte> bytes;
    std::size_t stride = 0;
};

template <typename T>
T load(const std::byte* bytes) {
    T value; // not aligned in files
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// 3.6.2.2 of the specification of glTF 2.0.
template <typename T>
double decoded(T value, bool isNormalized) {
    if constexpr (std::is_floating_point_v<T>) return double(value);
    if (!isNormalized) return double(value);
    return std::max(double(value) / double(std::numeric_limits<T>::max()), -1.0);
}

Source baseOf(const GltfFile& file, const tinygltf::Accessor& accessor, std::size_t elementBytes) {
    if (accessor.bufferView < 0) return {};
    const std::size_t stride = file.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    return {file.view(accessor.bufferView).subspan(accessor.byteOffset), stride == 0 ? elementBytes : stride};
}

std::vector<std::uint32_t> sparseIndices(const GltfFile& file, int index) {
    const tinygltf::Accessor& accessor = at(file, index);
    const auto& sparse = accessor.sparse;
    std::vector<std::uint32_t> indices(static_cast<std::size_t>(sparse.count));
    withComponentType(sparse.indices.componentType, [&](auto component) {
        using T = decltype(component);
        if constexpr (std::is_unsigned_v<T>) { // GltfCheck refuses others
            const std::size_t stride =
                file.model.bufferViews[static_cast<std::size_t>(sparse.indices.bufferView)].byteStride;
            const std::byte* from =
                file.view(sparse.indices.bufferView).data() + static_cast<std::size_t>(sparse.indices.byteOffset);
            for (std::size_t i = 0; i < indices.size(); ++i)
                indices[i] = load<T>(from + i * (stride == 0 ? sizeof(T) : stride));
        }
    });
    for (const std::uint32_t i : indices)
        if (i >= accessor.count)
            fail(file, index, "sparse: index " + std::to_string(i) + " of " + std::to_string(accessor.count));
    return indices;
}

constexpr int typeOf(int components) {
    return components == 1 ? TINYGLTF_TYPE_SCALAR : components == 16 ? TINYGLTF_TYPE_MAT4 : components;
}

const char* nameOf(int components) {
    constexpr std::array kNames = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    return components == 16 ? "MAT4" : kNames[static_cast<std::size_t>(components - 1)];
}

// Calls put(i, component, value) for each value of N components that the accessor's sparse part changes. `elements`:
// those which count, ascending; i is the place among them.
template <int N, typename T, typename Function>
void forEachSparse(const GltfFile& file, int index, const std::vector<std::uint32_t>* elements, const Function& put) {
    const tinygltf::Accessor& accessor = at(file, index);
    if (!accessor.sparse.isSparse) return;
    const std::vector<std::uint32_t> changed = sparseIndices(file, index);
    const auto view = static_cast<std::size_t>(accessor.sparse.values.bufferView);
    const std::size_t stated = file.model.bufferViews[view].byteStride;
    const std::size_t stride = stated == 0 ? N * sizeof(T) : stated;
    const std::byte* from = file.view(accessor.sparse.values.bufferView).data() +
                            static_cast<std::size_t>(accessor.sparse.values.byteOffset);
    for (std::size_t i = 0; i < changed.size(); ++i) {
        std::size_t place = changed[i];
        if (elements) {
            const auto found = std::lower_bound(elements->begin(), elements->end(), changed[i]);
            if (found == elements->end() || *found != changed[i]) continue;
            place = static_cast<std::size_t>(found - elements->begin());
        }
        for (int c = 0; c < N; ++c) put(place, c, load<T>(from + i * stride + static_cast<std::size_t>(c) * sizeof(T)));
    }
}

// Of one, two, three, four or, a matrix by columns, sixteen components.
template <int N, typename Element>
std::vector<Element> readElements(const GltfFile& file, int index, const std::vector<std::uint32_t>* elements) {
    const tinygltf::Accessor& accessor = at(file, index);
    if (accessor.type != typeOf(N)) fail(file, index, std::string("type: must be ") + nameOf(N));
    if (accessor.count == 0) fail(file, index, "count: 0: must be at least 1, as it is read");
    std::vector<Element> values;
    resizeLarge(values, elements ? elements->size() : accessor.count, Element(0));
    const auto component = [](Element& element, int c) -> double& {
        if constexpr (N == 1)
            return static_cast<void>(c), element;
        else if constexpr (N == 16)
            return element[c / 4][c % 4];
        else
            return element[c];
    };
    withComponentType(accessor.componentType, [&](auto type) {
        using T = decltype(type);
        const Source base = baseOf(file, accessor, N * sizeof(T));
        if (!base.bytes.empty())
            for (std::size_t i = 0; i < values.size(); ++i) {
                const std::byte* from = base.bytes.data() + base.stride * (elements ? (*elements)[i] : i);
                for (int c = 0; c < N; ++c)
                    component(values[i], c) =
                        decoded(load<T>(from + static_cast<std::size_t>(c) * sizeof(T)), accessor.normalized);
            }
        forEachSparse<N, T>(file, index, elements, [&](std::size_t i, int c, T value) {
            component(values[i], c) = decoded(value, accessor.normalized);
        });
    });
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int c = 0; c < N; ++c)
            if (!(std::abs(component(values[i], c)) <= kLargest))
                fail(file, index, "element " + std::to_string(i) + ": must be numbers from -1e9 to 1e9");
    return values;
}

} // namespace

std::size_t accessorCount(const GltfFile& file, int accessor) {
    return at(file, accessor).count;
}

std::size_t sparseCount(const GltfFile& file, int accessor) {
    const auto& sparse = at(file, accessor).sparse;
    return sparse.isSparse ? static_cast<std::size_t>(sparse.count) : 0;
}

template <int N>
std::vector<glm::vec<N, double>> readVectors(const GltfFile& file, int accessor,
                                             const std::vector<std::uint32_t>* elements) {
    return readElements<N, glm::vec<N, double>>(file, accessor, elements);
}

template std::vector<glm::dvec2> readVectors<2>(const GltfFile&, int, const std::vector<std::uint32_t>*);
template std::vector<glm::dvec3> readVectors<3>(const GltfFile&, int, const std::vector<std::uint32_t>*);
template std::vector<glm::dvec4> readVectors<4>(const GltfFile&, int, const std::vector<std::uint32_t>*);

std::vector<double> readNumbers(const GltfFile& file, int accessor, const std::vector<std::uint32_t>* elements) {
    return readElements<1, double>(file, accessor, elements);
}

std::vector<glm::dmat4> readMatrices(const GltfFile& file, int accessor, const std::vector<std::uint32_t>* elements) {
    return readElements<16, glm::dmat4>(file, accessor, elements);
}

std::vector<glm::dvec4> readColors(const GltfFile& file, int accessor, const std::vector<std::uint32_t>* elements) {
    std::vector<glm::dvec4> colors;
    if (at(file, accessor).type == TINYGLTF_TYPE_VEC3)
        for (const glm::dvec3& rgb : readVectors<3>(file, accessor, elements)) colors.emplace_back(rgb, 1);
    else
        colors = readVectors<4>(file, accessor, elements);
    for (glm::dvec4& color : colors) color = glm::clamp(color, 0.0, 1.0);
    return colors;
}

std::vector<std::uint32_t> readIndices(const GltfFile& file, int index) {
    const tinygltf::Accessor& accessor = at(file, index);
    if (accessor.type != TINYGLTF_TYPE_SCALAR) fail(file, index, "type: must be SCALAR");
    std::vector<std::uint32_t> values;
    resizeLarge(values, accessor.count);
    withComponentType(accessor.componentType, [&](auto component) {
        using T = decltype(component);
        if constexpr (!std::is_unsigned_v<T>)
            fail(file, index, "componentType: must be 5121, 5123 or 5125");
        else {
            const Source base = baseOf(file, accessor, sizeof(T));
            if (!base.bytes.empty())
                for (std::size_t i = 0; i < values.size(); ++i)
                    values[i] = load<T>(base.bytes.data() + base.stride * i);
            forEachSparse<1, T>(file, index, nullptr, [&](std::size_t i, int, T value) { values[i] = value; });
        }
    });
    return values;
}

} // namespace rt::scene
