#include "Common/Scene/Gltf/GltfMeshopt.h"

#include <cstdint>
#include <string>
#include <vector>

#include "Common/Scene/Gltf/GltfValues.h"

#ifdef RT_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace rt::scene {

bool knowsMeshopt() {
#ifdef RT_HAS_MESHOPTIMIZER
    return true;
#else
    return false;
#endif
}

void checkMeshopt(const JsonNode& extension, std::uint64_t viewBytes) {
    const auto wholeAt = [&](const char* key) {
        const JsonNode node = extension.at(key);
        if (!node.value().is_number_unsigned()) node.failValue("a whole number that is not negative");
        return node.value().get<std::uint64_t>();
    };
    const std::uint64_t stride = wholeAt("byteStride"), count = wholeAt("count");
    const std::string mode = extension.at("mode").oneOf({"ATTRIBUTES", "TRIANGLES", "INDICES"});
    if (mode == "ATTRIBUTES" && (stride == 0 || stride > 256 || stride % 4 != 0))
        extension.at("byteStride").failValue("a multiple of 4 up to 256");
    if (mode != "ATTRIBUTES" && stride != 2 && stride != 4) extension.at("byteStride").failValue("2 or 4");
    if (mode == "TRIANGLES" && count % 3 != 0) extension.at("count").failValue("a multiple of 3");
    if (count > viewBytes || count * stride != viewBytes)
        extension.at("count").failValue("the bytes of the view over byteStride");
    const auto filter = extension.find("filter");
    if (!filter) return;
    const std::string name = filter->oneOf({"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"});
    if (name != "NONE" && mode != "ATTRIBUTES") filter->failValue("NONE for indices");
    if (name == "OCTAHEDRAL" && stride != 4 && stride != 8) extension.at("byteStride").failValue("4 or 8");
    if (name == "QUATERNION" && stride != 8) extension.at("byteStride").failValue("8");
}

#ifdef RT_HAS_MESHOPTIMIZER

namespace {

constexpr const char* kMeshopt = "EXT_meshopt_compression";

std::size_t sizeOf(const tinygltf::Value& object, const char* key) {
    return static_cast<std::size_t>(numberOf(object, key, 0));
}

std::string stringOf(const tinygltf::Value& object, const char* key) {
    return object.Has(key) ? object.Get(key).Get<std::string>() : std::string();
}

// False where the data are damaged.
bool decodeView(const tinygltf::Value& extension, std::span<const std::byte> from, std::vector<std::byte>& to) {
    const std::size_t count = sizeOf(extension, "count"), stride = sizeOf(extension, "byteStride");
    const auto* bytes = reinterpret_cast<const unsigned char*>(from.data());
    const std::string mode = stringOf(extension, "mode"), filter = stringOf(extension, "filter");
    using Decoder = int (*)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
    Decoder decoder = meshopt_decodeVertexBuffer;
    if (mode == "TRIANGLES") decoder = meshopt_decodeIndexBuffer;
    if (mode == "INDICES") decoder = meshopt_decodeIndexSequence;
    if (decoder(to.data(), count, stride, bytes, from.size()) != 0) return false;
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(to.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(to.data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(to.data(), count, stride);
    return true;
}

} // namespace

void decodeMeshopt(GltfFile& file, GltfBudget& budget) {
    for (std::size_t i = 0; i < file.model.bufferViews.size(); ++i) {
        const tinygltf::BufferView& view = file.model.bufferViews[i];
        const auto found = view.extensions.find(kMeshopt);
        if (found == view.extensions.end()) continue;
        const std::string place = "/bufferViews/" + std::to_string(i) + "/extensions/" + kMeshopt;
        const auto& buffer = file.buffers[sizeOf(found->second, "buffer")];
        const std::size_t offset = sizeOf(found->second, "byteOffset"), length = sizeOf(found->second, "byteLength");
        if (offset + length > buffer.bytes.size()) file.fail(place, "its buffer does not hold it");
        budget.spend(view.byteLength / 4, place);
        std::vector<std::byte> bytes(view.byteLength);
        if (!bytes.empty() && !decodeView(found->second, buffer.bytes.subspan(offset, length), bytes))
            file.fail(place, "its data are damaged");
        file.decoded[static_cast<int>(i)] = std::move(bytes);
    }
}

#else

void decodeMeshopt(GltfFile&, GltfBudget&) {}

#endif

} // namespace rt::scene
