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

RunRecord fromJson(const nlohmann::json& json) {
    RunRecord r;
    r.time = json.at("time");
    r.app = json.at("app");
    r.engine = json.at("engine");
    r.device = json.at("device");
    r.scene = json.at("scene");
    r.lightSampling = json.at("light_sampling");
    r.sampler = json.at("sampler");
    r.width = json.at("width");
    r.height = json.at("height");
    r.maxDepth = json.at("max_depth");
    r.threads = json.at("threads");
    r.spp = json.at("spp");
    const nlohmann::json& seconds = json.at("seconds");
    r.loadSeconds = seconds.at("load");
    r.buildSeconds = seconds.at("accel_build");
    r.pipelineSeconds = seconds.at("pipeline");
    r.renderSeconds = seconds.at("render");
    r.samplesPerSecond = json.at("samples_per_second");
    r.raysPerSecond = json.at("rays_per_second");
    r.relmse = json.at("relmse");
    r.hasReference = json.at("against_reference");
    for (const nlohmann::json& point : json.at("curve")) r.curve.push_back({point.at(0), point.at(1)});
    return r;
}

// Fields with commas or quotes are quoted as in RFC 4180.
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
    const Json json{{"version", kVersion},
                    {"time", r.time},
                    {"app", r.app},
                    {"engine", r.engine},
                    {"device", r.device},
                    {"scene", r.scene},
                    {"light_sampling", r.lightSampling},
                    {"sampler", r.sampler},
                    {"width", r.width},
                    {"height", r.height},
                    {"max_depth", r.maxDepth},
                    {"threads", r.threads},
                    {"spp", r.spp},
                    {"seconds",
                     {{"load", r.loadSeconds},
                      {"accel_build", r.buildSeconds},
                      {"pipeline", r.pipelineSeconds},
                      {"render", r.renderSeconds}}},
                    {"samples_per_second", r.samplesPerSecond},
                    {"rays_per_second", r.raysPerSecond},
                    {"relmse", r.relmse},
                    {"against_reference", r.hasReference},
                    {"curve", curve}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string toCsv(const std::vector<RunRecord>& records) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << "time,app,engine,device,scene,light_sampling,sampler,width,height,spp,max_depth,threads,load_seconds,"
           "build_seconds,pipeline_seconds,render_seconds,samples_per_second,rays_per_second,relmse,against_reference,"
           "efficiency\n";
    out << std::setprecision(9);
    for (const RunRecord& r : records) {
        for (const std::string& text : {r.time, r.app, r.engine, r.device, r.scene, r.lightSampling, r.sampler})
            out << csvField(text) << ',';
        out << r.width << ',' << r.height << ',' << r.spp << ',' << r.maxDepth << ',' << r.threads << ','
            << r.loadSeconds << ',' << r.buildSeconds << ',' << r.pipelineSeconds << ',' << r.renderSeconds << ','
            << r.samplesPerSecond << ',' << r.raysPerSecond << ',' << r.relmse << ',' << (r.hasReference ? 1 : 0) << ','
            << r.efficiency() << '\n';
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
