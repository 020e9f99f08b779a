#include "Common/Bench/Import.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "Common/App/Options/OptionValues.h"
#include "Common/Core/Error.h"
#include "Common/Image/ImageIo.h"

namespace rt::bench {
namespace {

constexpr std::size_t kWords = 3;
constexpr double kLeastSeconds = 1e-9, kMostSeconds = 1e9;

void check(const image::Image& picture, const std::string& file, const Config& like) {
    const std::uint32_t width = like.settings.width, height = like.settings.height;
    const auto size = [](std::uint32_t w, std::uint32_t h) { return std::to_string(w) + "×" + std::to_string(h); };
    if (picture.channels != 3) throw InputError(file + ": must have the channels R, G and B");
    if (picture.width != width || picture.height != height)
        throw InputError(file + ": is " + size(picture.width, picture.height) + ", must be " + size(width, height) +
                         " as the suite renders it");
    const auto isNumber = [](float value) { return std::isfinite(value); };
    const auto bad = std::find_if_not(picture.data.begin(), picture.data.end(), isNumber);
    if (bad == picture.data.end()) return;
    const auto pixel = static_cast<std::size_t>(bad - picture.data.begin()) / picture.channels;
    throw InputError(file + ": pixel " + std::to_string(pixel % width) + "," + std::to_string(pixel / width) +
                     " is no number");
}

} // namespace

std::vector<Import> parseImports(const std::vector<std::string>& words) {
    std::vector<Import> imports;
    for (std::size_t i = 0; i + kWords <= words.size(); i += kWords) {
        Import import{words[i], words[i + 1], 0};
        if (import.name.empty()) throw UsageError("--import: NAME must not be empty");
        if (std::find(std::begin(kEngines), std::end(kEngines), import.name) != std::end(kEngines))
            throw UsageError("--import " + import.name + ": is an engine of this program; give it another name");
        import.seconds =
            app::parseReal("--import SECONDS", words[i + 2], kLeastSeconds, kMostSeconds, "a number above 0");
        imports.push_back(std::move(import));
    }
    return imports;
}

void checkOnePicture(const Suite& suite) {
    if (suite.imports.empty()) return;
    std::set<std::tuple<std::string, std::uint32_t, std::uint32_t, std::uint32_t>> pictures;
    for (const Experiment& experiment : suite.experiments)
        for (const Config& c : combinations(experiment, std::numeric_limits<std::uint32_t>::max()))
            if (experiment.error) pictures.emplace(c.scene, c.settings.width, c.settings.height, c.settings.maxDepth);
    if (pictures.size() != 1)
        throw UsageError("--import: the suite must measure the error of one picture, and this one measures that of " +
                         std::to_string(pictures.size()) + "; --scene leaves one scene");
}

std::vector<Measured> readImports(const std::vector<Import>& imports, const Config& like) {
    std::vector<Measured> all;
    for (const Import& import : imports) {
        Snapshot snapshot;
        snapshot.seconds = import.seconds;
        snapshot.image = image::readImage(import.file);
        check(snapshot.image, import.file, like);
        auto place = std::find_if(all.begin(), all.end(),
                                  [&](const Measured& measured) { return measured.config.engine == import.name; });
        if (place == all.end()) {
            Measured measured;
            measured.config = like;
            measured.config.engine = import.name;
            measured.config.imported = true;
            measured.runs.resize(1);
            measured.runs.front().report.device = "imported";
            place = all.insert(all.end(), std::move(measured));
        }
        place->runs.front().snapshots.push_back(std::move(snapshot));
    }
    for (Measured& measured : all) {
        std::vector<Snapshot>& snapshots = measured.runs.front().snapshots;
        std::stable_sort(snapshots.begin(), snapshots.end(),
                         [](const Snapshot& a, const Snapshot& b) { return a.seconds < b.seconds; });
    }
    return all;
}

} // namespace rt::bench
