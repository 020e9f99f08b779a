#include "Common/Bench/Suite.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>

#include "Common/App/Options/OptionValues.h"
#include "Common/Core/Error.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Json/JsonText.h"

namespace rt::bench {
namespace {

using scene::JsonNode;

constexpr std::uint64_t kLargestSuite = 16 << 20;
constexpr double kLongest = 1e6; // seconds
constexpr std::uint32_t kLargestSide = 1 << 20;

// Calls with each element of an array, or with the value itself.
template <class Function> // (const JsonNode&)
void forOneOrMore(const JsonNode& node, Function function) {
    if (!node.value().is_array()) return function(node);
    if (node.arraySize() == 0) node.fail("must not be empty");
    node.forEachElement(function);
}

std::string textOf(const JsonNode& node) {
    if (node.value().is_object()) return node.value().dump(); // the pose of a camera
    if (node.value().is_boolean()) return node.boolean() ? "on" : "off";
    return node.value().is_number() ? node.value().dump() : node.string();
}

// The value of an axis, checked by setting it.
std::string axisValue(const JsonNode& node, const Axis& axis) {
    std::string text = textOf(node);
    Config scratch;
    try {
        axis.set(scratch, text);
    } catch (const UsageError& error) {
        node.fail(error.what());
    }
    return text;
}

template <class T, class Read> // (const JsonNode&) -> T
std::vector<T> ascending(const JsonNode& node, Read read) {
    std::vector<T> values;
    forOneOrMore(node, [&](const JsonNode& element) {
        const T value = read(element);
        if (!(value > (values.empty() ? T{0} : values.back()))) element.fail("values must be positive and ascending");
        values.push_back(value);
    });
    return values;
}

std::uint32_t wholeWithin(const JsonNode& node, std::uint32_t low, std::uint32_t high) {
    const auto& value = node.value();
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() < low || value.get<std::uint64_t>() > high)
        node.failValue("a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    return value.get<std::uint32_t>();
}

std::string engineName(const std::string& text, const JsonNode& node) {
    Config scratch;
    try {
        findAxis("engine")->set(scratch, text);
    } catch (const UsageError& error) {
        node.fail(error.what());
    }
    return text;
}

constexpr NamedSuite kSuites[] = {
#include <NamedSuites.inc> // Assets/bench/*.json
};

constexpr const char* kExperimentKeys[] = {"name",   "title",   "spp",         "seconds",  "repeats", "error",
                                           "images", "max_spp", "max_seconds", "baseline", "variants"};

// Values of axes, in the order of the table.
Experiment::Variant readVariant(const JsonNode& node) {
    Experiment::Variant variant;
    node.forEachMember([&](const std::string& name, const JsonNode& value) {
        const Axis* axis = findAxis(name);
        if (axis == nullptr) value.fail("no such axis");
        variant.emplace_back(axis, axisValue(value, *axis));
    });
    std::sort(variant.begin(), variant.end());
    return variant;
}

void readKeys(const JsonNode& node, Experiment& experiment) {
    if (const auto spp = node.find("spp"))
        experiment.spp =
            ascending<std::uint32_t>(*spp, [](const JsonNode& n) { return wholeWithin(n, 1, 0x7fffffffu); });
    if (const auto seconds = node.find("seconds"))
        experiment.seconds = ascending<double>(*seconds, [](const JsonNode& n) { return n.within(1e-3, kLongest); });
    if (experiment.spp.empty() == experiment.seconds.empty()) node.fail("needs either spp or seconds");
    if (const auto repeats = node.find("repeats")) experiment.repeats = wholeWithin(*repeats, 1, 1000);
    if (const auto error = node.find("error")) experiment.error = error->boolean();
    if (const auto images = node.find("images")) experiment.images = images->boolean();
    if (const auto maximum = node.find("max_seconds")) experiment.maxSeconds = maximum->within(1e-3, kLongest);
    if (const auto maximum = node.find("max_spp"))
        maximum->forEachMember([&](const std::string& engine, const JsonNode& value) {
            experiment.maxSpp[engineName(engine, value)] = wholeWithin(value, 1, 0x7fffffffu);
        });
    if (const auto baseline = node.find("baseline"))
        for (const auto& [axis, value] : readVariant(*baseline)) experiment.baseline[axis] = value;
}

// Each has a value for every axis that one of them names, and no other part of the experiment has one.
void readVariants(const JsonNode& node, Experiment& experiment) {
    const auto list = node.find("variants");
    if (!list) return;
    list->forEachElement([&](const JsonNode& element) {
        Experiment::Variant variant = readVariant(element);
        for (const auto& [axis, value] : variant)
            if (node.has(std::string(axis->name).c_str()))
                element.at(std::string(axis->name).c_str()).fail("is an axis of the experiment as well");
        const auto isSameAxis = [](const auto& a, const auto& b) { return a.first == b.first; };
        if (!experiment.variants.empty() &&
            !std::equal(variant.begin(), variant.end(), experiment.variants.front().begin(),
                        experiment.variants.front().end(), isSameAxis))
            element.fail("must name the same axes as the first one");
        experiment.variants.push_back(std::move(variant));
    });
    if (experiment.variants.empty()) list->fail("must not be empty");
    const bool isHalved = !experiment.spp.empty() && experiment.spp.front() < 2;
    for (const auto& [axis, value] : experiment.variants.front()) {
        if (axis->name == "ranks") list->fail("ranks are no part of variants");
        if (axis->name == "denoise" && isHalved)
            list->fail("denoise needs two halves of the samples: spp of 2 or more");
    }
}

std::string axisNames() {
    std::vector<std::string> names;
    for (const Axis& axis : axes()) names.emplace_back(axis.name);
    return app::alternatives(names);
}

Experiment readExperiment(const JsonNode& node) {
    Experiment experiment;
    experiment.name = node.at("name").string();
    if (experiment.name.empty()) node.at("name").fail("must not be empty");
    experiment.title = node.has("title") ? node.at("title").string() : experiment.name;
    node.forEachMember([&](const std::string& key, const JsonNode& value) {
        if (std::find(std::begin(kExperimentKeys), std::end(kExperimentKeys), key) != std::end(kExperimentKeys)) return;
        const Axis* axis = findAxis(key);
        if (axis == nullptr) value.fail("neither a setting of an experiment nor an axis: " + axisNames());
        std::vector<std::string> values;
        forOneOrMore(value, [&](const JsonNode& element) { values.push_back(axisValue(element, *axis)); });
        experiment.values.emplace_back(axis, std::move(values));
    });
    // In the order of the table, so that equal suites give equal reports.
    std::sort(experiment.values.begin(), experiment.values.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    readKeys(node, experiment);
    readVariants(node, experiment);
    if (const auto ranks = node.find("ranks"); ranks && !experiment.seconds.empty())
        ranks->fail("needs spp: ranks are not stopped after seconds");
    if (const auto denoise = node.find("denoise")) {
        if (node.find("ranks")) denoise->fail("not with ranks: pictures are filtered by this program");
        if (!experiment.spp.empty() && experiment.spp.front() < 2)
            denoise->fail("needs two halves of the samples: spp of 2 or more");
    }
    return experiment;
}

Published readPublished(const JsonNode& node) {
    node.expectKeys({"name", "scene", "width", "height", "seconds"});
    Published published{node.at("name").string(),
                        node.at("scene").string(),
                        wholeWithin(node.at("width"), 1, kLargestSide),
                        wholeWithin(node.at("height"), 1, kLargestSide),
                        {}};
    node.at("seconds").forEachMember([&](const std::string& spp, const JsonNode& value) {
        try {
            published.seconds[app::parseWhole("spp", spp, 1, 0x7fffffffu)] = value.positive();
        } catch (const UsageError& error) {
            value.fail(error.what());
        }
    });
    return published;
}

// The values of an axis, which gets its place in the order of the table.
std::vector<std::string>& valuesOf(Experiment& experiment, const char* name) {
    const Axis* axis = findAxis(name);
    auto place = std::find_if(experiment.values.begin(), experiment.values.end(),
                              [&](const auto& entry) { return entry.first >= axis; });
    if (place == experiment.values.end() || place->first != axis)
        place = experiment.values.insert(place, {axis, {axis->get(Config())}});
    return place->second;
}

// What makes no difference gets its default.
void removeMeaningless(Config& config, std::uint32_t hardwareThreads) {
    const app::RenderSettings defaults;
    app::RenderSettings& settings = config.settings;
    const bool isAll = config.threads == hardwareThreads && config.ranks == 1; // ranks share them out
    if (config.engine != "multi" || isAll) config.threads = 0;
    if (settings.lightSampling != app::LightSampling::Bsdf) return;
    settings.lightSelection = defaults.lightSelection;
    settings.sphereLight = defaults.sphereLight;
    settings.quadLight = defaults.quadLight;
    settings.triangleLight = defaults.triangleLight;
}

} // namespace

Suite parseSuite(const std::string& text, const std::string& file) {
    const nlohmann::json document = scene::parseJson(text, file);
    const JsonNode root(document, file);
    root.expectKeys({"$schema", "version", "title", "reference_seconds", "experiments", "published"});
    if (root.at("version").value() != 1) root.at("version").failValue("1");
    Suite suite;
    suite.name = std::filesystem::path(file).stem().string();
    suite.title = root.has("title") ? root.at("title").string() : suite.name;
    if (const auto seconds = root.find("reference_seconds")) suite.referenceSeconds = seconds->within(0.1, kLongest);
    root.at("experiments").forEachElement([&](const JsonNode& node) {
        suite.experiments.push_back(readExperiment(node));
    });
    if (suite.experiments.empty()) root.at("experiments").fail("must not be empty");
    for (std::size_t i = 0; i < suite.experiments.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (suite.experiments[i].name == suite.experiments[k].name)
                root.at("experiments").element(i).at("name").fail("is the name of an earlier experiment");
    if (const auto published = root.find("published"))
        published->forEachElement([&](const JsonNode& node) { suite.published.push_back(readPublished(node)); });
    return suite;
}

std::span<const NamedSuite> namedSuites() {
    return kSuites;
}

Suite loadSuite(const std::string& nameOrFile) {
    std::vector<std::string> names;
    for (const NamedSuite& suite : namedSuites()) {
        if (nameOrFile == suite.name) return parseSuite(suite.text, suite.name);
        names.emplace_back(suite.name);
    }
    if (std::filesystem::path(nameOrFile).extension() != ".json")
        throw InputError("suite \"" + nameOrFile + "\": must be " + app::alternatives(names) + ", or a .json file");
    const std::vector<std::byte> bytes = readFile(nameOrFile, kLargestSuite);
    return parseSuite(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), nameOrFile);
}

bool varies(const Experiment& experiment, const Axis& axis) {
    const auto isOf = [&axis](const auto& entry) { return entry.first == &axis; };
    const auto varied = std::find_if(experiment.values.begin(), experiment.values.end(), isOf);
    if (varied != experiment.values.end()) return varied->second.size() > 1;
    std::set<std::string> values;
    for (const Experiment::Variant& variant : experiment.variants)
        if (const auto value = std::find_if(variant.begin(), variant.end(), isOf); value != variant.end())
            values.insert(value->second);
    return values.size() > 1;
}

void replaceScenes(Suite& suite, const std::vector<std::string>& scenes) {
    for (Experiment& experiment : suite.experiments) valuesOf(experiment, "scene") = scenes;
}

void restrictEngines(Suite& suite, const std::vector<std::string>& engines) {
    for (Experiment& experiment : suite.experiments) {
        std::vector<std::string>& values = valuesOf(experiment, "engine");
        std::erase_if(values, [&](const std::string& engine) {
            return std::find(engines.begin(), engines.end(), engine) == engines.end();
        });
    }
    std::erase_if(suite.experiments, [](Experiment& experiment) { return valuesOf(experiment, "engine").empty(); });
}

std::vector<Config> combinations(const Experiment& experiment, std::uint32_t hardwareThreads) {
    std::vector<Config> configs(std::max<std::size_t>(1, experiment.variants.size()));
    for (std::size_t i = 0; i < experiment.variants.size(); ++i)
        for (const auto& [axis, value] : experiment.variants[i]) axis->set(configs[i], value);
    for (const auto& [axis, values] : experiment.values) {
        std::vector<Config> more;
        for (const Config& config : configs)
            for (const std::string& value : values) {
                more.push_back(config);
                axis->set(more.back(), value);
            }
        configs = std::move(more);
    }
    std::vector<Config> distinct;
    std::set<std::string> keys;
    for (Config& config : configs) {
        removeMeaningless(config, hardwareThreads);
        if (config.threads <= hardwareThreads && keys.insert(keyOf(config)).second) distinct.push_back(config);
    }
    return distinct;
}

} // namespace rt::bench
