// rt-fuzz-seeds FOLDER: what ImageSeeds.cpp does not write, by the writers of this project.
#include "tests/fuzz/Seeds.h"

#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "Common/App/Interactive/GuiSettings.h"
#include "Common/App/Interactive/RunHistory.h"
#include "Common/App/Options/Options.h"
#include "Common/Bench/Suite.h"
#include "Common/Image/ImageIo.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/MaterialX/MaterialXModels.h"
#include "tests/unit/GltfBuilder.h"

namespace {

using rt::test::Seeds;
namespace fs = std::filesystem;

void writeScenes(Seeds& seeds) {
    // Mutations of long texts are slow, and stand-ins for files take seconds to generate.
    constexpr std::size_t kSmall = 8 << 10;
    const auto write = [&seeds](const std::string& name, const std::string& text) {
        if (text.size() > kSmall || text.find("stand_in") != text.npos) return;
        seeds.writeJson("scene", name, nlohmann::json::parse(text));
    };
    for (const auto& builtin : rt::scene::builtinScenes())
        write(std::string(builtin.id), rt::scene::toJson(rt::scene::findBuiltinScene(std::string(builtin.id))));
    for (const auto& entry : fs::directory_iterator(fs::path(RT_TEST_DATA_DIR) / "scenes")) {
        std::ifstream file(entry.path());
        write(entry.path().stem().string(), std::string(std::istreambuf_iterator<char>(file), {}));
    }
    seeds.writeJson("scene", "files", nlohmann::json::parse(R"({
        "camera": {"look_from": [0, 0, 5], "look_at": [0, 0, 0]},
        "textures": {"i": {"type": "image", "file": "a.pfm"},
                     "c": {"type": "checker", "scale": 1, "even": [1, 1, 1], "odd": "i"}},
        "materials": {"m": {"type": "lambertian", "albedo": "c"}},
        "objects": [{"type": "mesh", "file": "a.obj", "material": "m"}]})"));
}

void writeMeshes(const Seeds& seeds) {
    const std::string mesh =
        "mtllib f.mtl\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
        "usemtl a\nf 1/1/1 2/2/1 3/3/1\nusemtl b\nf -4//1 -3//1 -2//1 -1//1\n";
    const std::string materials =
        "newmtl a\nKd .5 .5 .5\nmap_Kd -s 2 2 a.png\nillum 2\n"
        "newmtl b\nKs 1 1 1\nPr .1\nillum 3\nnewmtl c\nillum 4\nNi 1.5\nTf 1 1 1\n"
        "newmtl d\nKe 4 4 4\n";
    seeds.write("obj", "materials", mesh + '\0' + materials);
    seeds.write("obj", "odd",
                "f 1/1 2 3//1 # first\nv 0 0 0 255 0 0\nv 1 0 0 0 128 0\nv 1 nan 0\nv 1 1 \\\n0 1 2 3\nvn 0 0 1\nvt 0\n"
                "s 1\nf 1 2 4\nf 1 2\nF 4//1 2//1 1//1\ns off\nUSEMTL \"A\" # b\nf 4 2 1\nmtllib F.MTL # c\n" +
                    std::string(1, '\0') +
                    "newmtl A #1\nKd 1 x 1\nillum 0\nnewmtl a\nillum 5\nKd 1 1 1\nKs .2 .2 .2\n");
    seeds.write("obj", "plain", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
}

// The scenes of tests, their parts and a mesh of a file of its own, which the target writes beside each input.
void writePbrt(const Seeds& seeds) {
    std::set<std::string> words;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(RT_TEST_DATA_DIR) / "pbrt")) {
        if (!entry.is_regular_file()) continue;
        std::ifstream file(entry.path());
        const std::string text(std::istreambuf_iterator<char>(file), {});
        const bool isMesh = entry.path().extension() == ".ply";
        seeds.write("pbrt", entry.path().stem().string(), isMesh ? std::string(1, '\0') + text : text);
        std::istringstream in(text);
        for (std::string word; in >> word;)
            if (word.find_first_of("\"\\#") == word.npos && word.size() < 30) words.insert(word);
    }
    for (const char* word :
         {"[", "]", "\\\"float alpha\\\"", "\\\"a.ply\\\"", "binary_little_endian", "1e300", "-1", "2147483647"})
        words.insert(word);
    seeds.writeWords("pbrt", words);
}

// Each surface with all of its inputs, some from images by way of a graph.
void writeMaterialX(const Seeds& seeds) {
    std::set<std::string> words = {"value",        "nodename", "nodegraph", "interfacename", "output",
                                   "srgb_texture", "1, 2, 3",  "color3",    "color4",        "float",
                                   "vector2",      "multiply", "invert",    "extract",       "constant"};
    const std::string graph =
        "<nodegraph name=\"G\"><input name=\"t\" type=\"vector2\" value=\"2, 3\"/><tiledimage name=\"i\" "
        "type=\"color3\"><input name=\"file\" type=\"filename\" value=\"i.png\"/><input name=\"uvtiling\" "
        "type=\"vector2\" interfacename=\"t\"/></tiledimage><extract name=\"e\" type=\"float\"><input name=\"in\" "
        "type=\"color3\" nodename=\"i\"/><input name=\"index\" type=\"integer\" value=\"1\"/></extract><output "
        "name=\"o\" type=\"float\" nodename=\"e\"/></nodegraph>";
    for (const rt::scene::MaterialXModel& model : rt::scene::materialXModels()) {
        std::string inputs;
        for (const rt::scene::MaterialXInput& input : {model.base,
                                                       model.baseColor,
                                                       model.metallic,
                                                       model.roughness,
                                                       model.ior,
                                                       model.transmission,
                                                       model.transmissionColor,
                                                       model.transmissionDepth,
                                                       model.subsurface,
                                                       model.sheen,
                                                       model.sheenColor,
                                                       model.coat,
                                                       model.coatColor,
                                                       model.emission,
                                                       model.emissionColor,
                                                       model.opacity,
                                                       model.thin,
                                                       model.normal,
                                                       model.alphaMode,
                                                       model.thickness,
                                                       model.attenuationDistance}) {
            if (input.name == nullptr) continue;
            words.insert(input.name);
            inputs += std::string("<input name=\"") + input.name + "\" type=\"float\" value=\"0.5\"/>";
        }
        inputs += std::string("<input name=\"") + model.specular.name + "\" nodegraph=\"G\" output=\"o\"/>";
        seeds.write("materialx", model.node,
                    "<materialx version=\"1.38\">" + graph + "<" + model.node + " name=\"S\">" + inputs + "</" +
                        model.node +
                        "><surfacematerial name=\"M\"><input name=\"surfaceshader\" "
                        "nodename=\"S\"/></surfacematerial></materialx>");
    }
    seeds.writeWords("materialx", words);
}

std::string base64(const std::string& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

// Each as binary, and as text whose buffer and image are data URIs.
void writeGltf(Seeds& seeds) {
    using nlohmann::json;
    const fs::path scratch = seeds.place("gltf", "scratch");
    rt::image::Image pixels(2, 1);
    const fs::path png = scratch.string() + ".png";
    rt::image::writeImage(png, rt::image::ImageRows(pixels), "");
    const auto content = [](const fs::path& path) {
        std::ifstream file(path, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    const std::string image = content(png);
    fs::remove(png);

    rt::scene::GltfBuilder full; // textures, indices, a camera, a light, a hierarchy, extensions of materials
    json primitive = full.triangle();
    primitive["indices"] = full.addAccessor(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR");
    primitive["attributes"]["NORMAL"] = full.addAccessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    primitive["attributes"]["TANGENT"] =
        full.addAccessor(std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
    primitive["attributes"]["COLOR_0"] = full.addAccessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
    primitive["material"] = 0;
    full.add("images", {{"uri", "data:image/png;base64," + base64(image)}});
    full.add("images",
             {{"bufferView", full.addView(std::vector<char>(image.begin(), image.end()))}, {"mimeType", "image/png"}});
    full.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}});
    full.add("textures", {{"source", 0}, {"sampler", 0}});
    full.add("textures", {{"source", 1}});
    const json texture = {{"index", 1},
                          {"texCoord", 0},
                          {"extensions", {{"KHR_texture_transform", {{"offset", {0, 1}}, {"rotation", 1}}}}}};
    full.add("materials",
             {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", texture}}},
              {"normalTexture", {{"index", 1}, {"scale", 2}}},
              {"emissiveFactor", {1, 0, 0}},
              {"alphaMode", "MASK"},
              {"alphaCutoff", 0.25},
              {"extensions",
               {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 2}}},
                {"KHR_materials_specular", {{"specularColorFactor", {1, 1, 1}}}},
                {"KHR_materials_clearcoat",
                 {{"clearcoatFactor", 1}, {"clearcoatTexture", texture}, {"clearcoatNormalTexture", texture}}},
                {"KHR_materials_sheen", {{"sheenColorFactor", {1, 0, 1}}}},
                {"KHR_materials_anisotropy",
                 {{"anisotropyStrength", 0.5}, {"anisotropyRotation", 1}, {"anisotropyTexture", texture}}},
                {"KHR_materials_iridescence",
                 {{"iridescenceFactor", 0.5}, {"iridescenceIor", 2}, {"iridescenceThicknessTexture", texture}}},
                {"KHR_materials_diffuse_transmission",
                 {{"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionColorTexture", texture}}},
                {"KHR_materials_dispersion", {{"dispersion", 0.5}}},
                {"KHR_materials_emissive_strength", {{"emissiveStrength", 5}}}}}});
    full.add("materials",
             {{"extensions",
               {{"KHR_materials_pbrSpecularGlossiness",
                 {{"diffuseTexture", texture}, {"specularGlossinessTexture", texture}, {"glossinessFactor", 0.5}}}}}});
    full.add("materials", {{"extensions", {{"KHR_materials_unlit", json::object()}}}});
    full.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
    full.add("cameras",
             {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 1}, {"zfar", 9}}}});
    full.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 5}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}},
        {{"type", "directional"}}};
    const int child = full.add("nodes", {{"mesh", full.addMesh(primitive)}, {"rotation", {0, 0, 0, 1}}});
    full.addNode({{"children", {child}}, {"scale", {2, 2, 2}}});
    full.addNode({{"camera", 0}, {"translation", {0, 0, 5}}});
    full.addNode({{"camera", 1}, {"scale", {-1, 1, 1}}});
    full.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    full.json["scene"] = 0;

    rt::scene::GltfBuilder packed; // strides, sparse and normalised accessors, strips, instances
    const int strided = packed.addView(std::vector<float>{0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9, 1, 1, 0, 9}, 16);
    const int positions = packed.addAccessor(strided, 5126, "VEC3", 4);
    packed.json["accessors"][positions]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", packed.addView(std::vector<std::uint8_t>{2})}, {"componentType", 5121}}},
        {"values", {{"bufferView", packed.addView(std::vector<float>{0, 2, 0})}}}};
    const int uvs = packed.addAccessor(std::vector<std::uint8_t>{0, 0, 255, 0, 0, 255, 255, 255}, "VEC2");
    packed.json["accessors"][uvs]["normalized"] = true;
    const int mesh = packed.addMesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}}, {"mode", 5}});
    const int shifts = packed.addAccessor(std::vector<float>{0, 0, 0, 3, 0, 0}, "VEC3");
    packed.addNode({{"mesh", mesh},
                    {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
                    {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", shifts}}}}}}}});

    rt::scene::GltfBuilder posed; // morph targets, a skin, animations
    json follower = posed.triangle();
    follower["attributes"]["JOINTS_0"] =
        posed.addAccessor(std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
    follower["attributes"]["WEIGHTS_0"] = posed.addAccessor(std::vector<float>(12, 0.5f), "VEC4");
    follower["targets"] = {{{"POSITION", posed.addAccessor(std::vector<float>(9, 0.25f), "VEC3")}}};
    const std::vector<float> identities = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                           1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const int matrices = posed.addAccessor(posed.addView(identities), 5126, "MAT4", 2);
    const int joint = posed.addNode({{"translation", {0, 1, 0}}});
    const int other = posed.addNode({{"scale", {-1, 1, 1}}});
    posed.add("skins", {{"joints", {joint, other}}, {"inverseBindMatrices", matrices}});
    const int figure = posed.addNode({{"mesh", posed.addMesh(follower)}, {"skin", 0}, {"weights", {0.5}}});
    const int times = posed.addAccessor(std::vector<float>{0, 1}, "SCALAR");
    const int turns = posed.addAccessor(std::vector<float>(24, 0.5f), "VEC4");
    const int weights = posed.addAccessor(std::vector<float>{0.5f, 1}, "SCALAR");
    posed.add("animations", {{"samplers",
                              {{{"input", times}, {"output", turns}, {"interpolation", "CUBICSPLINE"}},
                               {{"input", times}, {"output", weights}}}},
                             {"channels",
                              {{{"sampler", 0}, {"target", {{"node", joint}, {"path", "rotation"}}}},
                               {{"sampler", 1}, {"target", {{"node", figure}, {"path", "weights"}}}}}}});

    for (const auto& [name, gltf] :
         {std::pair("full", &full), std::pair("packed", &packed), std::pair("posed", &posed)}) {
        seeds.write("gltf", std::string(name) + "-binary", gltf->binary());
        gltf->saveWithBuffer(scratch, "", scratch.string() + ".bin");
        json document = json::parse(content(scratch));
        document["buffers"][0]["uri"] =
            "data:application/octet-stream;base64," + base64(content(scratch.string() + ".bin"));
        seeds.writeJson("gltf", name, document);
    }
    fs::remove(scratch);
    fs::remove(scratch.string() + ".bin");
}

void writeTexts(const Seeds& seeds) {
    rt::app::RunRecord record;
    record.time = rt::app::utcNow();
    record.app = "ray-tracing-cpu";
    record.width = 600;
    record.samplesPerSecond = 1e6;
    record.curve = {{1, 0.5}, {2, 0.25}};
    const std::string line = rt::app::toJsonLine(record) + '\n';
    seeds.write("history", "two", line + line);

    rt::app::GuiSettings settings;
    settings.recent = {"a.json"};
    settings.openPanels = {{"scene", false}};
    rt::app::saveGuiSettings(seeds.place("settings", "settings"), settings);

    for (const rt::bench::NamedSuite& suite : rt::bench::namedSuites()) seeds.write("suite", suite.name, suite.text);

    seeds.write("flags", "render",
                "--scene\nwhite-spheres:9\n--width=64\n--aspect\n1.5\n--spp\n4\n-o\na.png\n--aov\nalbedo,depth\n"
                "--region\n1,2,3,4\n--sampler\nstratified\n--time-limit\n1e1\n--threads\n2");
    seeds.write("flags", "share",
                "--tiles=1/3\n--checkpoint\na.rtc\n--light-sampling\nmixture\n--features\nspheres,quads\n--seed=3\n"
                "--camera={\"look_from\": [0, 0, 1], \"look_at\": [0, 0, 0]}\n--russian-roulette=off");
    seeds.write("flags", "gpu", "gpu\n--device\n0\n--engine=query\n--validation\n--spp=4\n--list-devices");
    std::set<std::string> flags;
    for (const std::string program : {rt::app::kCpuProgram, rt::app::kGpuProgram}) {
        std::stringstream help;
        rt::app::parseOptions(program, {"--help-all"}, help);
        for (std::string word; help >> word;)
            if (word.starts_with("--")) flags.insert(word.substr(0, word.find_first_of(",;:")));
    }
    seeds.writeWords("flags", flags);
    seeds.write("config", "lines",
                "# a\nspp = 5\nscene = \"a b\"\noutput = [\"a.png\", # b\n 'b.exr',\n]\naov=depth,albedo");
    seeds.write("config", "json", "{\"spp\": 5, \"output\": [\"a.png\"]}");
}

} // namespace

int main(int argc, char** argv) {
    return rt::test::writeSeeds(argc, argv, [](Seeds& seeds) {
        writeScenes(seeds);
        writeMeshes(seeds);
        writePbrt(seeds);
        writeMaterialX(seeds);
        writeGltf(seeds);
        writeTexts(seeds);
    });
}
