#include "Common/Scene/Gltf/GltfDraco.h"

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#ifdef RT_HAS_DRACO
#include <draco/compression/config/compression_shared.h>
#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/decoder_buffer.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/geometry_metadata.h>
#include <draco/metadata/metadata_decoder.h>
#endif

#include "Common/Core/Parallel.h"
#include "Common/Core/Printable.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Gltf/GltfComponents.h"

namespace rt::scene {

#ifdef RT_HAS_DRACO

namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";

// A compressed primitive, and what it was decoded to.
struct Compressed {
    tinygltf::Primitive* primitive;
    std::string place;
    std::span<const std::byte> bytes;
    std::vector<std::pair<std::string, std::uint32_t>> attributes; // of the file, by Draco's unique ids
    std::vector<std::byte> indices;                                // of 32 bits
    std::vector<std::vector<std::byte>> values;                    // of each attribute
    std::uint64_t points = 0;
};

// How many elements decoding will make room for: faces and vertices as the data's own head states them, which are
// otherwise bounded by nothing. 0 where the head is damaged, which the decoder will say. Draco's bitstream
// specification, "Header", "Metadata" and "Connectivity".
std::uint64_t statedElements(std::span<const std::byte> bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) return 0;
    buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor));
    if ((header.flags & METADATA_FLAG_MASK) != 0) {
        draco::GeometryMetadata metadata;
        if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) return 0;
    }
    const auto number = [&](int firstOfVarints) {
        std::uint32_t value = 0;
        const bool isRead =
            buffer.bitstream_version() < firstOfVarints ? buffer.Decode(&value) : draco::DecodeVarint(&value, &buffer);
        return isRead ? std::uint64_t{value} : 0;
    };
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        std::uint8_t traversal = 0;
        buffer.Decode(&traversal);
        if (buffer.bitstream_version() < DRACO_BITSTREAM_VERSION(2, 2)) number(DRACO_BITSTREAM_VERSION(2, 0));
        const std::uint64_t vertices = number(DRACO_BITSTREAM_VERSION(2, 0));
        return vertices + 3 * number(DRACO_BITSTREAM_VERSION(2, 0));
    }
    const std::uint64_t faces = number(DRACO_BITSTREAM_VERSION(2, 2));
    return 3 * faces + number(DRACO_BITSTREAM_VERSION(2, 2));
}

template <class T>
bool copyValues(const draco::PointAttribute& from, std::uint32_t points, int width, std::vector<std::byte>& to) {
    const std::size_t size = sizeof(T) * static_cast<std::size_t>(width);
    to.resize(size * points);
    std::vector<T> value(static_cast<std::size_t>(width));
    for (std::uint32_t i = 0; i < points; ++i) {
        if (!from.ConvertValue<T>(from.mapped_index(draco::PointIndex(i)), static_cast<std::int8_t>(width),
                                  value.data()))
            return false;
        std::memcpy(to.data() + size * i, value.data(), size);
    }
    return true;
}

bool copyValues(const draco::PointAttribute& from, std::uint32_t points, const tinygltf::Accessor& as,
                std::vector<std::byte>& to) {
    const int width = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(as.type));
    if (width < 1 || width > 4 || from.num_components() != width) return false;
    return withComponentType(as.componentType,
                             [&](auto type) { return copyValues<decltype(type)>(from, points, width, to); });
}

const tinygltf::Accessor& accessorOf(const GltfFile& file, int index) {
    return file.model.accessors[static_cast<std::size_t>(index)];
}

void decodeOne(const GltfFile& file, Compressed& one) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(one.bytes.data()), one.bytes.size());
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) file.fail(one.place, "its data are damaged: " + printable(decoded.status().error_msg_string()));
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    one.points = mesh->num_points();
    one.indices.resize(std::size_t{3} * mesh->num_faces() * sizeof(std::uint32_t));
    std::byte* to = one.indices.data();
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
        for (const draco::PointIndex& corner : mesh->face(face)) {
            const std::uint32_t point = corner.value();
            std::memcpy(to, &point, sizeof point);
            to += sizeof point;
        }
    for (const auto& [name, id] : one.attributes) {
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(id);
        if (attribute == nullptr) file.fail(one.place + "/attributes/" + name, "there is no attribute of this id");
        const tinygltf::Accessor& as = accessorOf(file, one.primitive->attributes.at(name));
        if (!copyValues(*attribute, mesh->num_points(), as, one.values.emplace_back()))
            file.fail(one.place + "/attributes/" + name, "its values are not those of its accessor's type");
    }
}

int addDecoded(GltfFile& file, std::vector<std::byte> bytes) {
    tinygltf::BufferView view;
    view.byteLength = bytes.size();
    file.model.bufferViews.push_back(view);
    const int index = static_cast<int>(file.model.bufferViews.size()) - 1;
    file.decoded[index] = std::move(bytes);
    return index;
}

int addAccessor(GltfFile& file, tinygltf::Accessor accessor, std::vector<std::byte> bytes) {
    accessor.bufferView = addDecoded(file, std::move(bytes));
    accessor.byteOffset = 0;
    accessor.sparse = {};
    file.model.accessors.push_back(std::move(accessor));
    return static_cast<int>(file.model.accessors.size()) - 1;
}

// As the accessors of the file have it: their counts must be those of the data.
void replace(GltfFile& file, Compressed& one) {
    tinygltf::Primitive& primitive = *one.primitive;
    const auto expect = [&](const std::string& what, std::size_t stated, std::uint64_t found) {
        if (stated != found)
            file.fail(one.place, what + ": its accessor states " + counted(stated, "element", "elements") +
                                     ", the data have " + std::to_string(found));
    };
    const std::uint64_t corners = one.indices.size() / sizeof(std::uint32_t);
    tinygltf::Accessor indices;
    if (primitive.indices >= 0) indices = accessorOf(file, primitive.indices);
    if (primitive.indices >= 0) expect("indices", indices.count, corners);
    indices.type = TINYGLTF_TYPE_SCALAR;
    indices.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    indices.count = corners;
    primitive.indices = addAccessor(file, indices, std::move(one.indices));
    primitive.mode = TINYGLTF_MODE_TRIANGLES; // the data's, strips are decoded to
    for (std::size_t i = 0; i < one.attributes.size(); ++i) {
        int& index = primitive.attributes.at(one.attributes[i].first);
        expect(one.attributes[i].first, accessorOf(file, index).count, one.points);
        index = addAccessor(file, accessorOf(file, index), std::move(one.values[i]));
    }
    primitive.extensions.erase(kDraco);
}

std::vector<Compressed> compressedOf(GltfFile& file) {
    std::vector<Compressed> all;
    for (std::size_t mesh = 0; mesh < file.model.meshes.size(); ++mesh)
        for (std::size_t i = 0; i < file.model.meshes[mesh].primitives.size(); ++i) {
            tinygltf::Primitive& primitive = file.model.meshes[mesh].primitives[i];
            const auto found = primitive.extensions.find(kDraco);
            if (found == primitive.extensions.end()) continue;
            Compressed one{
                &primitive,
                "/meshes/" + std::to_string(mesh) + "/primitives/" + std::to_string(i) + "/extensions/" + kDraco,
                file.view(found->second.Get("bufferView").GetNumberAsInt()),
                {},
                {},
                {}};
            const tinygltf::Value& attributes = found->second.Get("attributes");
            for (const std::string& name : attributes.Keys())
                if (primitive.attributes.count(name) > 0)
                    one.attributes.emplace_back(name,
                                                static_cast<std::uint32_t>(attributes.Get(name).GetNumberAsDouble()));
            all.push_back(std::move(one));
        }
    return all;
}

} // namespace

bool knowsDraco() {
    return true;
}

void decodeDraco(GltfFile& file, GltfBudget& budget) {
    std::vector<Compressed> all = compressedOf(file);
    for (const Compressed& one : all) budget.spend(statedElements(one.bytes), one.place);
    parallelFor(0, all.size(), [&](std::size_t i) { decodeOne(file, all[i]); });
    for (Compressed& one : all) replace(file, one);
}

#else

bool knowsDraco() {
    return false;
}

void decodeDraco(GltfFile&, GltfBudget&) {}

#endif

} // namespace rt::scene
