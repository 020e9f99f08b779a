// glTF whose meshes are compressed: as its twin that is not, and damaged or lying data refused.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#ifdef RT_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif
#ifdef RT_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif

#include "Common/Core/Error.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "tests/TempFolder.h"
#include "tests/unit/GltfBuilder.h"

namespace rt::scene {
namespace {

using nlohmann::json;

// A wavy grid of (n + 1)^2 vertices.
struct Grid {
    explicit Grid(std::uint32_t n) {
        for (std::uint32_t y = 0; y <= n; ++y)
            for (std::uint32_t x = 0; x <= n; ++x) {
                const float u = static_cast<float>(x) / static_cast<float>(n),
                            v = static_cast<float>(y) / static_cast<float>(n);
                positions.insert(positions.end(), {u, v, 0.1f * std::sin(9 * u) * std::cos(7 * v)});
                uvs.insert(uvs.end(), {u, 1 - v});
            }
        for (std::uint32_t y = 0; y < n; ++y)
            for (std::uint32_t x = 0; x < n; ++x) {
                const std::uint32_t a = y * (n + 1) + x, b = a + n + 1;
                indices.insert(indices.end(), {a, a + 1, b + 1, a, b + 1, b});
            }
    }
    std::size_t vertices() const { return positions.size() / 3; }

    std::vector<float> positions, uvs;
    std::vector<std::uint32_t> indices;
};

class GltfCompressed : public testing::Test {
  protected:
    MeshData load(const GltfBuilder& gltf, const char* name) const {
        SceneDesc scene = loadGltfScene(gltf.save(folder / name));
        const ObjectDesc* object = &scene.objects.at(0);
        if (const auto* group = std::get_if<GroupDesc>(&object->shape)) object = &group->objects.at(0);
        return *std::get<Boxed<MeshData>>(std::get<MeshDesc>(object->shape).source);
    }
    MeshData plain(const Grid& grid) const {
        GltfBuilder gltf;
        const json attributes = {{"POSITION", gltf.addAccessor(grid.positions, "VEC3")},
                                 {"TEXCOORD_0", gltf.addAccessor(grid.uvs, "VEC2")}};
        gltf.addNode({{"mesh", gltf.addMesh({{"attributes", attributes},
                                             {"indices", gltf.addAccessor(grid.indices, "SCALAR")}})}});
        return load(gltf, "plain.glb");
    }
    std::string failure(const GltfBuilder& gltf) const {
        try {
            loadGltfScene(gltf.save(folder / "bad.glb"));
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }

    // With bytes of its compressed data changed it is read or refused, and does nothing else.
    void expectToSurvive(const GltfBuilder& gltf, std::size_t seed) const {
        const std::string whole = gltf.binary();
        const std::size_t begin = whole.find("BIN") + 4;
        std::mt19937 random(static_cast<std::uint32_t>(seed));
        for (int i = 0; i < 500; ++i) {
            std::string file = whole;
            for (std::uint32_t left = 1 + random() % 4; left > 0; --left)
                file[begin + random() % (file.size() - begin)] = static_cast<char>(random());
            GltfBuilder::write(folder / "changed.glb", file);
            try {
                loadGltfScene(folder / "changed.glb");
            } catch (const InputError&) {
                continue;
            }
        }
    }

    test::TempFolder folder;
};

#ifdef RT_HAS_MESHOPTIMIZER

class GltfMeshopt : public GltfCompressed {
  protected:
    // A view that only the extension has: its own buffer is one that no file holds.
    static int addCompressed(GltfBuilder& gltf, const std::vector<unsigned char>& data, std::size_t count,
                             std::size_t stride, const char* mode, const char* filter = "NONE") {
        const int holder = gltf.addView(data);
        gltf.json["buffers"][1] = {{"byteLength", std::size_t{1} << 20}};
        const json extension = {{"buffer", 0},
                                {"byteOffset", gltf.json["bufferViews"][holder]["byteOffset"]},
                                {"byteLength", data.size()},
                                {"byteStride", stride},
                                {"count", count},
                                {"mode", mode},
                                {"filter", filter}};
        return gltf.add(
            "bufferViews",
            {{"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", extension}}}});
    }
    static std::vector<unsigned char> encode(const void* values, std::size_t count, std::size_t stride) {
        std::vector<unsigned char> data(meshopt_encodeVertexBufferBound(count, stride));
        data.resize(meshopt_encodeVertexBuffer(data.data(), data.size(), values, count, stride));
        return data;
    }
    static GltfBuilder compressed(const Grid& grid) {
        GltfBuilder gltf;
        gltf.json["extensionsRequired"] = gltf.json["extensionsUsed"] = {"EXT_meshopt_compression"};
        const std::size_t n = grid.vertices();
        const int positions = addCompressed(gltf, encode(grid.positions.data(), n, 12), n, 12, "ATTRIBUTES");
        const int uvs = addCompressed(gltf, encode(grid.uvs.data(), n, 8), n, 8, "ATTRIBUTES");
        std::vector<unsigned char> data(meshopt_encodeIndexBufferBound(grid.indices.size(), n));
        data.resize(meshopt_encodeIndexBuffer(data.data(), data.size(), grid.indices.data(), grid.indices.size()));
        const int indices = addCompressed(gltf, data, grid.indices.size(), 4, "TRIANGLES");
        const json attributes = {{"POSITION", gltf.addAccessor(positions, 5126, "VEC3", n)},
                                 {"TEXCOORD_0", gltf.addAccessor(uvs, 5126, "VEC2", n)}};
        gltf.addNode(
            {{"mesh", gltf.addMesh({{"attributes", attributes},
                                    {"indices", gltf.addAccessor(indices, 5125, "SCALAR", grid.indices.size())}})}});
        return gltf;
    }
};

// Corners of a triangle may have been rotated, which its order on the surface is not.
TEST_F(GltfMeshopt, IsAsItsTwin) {
    const Grid grid(20);
    const MeshData mesh = load(compressed(grid), "a.glb"), twin = plain(grid);
    EXPECT_EQ(mesh.positions, twin.positions);
    EXPECT_EQ(mesh.uvs, twin.uvs);
    ASSERT_EQ(mesh.triangles.size(), twin.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3 t = mesh.triangles[i], w = twin.triangles[i];
        EXPECT_TRUE(t == w || t == glm::uvec3(w.y, w.z, w.x) || t == glm::uvec3(w.z, w.x, w.y)) << i;
    }
}

TEST_F(GltfMeshopt, FiltersAreUndone) {
    Grid grid(20);
    const std::size_t n = grid.vertices();
    // 2^-14 times a whole number each: eight bits of exponent above 24 of that number.
    constexpr int kExponent = -14;
    std::vector<std::uint32_t> filtered;
    for (const float value : grid.positions) {
        const auto mantissa = static_cast<std::int32_t>(std::lround(std::ldexp(value, -kExponent)));
        filtered.push_back((static_cast<std::uint32_t>(kExponent) << 24) |
                           (static_cast<std::uint32_t>(mantissa) & 0xffffffu));
    }
    GltfBuilder gltf;
    const int view = addCompressed(gltf, encode(filtered.data(), n, 12), n, 12, "ATTRIBUTES", "EXPONENTIAL");
    gltf.addNode({{"mesh", gltf.addMesh({{"attributes", {{"POSITION", gltf.addAccessor(view, 5126, "VEC3", n)}}},
                                         {"indices", gltf.addAccessor(grid.indices, "SCALAR")}})}});
    const MeshData mesh = load(gltf, "a.glb"), twin = plain(grid);
    ASSERT_EQ(mesh.positions.size(), twin.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mesh.positions[i][c], twin.positions[i][c], 1.0 / (1 << 14));
}

TEST_F(GltfMeshopt, DamagedOrUnfittingDataAreRefused) {
    const Grid grid(20);
    const auto withChange = [&](const char* key, const json& value) {
        GltfBuilder gltf = compressed(grid);
        gltf.json["bufferViews"][1]["extensions"]["EXT_meshopt_compression"][key] = value;
        return failure(gltf);
    };
    EXPECT_NE(withChange("byteLength", 40)
                  .find("/bufferViews/1/extensions/EXT_meshopt_compression: its data are "
                        "damaged"),
              std::string::npos);
    EXPECT_NE(withChange("count", 7).find("count: 7: must be the bytes of the view over byteStride"),
              std::string::npos);
    EXPECT_NE(withChange("byteStride", 11).find("byteStride: 11: must be a multiple of 4 up to 256"),
              std::string::npos);
    EXPECT_NE(withChange("mode", "CUBES").find("/mode"), std::string::npos);
    EXPECT_NE(withChange("filter", "OCTAHEDRAL").find("byteStride: 12: must be 4 or 8"), std::string::npos);
    EXPECT_NE(withChange("buffer", 5).find("buffer: 5"), std::string::npos);
}

TEST_F(GltfMeshopt, ChangedBytesDoNoHarm) {
    expectToSurvive(compressed(Grid(8)), 1);
}

TEST_F(GltfMeshopt, AKilobyteAsksForNoGigabyte) {
    GltfBuilder gltf;
    const std::size_t count = std::size_t{1} << 26;
    const int view = addCompressed(gltf, std::vector<unsigned char>(100, 0xa0), count, 256, "ATTRIBUTES");
    gltf.json["buffers"][1]["byteLength"] = count * 256;
    gltf.addNode({{"mesh", gltf.addMesh({{"attributes", {{"POSITION", gltf.addAccessor(view, 5126, "VEC3", 3)}}}})}});
    EXPECT_NE(failure(gltf).find("the most for a file of this size"), std::string::npos) << failure(gltf);
}

#endif

#ifdef RT_HAS_DRACO

constexpr int kBits = 14; // of a quantised coordinate

class GltfDraco : public GltfCompressed {
  protected:
    static std::vector<char> encode(const Grid& grid, int method) {
        draco::TriangleSoupMeshBuilder builder;
        const std::size_t faces = grid.indices.size() / 3;
        builder.Start(static_cast<int>(faces));
        const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
        const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
        for (std::size_t f = 0; f < faces; ++f) {
            const std::uint32_t* v = &grid.indices[3 * f];
            const draco::FaceIndex face(static_cast<std::uint32_t>(f));
            builder.SetAttributeValuesForFace(position, face, &grid.positions[3 * v[0]], &grid.positions[3 * v[1]],
                                              &grid.positions[3 * v[2]]);
            builder.SetAttributeValuesForFace(uv, face, &grid.uvs[2 * v[0]], &grid.uvs[2 * v[1]], &grid.uvs[2 * v[2]]);
        }
        const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
        draco::Encoder encoder;
        encoder.SetEncodingMethod(method);
        encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, kBits);
        encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, kBits);
        draco::EncoderBuffer buffer;
        EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
        return {buffer.data(), buffer.data() + buffer.size()};
    }
    static GltfBuilder compressed(const Grid& grid, const std::vector<char>& data) {
        GltfBuilder gltf;
        gltf.json["extensionsRequired"] = gltf.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
        const auto accessor = [&](int component, const char* type, std::size_t count) {
            return gltf.add("accessors", {{"componentType", component}, {"type", type}, {"count", count}});
        };
        const int indices = accessor(5125, "SCALAR", grid.indices.size());
        const int positions = accessor(5126, "VEC3", grid.vertices()), uvs = accessor(5126, "VEC2", grid.vertices());
        const json extension = {{"bufferView", gltf.addView(data)},
                                {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}};
        gltf.addNode({{"mesh", gltf.addMesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}},
                                             {"indices", indices},
                                             {"extensions", {{"KHR_draco_mesh_compression", extension}}}})}});
        return gltf;
    }
};

// Draco renumbers vertices and reorders triangles: both meshes have the same corners within their quantisation.
TEST_F(GltfDraco, IsAsItsTwinWithinItsQuantisation) {
    const Grid grid(20);
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const MeshData mesh = load(compressed(grid, encode(grid, method)), "a.glb"), twin = plain(grid);
        ASSERT_EQ(mesh.positions.size(), twin.positions.size());
        ASSERT_EQ(mesh.triangles.size(), twin.triangles.size());
        constexpr double kNear = 1.5 / (1 << kBits);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            // The vertex of the grid whose texture coordinates these are.
            const glm::dvec2 at = mesh.uvs[i] * 20.0;
            const auto x = static_cast<std::size_t>(std::lround(at.x)), y = static_cast<std::size_t>(std::lround(at.y));
            const std::size_t vertex = y * 21 + x;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(mesh.positions[i][c], twin.positions[vertex][c], kNear);
            for (int c = 0; c < 2; ++c) EXPECT_NEAR(mesh.uvs[i][c], twin.uvs[vertex][c], kNear);
        }
        double area = 0; // of the projection to the unit square, with its sign
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::dvec3 a = mesh.positions[t.x], u = mesh.positions[t.y] - a, v = mesh.positions[t.z] - a;
            area += 0.5 * (u.x * v.y - u.y * v.x);
        }
        EXPECT_NEAR(area, 1, 1e-3);
    }
}

TEST_F(GltfDraco, DamagedOrUnfittingDataAreRefused) {
    const Grid grid(20);
    std::vector<char> data = encode(grid, draco::MESH_EDGEBREAKER_ENCODING);
    GltfBuilder counts = compressed(grid, data);
    counts.json["accessors"][1]["count"] = 7;
    EXPECT_NE(failure(counts).find("POSITION: its accessor states 7 elements, the data have 441"), std::string::npos)
        << failure(counts);
    GltfBuilder ids = compressed(grid, data);
    ids.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 9;
    EXPECT_NE(failure(ids).find("/attributes/POSITION: there is no attribute of this id"), std::string::npos);
    data.resize(data.size() / 2);
    EXPECT_NE(failure(compressed(grid, data)).find("its data are damaged"), std::string::npos);
}

TEST_F(GltfDraco, ChangedBytesDoNoHarm) {
    const Grid grid(8);
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING})
        expectToSurvive(compressed(grid, encode(grid, method)), 2);
}

// Twelve million faces, says a head of a few bytes.
TEST_F(GltfDraco, AKilobyteAsksForNoGigabyte) {
    const Grid grid(2);
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        std::vector<char> data = encode(grid, method);
        const std::size_t faces = method == draco::MESH_EDGEBREAKER_ENCODING ? 13 : 11;
        data.resize(faces);
        data.insert(data.end(), {char(-1), char(-1), char(-1), 5}); // a number of seven bits a byte
        data.resize(1000);
        EXPECT_NE(failure(compressed(grid, data)).find("the most for a file of this size"), std::string::npos)
            << failure(compressed(grid, data));
    }
}

#endif

#ifdef RT_HAS_WEBP

TEST_F(GltfCompressed, TexturesOfWebPAreTaken) {
    GltfBuilder gltf;
    gltf.json["extensionsRequired"] = gltf.json["extensionsUsed"] = {"EXT_texture_webp"};
    gltf.add("images", {{"bufferView", gltf.addView(kPng)}, {"mimeType", "image/png"}});
    gltf.add("images", {{"bufferView", gltf.addView(kPng)}, {"mimeType", "image/webp"}});
    gltf.add("textures", {{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}});
    gltf.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    json primitive = gltf.triangle();
    primitive["material"] = 0;
    gltf.addNode({{"mesh", gltf.addMesh(primitive)}});
    const SceneDesc scene = loadGltfScene(gltf.save(folder / "a.glb"));
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(std::get<ImageTexture>(scene.textures.begin()->second).image, 1u);
    gltf.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 2;
    EXPECT_NE(failure(gltf).find("/textures/0/extensions/EXT_texture_webp/source: 2"), std::string::npos)
        << failure(gltf);
}

#endif

} // namespace
} // namespace rt::scene
