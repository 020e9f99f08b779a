#include "Common/Bench/ResultsJson.h"

#include <array>
#include <charconv>
#include <span>

#include <nlohmann/json.hpp>

#include "Common/Core/Error.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Json/JsonText.h"

namespace rt::bench {
namespace {

using Json = nlohmann::ordered_json;
using scene::JsonNode;

// ---- writing -------------------------------------------------------------------------------------------------------

Json orNull(const Figure& figure) {
    return figure ? Json(*figure) : Json(nullptr);
}

bool isWhole(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

void putConfig(Json& json, const Config& config) {
    if (config.imported) json["imported"] = true;
    for (const Axis& axis : axes()) {
        if (!isKnown(axis, config)) continue;
        const std::string value = axis.get(config);
        json[std::string(axis.name)] = isWhole(value) ? Json(std::stoul(value)) : Json(value);
    }
}

template <class T>
void putFigures(Json& json, const T& row, std::span<const FigureColumn<T>> columns) {
    for (const auto& column : columns) json[std::string(column.name)] = orNull(row.*column.value);
}

Json rowJson(const Row& row) {
    Json json{{"experiment", row.experiment}};
    putConfig(json, row.config);
    json["device"] = row.device;
    json["kernel"] = row.kernel;
    json["light_shapes"] = row.lightShapes;
    putFigures(json, row, rowColumns());
    return json;
}

Json seriesJson(const Series& series) {
    Json json{{"experiment", series.experiment}};
    putConfig(json, series.config);
    putFigures(json, series, seriesColumns());
    return json;
}

Json skipJson(const SkipRow& skip) {
    Json json{{"experiment", skip.experiment}};
    putConfig(json, skip.config);
    json["kernel"] = skip.kernel;
    putFigures(json, skip, skipColumns());
    return json;
}

Json referenceJson(const ReferenceRow& row) {
    return {{"scene", row.scene},
            {"width", row.width},
            {"height", row.height},
            {"max_depth", row.maxDepth},
            {"engine", row.engine},
            {"spp", orNull(row.spp)},
            {"seconds", orNull(row.seconds)},
            {"rmse", orNull(row.rmse)},
            {"cached", row.cached},
            {"sufficient", row.sufficient},
            {"verified_by", row.verifiedBy},
            {"verified_z", orNull(row.verifiedZ)}};
}

template <class T, class Function>
Json listOf(const std::vector<T>& rows, Function toJson) {
    Json list = Json::array();
    for (const T& row : rows) list.push_back(toJson(row));
    return list;
}

// ---- reading -------------------------------------------------------------------------------------------------------

Figure readFigure(const JsonNode& node) {
    if (node.value().is_null()) return std::nullopt;
    if (!node.value().is_number()) node.failValue("a number or null");
    return node.value().get<double>();
}

Config readConfig(const JsonNode& node) {
    Config config;
    if (const auto imported = node.find("imported")) config.imported = imported->boolean();
    for (const Axis& axis : axes()) {
        const auto value = node.find(std::string(axis.name).c_str());
        if (!value) continue;                           // of an older version
        if (config.imported && axis.name == "engine") { // any name
            config.engine = value->string();
            continue;
        }
        try {
            axis.set(config, value->value().is_number() ? value->value().dump() : value->string());
        } catch (const UsageError& error) {
            value->fail(error.what());
        }
    }
    return config;
}

template <class T>
void readFigures(const JsonNode& node, T& row, std::span<const FigureColumn<T>> columns) {
    for (const auto& column : columns)
        if (const auto value = node.find(std::string(column.name).c_str())) row.*column.value = readFigure(*value);
}

Row readRow(const JsonNode& node) {
    Row row;
    row.experiment = node.at("experiment").string();
    row.config = readConfig(node);
    row.device = node.at("device").string();
    row.kernel = node.at("kernel").string();
    row.lightShapes = node.at("light_shapes").string();
    readFigures(node, row, rowColumns());
    return row;
}

// ---- CSV -----------------------------------------------------------------------------------------------------------

std::string field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string field(const Figure& figure) { // the shortest text that reads back to the same number
    if (!figure) return {};
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), *figure).ptr;
    return {text.data(), end};
}

} // namespace

std::string toJson(const Results& results) {
    Json facts = Json::object();
    for (const Fact& fact : results.facts) facts[fact.name] = fact.value;
    const Json json{{"version", 1},
                    {"suite", results.suite},
                    {"title", results.title},
                    {"complete", results.complete},
                    {"machine", facts},
                    {"notices", results.notices},
                    {"rows", listOf(results.rows, rowJson)},
                    {"series", listOf(results.series, seriesJson)},
                    {"skipped_features", listOf(results.skips, skipJson)},
                    {"references", listOf(results.references, referenceJson)}};
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Results parseResults(const std::string& text, const std::string& file) {
    const nlohmann::json document = scene::parseJson(text, file);
    const JsonNode root(document, file);
    if (root.at("version").value() != 1) root.at("version").failValue("1");
    Results results;
    results.suite = root.at("suite").string();
    results.title = root.at("title").string();
    results.complete = root.at("complete").boolean();
    const auto addFact = [&](const std::string& name, const JsonNode& node) {
        results.facts.push_back({name, node.string()});
    };
    root.at("machine").forEachMember(addFact);
    root.at("notices").forEachElement([&](const JsonNode& node) { results.notices.push_back(node.string()); });
    root.at("rows").forEachElement([&](const JsonNode& node) { results.rows.push_back(readRow(node)); });
    root.at("series").forEachElement([&](const JsonNode& node) {
        Series series;
        series.experiment = node.at("experiment").string();
        series.config = readConfig(node);
        readFigures(node, series, seriesColumns());
        results.series.push_back(series);
    });
    return results;
}

std::string toCsv(const Results& results) {
    std::string text = "experiment";
    for (const Axis& axis : axes()) text += "," + std::string(axis.name);
    text += ",device,kernel,light_shapes";
    for (const auto& column : rowColumns()) text += "," + std::string(column.name);
    text += "\n";
    for (const Row& row : results.rows) {
        text += field(row.experiment);
        for (const Axis& axis : axes()) text += "," + field(isKnown(axis, row.config) ? axis.get(row.config) : "");
        text += "," + field(row.device) + "," + field(row.kernel) + "," + field(row.lightShapes);
        for (const auto& column : rowColumns()) text += "," + field(row.*column.value);
        text += "\n";
    }
    return text;
}

} // namespace rt::bench
