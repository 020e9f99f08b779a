#include "Common/Scene/Builtin/BuiltinScenes.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <optional>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Scene/Builtin/BuiltinFamilies.h"

namespace rt::scene {

namespace {

template <SceneDesc (*make)()>
SceneDesc fixed(std::uint32_t) {
    return make();
}

constexpr BuiltinScene kScenes[] = {
    {"cornell-box-lights", "Cornell Box Lights",
     "Nine strips and three coloured balls light a glass and a white sphere; the default scene", 0,
     fixed<cornellBoxLights>},
    {"one-weekend-default", "One Weekend: default", "A blue sphere on a yellow-green ground", 0,
     fixed<oneWeekendDefault>},
    {"one-weekend-test", "One Weekend: test", "A blue and a red sphere that touch, seen at a right angle", 0,
     fixed<oneWeekendTest>},
    {"one-weekend-final", "One Weekend: final",
     "The cover of the first book: some 480 small spheres and three large ones", 0, fixed<oneWeekendFinal>},
    {"next-week-default", "Next Week: default", "A sphere that moves sideways", 0, fixed<nextWeekDefault>},
    {"next-week-random-spheres", "Next Week: random spheres",
     "The first book's cover with bouncing spheres on a checker", 0, fixed<nextWeekRandomSpheres>},
    {"next-week-two-spheres", "Next Week: two spheres", "Two large spheres of a solid checker", 0,
     fixed<nextWeekTwoSpheres>},
    {"next-week-earth", "Next Week: Earth", "A sphere under a map of the Earth", 0, fixed<nextWeekEarth>},
    {"next-week-two-perlin-spheres", "Next Week: two Perlin spheres", "Marble made of Perlin noise", 0,
     fixed<nextWeekTwoPerlinSpheres>},
    {"next-week-quads", "Next Week: quads", "Five quads of five colours", 0, fixed<nextWeekQuads>},
    {"next-week-simple-light", "Next Week: simple light", "Marble lit by a sphere and a quad", 0,
     fixed<nextWeekSimpleLight>},
    {"next-week-cornell-box", "Next Week: Cornell box", "Two white boxes under a light that is small and two-sided", 0,
     fixed<nextWeekCornellBox>},
    {"next-week-cornell-smoke", "Next Week: Cornell smoke", "The boxes filled with black and with white smoke", 0,
     fixed<nextWeekCornellSmoke>},
    {"next-week-final", "Next Week: final", "The second book's last scene: boxes, motion, media, noise, 1000 spheres",
     0, fixed<nextWeekFinal>},
    {"rest-of-life-cornell-box", "Rest of Your Life: Cornell box", "Two white boxes under a one-sided light", 0,
     fixed<restOfLifeCornellBox>},
    {"rest-of-life-cornell-box-mirror", "Rest of Your Life: Cornell box, mirror", "The tall box is of aluminium", 0,
     fixed<restOfLifeCornellBoxMirror>},
    {"rest-of-life-cornell-box-glass", "Rest of Your Life: Cornell box, glass",
     "The third book's last scene: a glass sphere that mixture sampling also aims at", 0,
     fixed<restOfLifeCornellBoxGlass>},
    {"white-spheres", "White Spheres", "A cloud of N white spheres under one light", 20000, whiteSpheres},
    {"cube-and-spheres", "Cube And Spheres", "A cube of six colours between a metal, a glass and a textured sphere", 0,
     fixed<cubeAndSpheres>},
    {"planets-in-one-weekend", "Planets In One Weekend", "The first book's cover with three planets", 0,
     fixed<planetsInOneWeekend>},
    {"lucy-in-one-weekend", "Lucy In One Weekend", "The first book's cover with three instances of a statue", 0,
     fixed<lucyInOneWeekend>},
    {"cornell-box-lucy", "Cornell Box & Lucy", "A statue and a glass sphere in the box", 0, fixed<cornellBoxLucy>},
    {"veach-mis", "Veach MIS", "Four plates of rising roughness under four lights of rising size", 0, fixed<veachMis>},
    {"many-lights", "Many Lights", "N small spheres, quads and triangles light a room with columns", 1000, manyLights},
    {"triangle-lights", "Triangle Lights", "Letters and a ball made of emitting triangles", 0, fixed<triangleLights>},
    {"furnace", "Furnace", "Closed, everything emits and reflects a half: radiance is 1 everywhere", 0, fixed<furnace>},
    {"furnace-mixed", "Furnace, Mixed", "The same with glass, a mirror and a medium that lose nothing", 0,
     fixed<furnaceMixed>},
};

// Levenshtein's.
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

// The three ids that look most like a name: a part of the id, or few edits away.
std::string nearestIds(std::string_view name) {
    std::vector<std::pair<std::size_t, std::string_view>> ranked;
    for (const BuiltinScene& scene : kScenes) {
        const bool contains = !name.empty() && scene.id.find(name) != std::string_view::npos;
        ranked.emplace_back(contains ? 0 : editDistance(name, scene.id), scene.id);
    }
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, ranked.size()); ++i)
        text += (i == 0 ? "" : ", ") + std::string(ranked[i].second);
    return text;
}

std::optional<std::uint32_t> parseCount(std::string_view text) {
    std::uint32_t count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    const bool isValid =
        error == std::errc{} && end == text.data() + text.size() && count >= 1 && count <= kMaxSceneCount;
    return isValid ? std::optional(count) : std::nullopt;
}

std::string_view withoutCount(std::string_view id) {
    return id.substr(0, id.find(':'));
}

const BuiltinScene* sceneNamed(std::string_view name) { // null: there is none
    const auto* const found = std::find_if(std::begin(kScenes), std::end(kScenes),
                                           [&](const BuiltinScene& scene) { return scene.id == name; });
    return found == std::end(kScenes) ? nullptr : found;
}

} // namespace

std::span<const BuiltinScene> builtinScenes() {
    return kScenes;
}

bool isBuiltinScene(const std::string& id) {
    return sceneNamed(withoutCount(id)) != nullptr;
}

SceneDesc findBuiltinScene(const std::string& id) {
    const std::size_t colon = id.find(':');
    const std::string_view name = withoutCount(id);
    const BuiltinScene* const found = sceneNamed(name);
    if (found == nullptr)
        throw InputError("scene \"" + id + "\": no such scene; nearest: " + nearestIds(name) +
                         "; --list-scenes lists all, and .json, .obj, .gltf, .glb and .pbrt files are scenes too");
    std::uint32_t count = found->defaultCount;
    if (colon != std::string::npos) {
        if (count == 0) throw InputError("scene \"" + id + "\": " + std::string(name) + " takes no count");
        const auto parsed = parseCount(std::string_view(id).substr(colon + 1));
        if (!parsed)
            throw InputError("scene \"" + id + "\": the count after the colon must be a whole number from 1 to " +
                             std::to_string(kMaxSceneCount));
        count = *parsed;
    }
    SceneDesc scene = found->make(count);
    scene.id = id;
    scene.title = found->title;
    return scene;
}

} // namespace rt::scene
