#include "Common/Scene/BuiltinScenes.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <optional>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Scene/BuiltinFamilies.h"

namespace rt::scene {

namespace {

template <SceneDesc (*make)()>
SceneDesc fixed(std::uint32_t) {
    return make();
}

constexpr BuiltinScene kScenes[] = {
    {"one-weekend-final", "One Weekend: Final",
     "The cover of the first book: some 480 small spheres and three large ones", 0, fixed<oneWeekendFinal>},
    {"rest-of-life-cornell-box-glass", "Rest of Your Life: Cornell Box, Glass",
     "The third book's last scene: a glass sphere that mixture sampling also aims at", 0, fixed<cornellBoxGlass>},
    {"cornell-box-lights", "Cornell Box Lights",
     "Nine strips and three coloured balls light a glass and a white sphere; the default scene", 0,
     fixed<cornellBoxLights>},
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

}  // namespace

std::span<const BuiltinScene> builtinScenes() {
    return kScenes;
}

SceneDesc findBuiltinScene(const std::string& id) {
    const std::size_t colon = id.find(':');
    const std::string_view name = std::string_view(id).substr(0, colon);
    const auto* found = std::find_if(std::begin(kScenes), std::end(kScenes),
                                     [&](const BuiltinScene& scene) { return scene.id == name; });
    if (found == std::end(kScenes))
        throw InputError("scene \"" + id + "\": no such scene; nearest: " + nearestIds(name) +
                         "; --list-scenes lists all, and .json and .obj files are scenes too");
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

}  // namespace rt::scene
