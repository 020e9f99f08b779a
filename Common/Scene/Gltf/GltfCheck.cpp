#include "Common/Scene/Gltf/GltfCheck.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "Common/Core/Printable.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Gltf/GltfDraco.h"
#include "Common/Scene/Gltf/GltfMeshopt.h"
#include "Common/Scene/Gltf/GltfValues.h"

namespace rt::scene {

namespace {

constexpr std::array kSupported = {"KHR_lights_punctual",
                                   "KHR_materials_anisotropy",
                                   "KHR_materials_clearcoat",
                                   "KHR_materials_diffuse_transmission",
                                   "KHR_materials_dispersion",
                                   "KHR_materials_emissive_strength",
                                   "KHR_materials_ior",
                                   "KHR_materials_iridescence",
                                   "KHR_materials_pbrSpecularGlossiness",
                                   "KHR_materials_sheen",
                                   "KHR_materials_specular",
                                   "KHR_materials_transmission",
                                   "KHR_materials_unlit",
                                   "KHR_materials_variants",
                                   "KHR_materials_volume",
                                   "KHR_mesh_quantization",
                                   "KHR_texture_transform",
                                   "EXT_mesh_gpu_instancing",
                                   "EXT_texture_webp"};

// Without a buffer view the values of an accessor are zeros, which cost a file nothing.
constexpr std::uint64_t kMaxImplicit = 1'000'000;
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 40; // of offsets and lengths: their sums do not overflow

bool isSupported(const std::string& extension) {
    if (extension == "EXT_meshopt_compression") return knowsMeshopt();
    if (extension == "KHR_draco_mesh_compression") return knowsDraco();
    return std::find(kSupported.begin(), kSupported.end(), extension) != kSupported.end();
}

std::string indexInto(const std::string& array, std::size_t count) {
    return "an index into " + array + ", of which there " + (count == 1 ? "is " : "are ") + std::to_string(count);
}

std::uint64_t whole(const JsonNode& node) {
    if (!node.value().is_number_unsigned() || node.value().get<std::uint64_t>() > kMaxBytes)
        node.failValue("a whole number from 0 to 2^40");
    return node.value().get<std::uint64_t>();
}

std::uint64_t whole(const JsonNode& object, const char* key, std::uint64_t usual) {
    const auto node = object.find(key);
    return node ? whole(*node) : usual;
}

class Checker {
  public:
    explicit Checker(const JsonNode& root) : root_(root) {}

    std::vector<std::string> run() {
        checkVersion(root_.at("asset"));
        std::vector<std::string> notices = extensions();
        buffers();
        forEach("meshes", [this](const JsonNode& mesh) {
            mesh.at("primitives").forEachElement([this](const JsonNode& primitive) { dracoReferences(primitive); });
        });
        accessors();
        references();
        return notices;
    }

  private:
    // Files of later versions of 2 can be read as one of 2.0, unless they say that they cannot.
    static void checkVersion(const JsonNode& asset) {
        const JsonNode version = asset.at("version");
        if (version.string().rfind("2.", 0) != 0) version.failValue("2.0");
        const auto least = asset.find("minVersion");
        if (least && least->string() != "2.0") least->failValue("2.0, the version that this program reads");
    }

    std::vector<std::string> extensions() const {
        if (const auto required = root_.find("extensionsRequired"))
            required->forEachElement([](const JsonNode& name) {
                if (!isSupported(name.string()))
                    name.fail("extension " + printable(name.string()) + " is not supported");
            });
        std::vector<std::string> notices;
        if (const auto used = root_.find("extensionsUsed"))
            used->forEachElement([&](const JsonNode& name) {
                if (!isSupported(name.string()))
                    notices.push_back("extension " + printable(name.string()) + " is left out");
            });
        return notices;
    }

    // The element of an array of the root that a number names.
    template <typename Function> // (const JsonNode& element)
    void withElement(const JsonNode& index, const char* array, const Function& function) const {
        const auto elements = root_.find(array);
        const std::size_t count = elements ? elements->arraySize() : 0;
        const nlohmann::json& value = index.value();
        if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= count)
            index.failValue(indexInto(array, count));
        function(elements->element(value.get<std::size_t>()));
    }
    void reference(const JsonNode& index, const char* array) const {
        withElement(index, array, [](const JsonNode&) {});
    }
    void reference(const JsonNode& object, const char* key, const char* array) const {
        if (const auto index = object.find(key)) reference(*index, array);
    }
    void referencesOf(const JsonNode& object, const char* key, const char* array) const {
        if (const auto list = object.find(key))
            list->forEachElement([&](const JsonNode& index) { reference(index, array); });
    }
    template <typename Function> // (const JsonNode& element)
    void forEach(const char* array, const Function& function) const {
        if (const auto elements = root_.find(array)) elements->forEachElement(function);
    }

    void buffers() const {
        forEach("buffers", [](const JsonNode& buffer) {
            whole(buffer.at("byteLength")); // also 0, of which no view can be
        });
        forEach("bufferViews", [this](const JsonNode& view) {
            partOfBuffer(view);
            withExtension(view, "EXT_meshopt_compression", [&](const JsonNode& meshopt) {
                partOfBuffer(meshopt);
                checkMeshopt(meshopt, whole(view.at("byteLength")));
            });
            if (const auto stride = view.find("byteStride"))
                if (const std::uint64_t bytes = whole(*stride); bytes < 1 || bytes > 252)
                    stride->failValue("from 4 to 252");
        });
    }

    void partOfBuffer(const JsonNode& part) const {
        const std::uint64_t end = whole(part, "byteOffset", 0) + whole(part.at("byteLength"));
        withElement(part.at("buffer"), "buffers", [&](const JsonNode& buffer) {
            const std::uint64_t length = whole(buffer.at("byteLength"));
            if (end > length)
                part.fail("ends at byte " + std::to_string(end) + " of a buffer of " + std::to_string(length));
        });
    }

    // A node knows its place by those that it lies in, which therefore live as long as the call.
    template <typename Function> // (const JsonNode& extension)
    static void withExtension(const JsonNode& object, const char* name, const Function& function) {
        const auto extensions = object.find("extensions");
        const auto extension = extensions ? extensions->find(name) : std::nullopt;
        if (extension) function(*extension);
    }

    // That `count` elements of `bytes` from `offset` lie within a buffer view, `stride` apart if the view says so.
    // Against the specification there may be none, as programs write them for meshes without vertices.
    void range(const JsonNode& owner, std::uint64_t offset, std::uint64_t count, std::uint64_t bytes) const {
        withElement(owner.at("bufferView"), "bufferViews", [&](const JsonNode& view) {
            if (count == 0) return;
            const std::uint64_t stride = whole(view, "byteStride", bytes);
            const std::uint64_t length = whole(view.at("byteLength"));
            if (count > length || offset + stride * (count - 1) + bytes > length)
                owner.fail("its " + counted(count, "element ends", "elements end") + " beyond the " +
                           counted(length, "byte", "bytes") + " of the buffer view");
        });
    }

    static std::uint64_t componentBytes(const JsonNode& type) {
        switch (whole(type)) {
            case 5120:
            case 5121:
                return 1;
            case 5122:
            case 5123:
                return 2;
            case 5125:
            case 5126:
                return 4;
            default:
                type.failValue("5120, 5121, 5122, 5123, 5125 or 5126");
        }
    }

    // Columns of matrices start at multiples of four bytes.
    static std::uint64_t elementBytes(const std::string& type, std::uint64_t component) {
        if (type == "SCALAR") return component;
        const auto size = static_cast<std::uint64_t>(type.back() - '0');
        if (type.rfind("VEC", 0) == 0) return size * component;
        return size * ((size * component + 3) / 4 * 4);
    }

    void accessors() const {
        forEach("accessors", [this](const JsonNode& accessor) {
            const std::string type =
                accessor.at("type").oneOf({"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"});
            const std::uint64_t bytes = elementBytes(type, componentBytes(accessor.at("componentType")));
            const std::uint64_t count = whole(accessor.at("count"));
            if (count > UINT32_MAX) accessor.at("count").failValue("at most 2^32 - 1");
            if (accessor.has("bufferView"))
                range(accessor, whole(accessor, "byteOffset", 0), count, bytes);
            else if (count > kMaxImplicit && !hasDraco_)
                accessor.at("count").failValue("at most " + std::to_string(kMaxImplicit) + " without a buffer view");
            const auto sparse = accessor.find("sparse");
            if (!sparse) return;
            const std::uint64_t changed = whole(sparse->at("count"));
            if (changed > count) sparse->at("count").failValue("at most the accessor's count");
            const JsonNode indices = sparse->at("indices"), values = sparse->at("values");
            const JsonNode kind = indices.at("componentType");
            if (whole(kind) != 5121 && whole(kind) != 5123 && whole(kind) != 5125) kind.failValue("5121, 5123 or 5125");
            range(indices, whole(indices, "byteOffset", 0), changed, componentBytes(kind));
            range(values, whole(values, "byteOffset", 0), changed, bytes);
        });
    }

    void references() const {
        reference(root_, "scene", "scenes");
        forEach("scenes", [this](const JsonNode& scene) { referencesOf(scene, "nodes", "nodes"); });
        forEach("nodes", [this](const JsonNode& node) {
            reference(node, "mesh", "meshes");
            reference(node, "camera", "cameras");
            reference(node, "skin", "skins");
            referencesOf(node, "children", "nodes");
            if (const auto extensions = node.find("extensions")) {
                if (const auto instancing = extensions->find("EXT_mesh_gpu_instancing"))
                    attributes(instancing->at("attributes"));
                if (const auto light = extensions->find("KHR_lights_punctual"))
                    if (const JsonNode index = light->at("light"); whole(index) >= lightCount())
                        index.failValue(indexInto("lights", lightCount()));
            }
        });
        forEach("skins", [this](const JsonNode& skin) {
            referencesOf(skin, "joints", "nodes");
            reference(skin, "inverseBindMatrices", "accessors");
        });
        forEach("meshes", [this](const JsonNode& mesh) {
            mesh.at("primitives").forEachElement([this](const JsonNode& primitive) {
                reference(primitive, "indices", "accessors");
                reference(primitive, "material", "materials");
                attributes(primitive.at("attributes"));
                if (const auto targets = primitive.find("targets"))
                    targets->forEachElement([this](const JsonNode& target) { attributes(target); });
            });
        });
        forEach("animations", [this](const JsonNode& animation) { animationReferences(animation); });
        forEach("images", [this](const JsonNode& image) { reference(image, "bufferView", "bufferViews"); });
        forEach("textures", [this](const JsonNode& texture) {
            reference(texture, "source", "images");
            withExtension(texture, "EXT_texture_webp",
                          [this](const JsonNode& webp) { reference(webp, "source", "images"); });
            reference(texture, "sampler", "samplers");
        });
        forEach("materials", [this](const JsonNode& material) { textureReferences(material); });
    }

    void dracoReferences(const JsonNode& primitive) {
        withExtension(primitive, "KHR_draco_mesh_compression", [this](const JsonNode& draco) {
            hasDraco_ = knowsDraco();
            reference(draco.at("bufferView"), "bufferViews");
            draco.at("attributes").forEachMember([](const std::string&, const JsonNode& id) {
                if (whole(id) > UINT32_MAX) id.failValue("a number of 32 bits");
            });
        });
    }

    void attributes(const JsonNode& object) const {
        object.forEachMember([this](const std::string&, const JsonNode& index) { reference(index, "accessors"); });
    }

    void animationReferences(const JsonNode& animation) const {
        const JsonNode samplers = animation.at("samplers");
        const std::size_t count = samplers.arraySize();
        samplers.forEachElement([this](const JsonNode& sampler) {
            reference(sampler.at("input"), "accessors");
            reference(sampler.at("output"), "accessors");
        });
        animation.at("channels").forEachElement([&](const JsonNode& channel) {
            if (const JsonNode index = channel.at("sampler"); whole(index) >= count)
                index.failValue(indexInto("samplers", count));
            reference(channel.at("target"), "node", "nodes");
        });
    }

    std::size_t lightCount() const {
        const auto extensions = root_.find("extensions");
        const auto punctual = extensions ? extensions->find("KHR_lights_punctual") : std::nullopt;
        return punctual ? punctual->at("lights").arraySize() : 0;
    }

    // Every member whose name ends with "Texture" names one by its index, wherever extensions put it.
    void textureReferences(const JsonNode& object) const {
        constexpr std::string_view kEnd = "exture";
        object.forEachMember([&](const std::string& key, const JsonNode& member) {
            if (!member.value().is_object() || key == "extras") return;
            const bool isTexture =
                key.size() > kEnd.size() && key.compare(key.size() - kEnd.size(), kEnd.size(), kEnd) == 0;
            if (isTexture) reference(member.at("index"), "textures");
            textureReferences(member);
        });
    }

    const JsonNode& root_;
    bool hasDraco_ = false; // which has the values of accessors without a buffer view
};

} // namespace

std::vector<std::string> checkGltf(const JsonNode& root) {
    return Checker(root).run();
}

} // namespace rt::scene
