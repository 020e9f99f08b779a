#include "Common/App/Interactive/RunHistory.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iomanip>
#include <optional>
#include <sstream>
#include <unordered_set>

#include <nlohmann/json.hpp>

#include "Common/App/Options/Options.h"
#include "Common/App/Platform.h"
#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Core/TimeText.h"
#include "Common/Render/Names.h"

namespace rt::app {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int kRecordVersion = 1;

std::vector<std::string> readLines(const fs::path& file) {
    std::vector<std::string> lines;
    std::ifstream in(file, std::ios::binary);
    for (std::string line; std::getline(in, line);)
        if (!line.empty()) lines.push_back(line);
    return lines;
}

// Every field that all records have, but the curve: its place in the JSON object, its column in the table, its value.
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

// The fields that records of earlier programs lack.
template <class Record, class Visit>
void forEachLaterField(Record&& r, const Visit& visit) {
    visit("/scene_hash", "scene_hash", r.sceneHash);
    visit("/camera", "camera", r.camera);
    visit("/light_selection", "light_selection", r.lightSelection);
    visit("/sphere_light", "sphere_light", r.sphereLight);
    visit("/quad_light", "quad_light", r.quadLight);
    visit("/triangle_light", "triangle_light", r.triangleLight);
    visit("/russian_roulette", "russian_roulette", r.russianRoulette);
    visit("/one_sided_lights", "one_sided_lights", r.oneSidedLights);
    visit("/adaptive", "adaptive", r.adaptive);
    visit("/replicates", "replicates", r.replicates);
    visit("/specular_connections", "specular_connections", r.specularConnections);
    visit("/edge_rays", "edge_rays", r.edgeRays);
    visit("/path_reuse", "path_reuse", r.pathReuse);
}

// Likewise, but no part of the work.
constexpr const char* kReferenceError = "reference_relmse";
constexpr const char* kSoftware = "software_device";

RunRecord fromJson(const nlohmann::json& json) {
    RunRecord r;
    forEachField(r, [&](const char* place, const char*, auto& value) {
        json.at(nlohmann::json::json_pointer(place)).get_to(value);
    });
    forEachLaterField(r, [&](const char* place, const char*, std::string& value) {
        value = json.value(nlohmann::json::json_pointer(place), "");
    });
    if (r.replicates.empty()) r.replicates = RunRecord().replicates;
    if (r.specularConnections.empty()) r.specularConnections = nameOf(kSpecularConnections, false);
    if (r.edgeRays.empty()) r.edgeRays = nameOf(kEdgeRays, false);
    if (r.pathReuse.empty()) r.pathReuse = nameOf(kPathReuse, PathReuse::Off);
    r.referenceError = json.value(kReferenceError, 0.0);
    r.isSoftware = json.value(kSoftware, false);
    for (const nlohmann::json& point : json.at("curve")) r.curve.push_back({point.at(0), point.at(1)});
    return r;
}

// None of half a line of a program that was killed, and of an object that is not ours.
std::optional<RunRecord> toRecord(const std::string& line) {
    try {
        const nlohmann::json json = nlohmann::json::parse(line);
        if (json.at("version") == kRecordVersion) return fromJson(json);
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
    return std::nullopt;
}

template <class T>
const T& csvField(const T& number) {
    return number;
}

} // namespace

std::string csvField(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

std::string toJsonLine(const RunRecord& r) {
    Json curve = Json::array();
    for (const RunRecord::Point& point : r.curve) curve.push_back({point.seconds, point.relmse});
    Json json{{"version", kRecordVersion}};
    const auto put = [&](const char* place, const char*, const auto& value) {
        json[Json::json_pointer(place)] = value;
    };
    forEachField(r, put);
    forEachLaterField(r, put);
    if (r.referenceError > 0) json[kReferenceError] = r.referenceError;
    if (r.isSoftware) json[kSoftware] = true;
    json["curve"] = curve;
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string toCsv(const std::vector<RunRecord>& records) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    const auto putColumn = [&](const char*, const char* column, const auto&) { out << column << ','; };
    forEachField(RunRecord{}, putColumn);
    forEachLaterField(RunRecord{}, putColumn);
    out << kReferenceError << ',' << kSoftware << ",efficiency\n" << std::setprecision(9);
    for (const RunRecord& r : records) {
        const auto put = [&](const char*, const char*, const auto& value) { out << csvField(value) << ','; };
        forEachField(r, put);
        forEachLaterField(r, put);
        out << r.referenceError << ',' << r.isSoftware << ',' << r.efficiency() << '\n';
    }
    return out.str();
}

std::string lackingIn(const RunRecord& record) {
    std::string names;
    forEachLaterField(record, [&](const char*, const char* name, const std::string& value) {
        if (value.empty()) names += (names.empty() ? "" : ", ") + std::string(name);
    });
    return names;
}

std::vector<WorkField> workOf(const RunRecord& r) {
    return {{"Scene", r.scene, true, true},
            {"Contents", r.sceneHash, false, true},
            {"Camera", r.camera, false, true},
            {"Size", std::to_string(r.width) + " x " + std::to_string(r.height), true, true},
            {"SPP", std::to_string(r.spp)},
            {"Depth", std::to_string(r.maxDepth), true, true},
            {"Estimator", r.lightSampling},
            {"Sampler", r.sampler},
            {"Light selection", r.lightSelection},
            {"Sphere lights", r.sphereLight},
            {"Quad lights", r.quadLight},
            {"Triangle lights", r.triangleLight},
            {"Roulette", r.russianRoulette},
            {"One-sided", r.oneSidedLights, true, true},
            {"Replicates", r.replicates},
            {"Adaptive", r.adaptive},
            {"Glass connections", r.specularConnections},
            {"Edge rays", r.edgeRays},
            {"Path reuse", r.pathReuse}};
}

bool isSameWork(const RunRecord& a, const RunRecord& b) {
    const auto isEqual = [](const WorkField& x, const WorkField& y) { return x.value == y.value; };
    const std::vector<WorkField> ours = workOf(a), theirs = workOf(b);
    return std::equal(ours.begin(), ours.end(), theirs.begin(), isEqual) && lackingIn(a).empty();
}

bool isSamePicture(const RunRecord& a, const RunRecord& b) {
    const std::vector<WorkField> ours = workOf(a), theirs = workOf(b);
    return std::equal(ours.begin(), ours.end(), theirs.begin(), [](const WorkField& x, const WorkField& y) {
        return !x.isOfPicture || (x.value == y.value && !x.value.empty());
    });
}

EnginePair newestOfEqualWork(const std::vector<const RunRecord*>& newestFirst) {
    for (const RunRecord* a : newestFirst) {
        if (a->samplesPerSecond <= 0 || !lackingIn(*a).empty()) continue;
        for (const RunRecord* b : newestFirst) {
            if (a->app == b->app || b->samplesPerSecond <= 0 || !isSameWork(*a, *b)) continue;
            return a->app == kGpuProgram ? EnginePair{b, a} : EnginePair{a, b};
        }
    }
    return {};
}

std::string utcNow() {
    using std::chrono::system_clock;
    return utcText(system_clock::to_time_t(system_clock::now()), "%Y-%m-%dT%H:%M:%SZ");
}

std::filesystem::path RunHistory::userFile() {
    const fs::path folder = userConfigDirectory();
    return folder.empty() ? fs::path() : folder / "history.jsonl";
}

void RunHistory::append(const RunRecord& record) {
    if (file_.empty()) {
        const std::scoped_lock lock(mutex_);
        unfiled_.push_back(record);
        return;
    }
    std::error_code ignored; // opening the file tells
    fs::create_directories(file_.parent_path(), ignored);
    const FileLock lock(lockFile());
    std::vector<std::string> lines = readLines(file_);
    if (lines.size() >= kMaxLines) {
        lines.erase(lines.begin(), lines.end() - (kMaxLines - 1));
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

void RunHistory::remove(std::vector<RunRecord> records) {
    if (file_.empty()) {
        ++serial_;
        std::erase_if(records_, [&](const RunRecord& r) { return std::count(records.begin(), records.end(), r) > 0; });
        return;
    }
    std::unordered_set<std::string> lines;
    for (const RunRecord& record : records) lines.insert(toJsonLine(record));
    const FileLock lock(lockFile());
    AtomicFile file(file_);
    for (const std::string& line : readLines(file_)) {
        const std::optional<RunRecord> record = toRecord(line);
        if (!record || lines.count(toJsonLine(*record)) == 0) file.stream() << line << '\n';
    }
    file.commit();
    wasRead_ = false; // whatever the clock of the file system says
}

const std::vector<RunRecord>& RunHistory::records() {
    if (file_.empty()) {
        const std::scoped_lock lock(mutex_);
        if (!unfiled_.empty()) ++serial_;
        records_.insert(records_.end(), unfiled_.begin(), unfiled_.end());
        unfiled_.clear();
        return records_;
    }
    std::error_code none;
    const auto time = fs::last_write_time(file_, none);
    const std::uintmax_t size = none ? 0 : fs::file_size(file_, none);
    if (none) {
        if (!records_.empty()) ++serial_;
        records_.clear();
        wasRead_ = false;
        return records_;
    }
    if (wasRead_ && time == readTime_ && size == readSize_) return records_;
    ++serial_;
    records_.clear();
    for (const std::string& line : readLines(file_))
        if (std::optional<RunRecord> record = toRecord(line)) records_.push_back(std::move(*record));
    readTime_ = time;
    readSize_ = size;
    wasRead_ = true;
    return records_;
}

} // namespace rt::app
