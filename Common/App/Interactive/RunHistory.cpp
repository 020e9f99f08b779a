#include "Common/App/Interactive/RunHistory.h"

#include <chrono>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <sstream>

#include <nlohmann/json.hpp>

#include "Common/App/Platform.h"
#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"

namespace rt::app {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int kVersion = 1;

std::vector<std::string> readLines(const fs::path& file) {
    std::vector<std::string> lines;
    std::ifstream in(file, std::ios::binary);
    for (std::string line; std::getline(in, line);)
        if (!line.empty()) lines.push_back(line);
    return lines;
}

// Every field but the curve: its place in the JSON object, its column in the table, its value.
template <class Record, class Visit>
void forEachField(Record&& r, const Visit& visit) {
    visit("/time", "time", r.time);
    visit("/app", "app", r.app);
    visit("/engine", "engine", r.engine);
    visit("/device", "device", r.device);
    visit("/scene", "scene", r.scene);
    visit("/light_sampling", "light_sampling", r.lightSampling);
    visit("/sampler", "sampler", r.sampler);
    visit("/width", "width", r.width);
    visit("/height", "height", r.height);
    visit("/spp", "spp", r.spp);
    visit("/max_depth", "max_depth", r.maxDepth);
    visit("/threads", "threads", r.threads);
    visit("/seconds/load", "load_seconds", r.loadSeconds);
    visit("/seconds/accel_build", "build_seconds", r.buildSeconds);
    visit("/seconds/pipeline", "pipeline_seconds", r.pipelineSeconds);
    visit("/seconds/render", "render_seconds", r.renderSeconds);
    visit("/samples_per_second", "samples_per_second", r.samplesPerSecond);
    visit("/rays_per_second", "rays_per_second", r.raysPerSecond);
    visit("/relmse", "relmse", r.relmse);
    visit("/against_reference", "against_reference", r.hasReference);
}

RunRecord fromJson(const nlohmann::json& json) {
    RunRecord r;
    forEachField(r, [&](const char* place, const char*, auto& value) {
        json.at(nlohmann::json::json_pointer(place)).get_to(value);
    });
    for (const nlohmann::json& point : json.at("curve")) r.curve.push_back({point.at(0), point.at(1)});
    return r;
}

// Fields with commas or quotes are quoted as in RFC 4180.
template <class T>
const T& csvField(const T& number) {
    return number;
}
std::string csvField(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

} // namespace

std::string toJsonLine(const RunRecord& r) {
    Json curve = Json::array();
    for (const RunRecord::Point& point : r.curve) curve.push_back({point.seconds, point.relmse});
    Json json{{"version", kVersion}};
    forEachField(r,
                 [&](const char* place, const char*, const auto& value) { json[Json::json_pointer(place)] = value; });
    json["curve"] = curve;
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string toCsv(const std::vector<RunRecord>& records) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    forEachField(RunRecord{}, [&](const char*, const char* column, const auto&) { out << column << ','; });
    out << "efficiency\n" << std::setprecision(9);
    for (const RunRecord& r : records) {
        forEachField(r, [&](const char*, const char*, const auto& value) { out << csvField(value) << ','; });
        out << r.efficiency() << '\n';
    }
    return out.str();
}

std::string utcNow() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm utc{};
#ifdef _WIN32
    gmtime_s(&utc, &now);
#else
    gmtime_r(&now, &utc);
#endif
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

std::filesystem::path RunHistory::userFile() {
    const fs::path folder = userConfigDirectory();
    return folder.empty() ? fs::path() : folder / "history.jsonl";
}

void RunHistory::append(const RunRecord& record) {
    if (file_.empty()) {
        records_.push_back(record);
        return;
    }
    std::error_code ignored; // opening the file tells
    fs::create_directories(file_.parent_path(), ignored);
    // A file of its own is locked, as the history is replaced when it is shortened.
    const FileLock lock(file_.string() + ".lock");
    std::vector<std::string> lines = readLines(file_);
    if (lines.size() >= kMostLines) {
        lines.erase(lines.begin(), lines.end() - (kMostLines - 1));
        AtomicFile file(file_);
        for (const std::string& line : lines) file.stream() << line << '\n';
        file.stream() << toJsonLine(record) << '\n';
        file.commit();
        return;
    }
    std::ofstream out(file_, std::ios::binary | std::ios::app);
    out << toJsonLine(record) << '\n';
    out.flush();
    if (!out) throw RenderError(file_.string() + ": cannot be written");
}

const std::vector<RunRecord>& RunHistory::records() {
    if (file_.empty()) return records_;
    std::error_code none;
    const auto time = fs::last_write_time(file_, none);
    const std::uintmax_t size = none ? 0 : fs::file_size(file_, none);
    if (none) {
        records_.clear();
        wasRead_ = false;
        return records_;
    }
    if (wasRead_ && time == readTime_ && size == readSize_) return records_;
    records_.clear();
    for (const std::string& line : readLines(file_)) {
        try {
            const nlohmann::json json = nlohmann::json::parse(line);
            if (json.at("version") == kVersion) records_.push_back(fromJson(json));
        } catch (const nlohmann::json::exception&) {
            continue; // half a line of a program that was killed, or an object that is not ours
        }
    }
    readTime_ = time;
    readSize_ = size;
    wasRead_ = true;
    return records_;
}

} // namespace rt::app
